#pragma once

namespace keyblock::linalg {

/// x ← A⁻¹ x for one symmetric positive definite block of n unknowns: its lower triangle, by columns of padded_rows(n) numbers.
/// False, and x as it was, when A is not positive definite.
bool solve_block(int n, const double* a, double* x);

}  // namespace keyblock::linalg
