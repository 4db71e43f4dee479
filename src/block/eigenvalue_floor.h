#pragma once
#include <array>
#include <cstddef>
#include <span>

namespace keyblock::block {

/// False where a bound, or a Cholesky factor, shows that no eigenvalue of a symmetric n × n matrix (lower triangle, by columns) lies below
/// −floor.
[[nodiscard]] bool may_lie_below(const double* g, int n, double floor);

/// Raises the eigenvalues of a symmetric n × n matrix (lower triangle, by columns) to at least −floor. Of the geometric stiffness both are
/// in kg/(m³ s²), as inertia per Δt².
void raise_eigenvalues(double* g, int n, double floor);

/// A matrix of the geometric stiffness of a block of order 2, lower triangle, by columns.
inline constexpr int rows_of_order_2 = 5;
using MatrixOfOrder2 = std::array<double, std::size_t{rows_of_order_2} * rows_of_order_2>;

/// The same for up to eight of them at once, by Jacobi's method (Golub & Van Loan 2013, §8.5). What becomes of one does not depend on the
/// others.
void raise_eigenvalues(std::span<MatrixOfOrder2> g, std::span<const double> floor);

}  // namespace keyblock::block
