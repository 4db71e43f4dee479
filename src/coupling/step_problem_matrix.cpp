// The matrix of a step: stiffness and inertia of its blocks, and springs of its rows.
#include <cstddef>

#include "core/lanes.h"
#include "coupling/step_problem.h"
#include "linalg/registers.h"

namespace keyblock::dynamics {

namespace {

/// C of a row: normal and shear spring in coordinates.
struct Stiffness {
  double xx, xy, yy;
};

/// target += scale · (φ_r φ_cᵀ) ⊗ C, with columns of `stride` numbers.
void add_outer(const double* phi_r, int rows, const double* phi_c, int columns, Stiffness k, double scale,
               double* target, int stride) {
  for (int c = 0; c < columns; ++c) {
    double* x = target + static_cast<std::ptrdiff_t>(2 * c) * stride;
    double* y = x + stride;
    const double f = scale * phi_c[c], fxx = f * k.xx, fxy = f * k.xy, fyy = f * k.yy;
    for (int r = 0; r < rows; ++r) {
      x[2 * r] += phi_r[r] * fxx;
      x[2 * r + 1] += phi_r[r] * fxy;
      y[2 * r] += phi_r[r] * fxy;
      y[2 * r + 1] += phi_r[r] * fyy;
    }
  }
}

/// The same between two blocks of N basis functions, a column at once.
template <int size>
void add_outer(const double* phi_r, const double* phi_c, Stiffness k, double scale, double* target) {
  constexpr int stride = linalg::padded_rows(2 * size);
  using Of = linalg::Registers<double, stride>;
  using Register = typename Of::Register;
  constexpr int width = sizeof(Register) / sizeof(double), registers = stride / width;
  const auto phi = [&](int r) { return r < size ? phi_r[r] : 0.0; };
  Register rows[registers], kx, ky;
  if constexpr (width == 8) {
#pragma GCC unroll 2
    for (int l = 0; l < registers; ++l) {
      const double p0 = phi(4 * l), p1 = phi(4 * l + 1), p2 = phi(4 * l + 2), p3 = phi(4 * l + 3);
      rows[l] = Register{p0, p0, p1, p1, p2, p2, p3, p3};
    }
    kx = Register{k.xx, k.xy, k.xx, k.xy, k.xx, k.xy, k.xx, k.xy};
    ky = Register{k.xy, k.yy, k.xy, k.yy, k.xy, k.yy, k.xy, k.yy};
  } else {
#pragma GCC unroll 4
    for (int l = 0; l < registers; ++l) {
      const double p0 = phi(2 * l), p1 = phi(2 * l + 1);
      rows[l] = Register{p0, p0, p1, p1};
    }
    kx = Register{k.xx, k.xy, k.xx, k.xy};
    ky = Register{k.xy, k.yy, k.xy, k.yy};
  }
#pragma GCC unroll 6
  for (int c = 0; c < size; ++c) {
    const Register f = Of::all(scale * phi_c[c]), fx = f * kx, fy = f * ky;
    double* x = target + static_cast<std::ptrdiff_t>(2 * c) * stride;
    double* y = x + stride;
#pragma GCC unroll 4
    for (int l = 0; l < registers; ++l) {
      Of::store_to(x + l * width, Of::load_from(x + l * width) + rows[l] * fx);
      Of::store_to(y + l * width, Of::load_from(y + l * width) + rows[l] * fy);
    }
  }
}

/// The same, whichever it is.
void add_block(const double* phi_r, int rows, const double* phi_c, int columns, Stiffness k, double scale,
               double* target, int stride) {
  if (rows == 3 && columns == 3) return add_outer<3>(phi_r, phi_c, k, scale, target);
  if (rows == 6 && columns == 6) return add_outer<6>(phi_r, phi_c, k, scale, target);
  add_outer(phi_r, rows, phi_c, columns, k, scale, target, stride);
}

}  // namespace

void StepProblem::add_springs(std::span<const SpringChange> changes, linalg::BlockSolver& solver) const {
  for (const SpringChange& change : changes)
    add_spring(rows_[change.row], change.place, change.normal, change.shear, {}, solver);
}

void StepProblem::add_springs(std::span<const double> normal, std::span<const double> shear,
                              linalg::BlockSolver& solver) const {
  owners_.for_rows(model_->blocks.size(), *team_, [&](std::size_t c, RowOwners::Owner owner) {
    if (normal[c] == 0.0 && shear[c] == 0.0) return;
    add_spring(rows_[c], Place(rows_[c]), normal[c], shear[c], owner, solver);
  });
}

void StepProblem::add_spring(const Row& row, const Place& place, double kn, double ks, RowOwners::Owner owner,
                             linalg::BlockSolver& solver) const {
  const Vec2 n = place.normal, t = contact::tangent_of(n);
  const Stiffness k{kn * n.x * n.x + ks * t.x * t.x, kn * n.x * n.y + ks * t.x * t.y,
                    kn * n.y * n.y + ks * t.y * t.y};
  const double* phi_a = points_.phi_of(row.vertex);
  const int size_a = points_.body_of(row.vertex).size, size_b = points_.body_of(row.from).size;
  const auto add_diagonal = [&](const double* phi, int size, int unknown) {
    if (size > 0 && owner.has(unknown))
      add_block(phi, size, phi, size, k, 1.0, solver.diagonal(unknown), linalg::padded_rows(2 * size));
  };
  add_diagonal(phi_a, size_a, row.unknown_a);
  points_.with_phi(row, place.position, [&](const double* phi_b) {
    add_diagonal(phi_b, size_b, row.unknown_b);
    if (row.pair < 0) return;
    const linalg::BlockSlot slot = solver.slot(row.pair);
    if (!owner.has(slot.row)) return;
    if (slot.row == row.unknown_a) {
      add_block(phi_a, size_a, phi_b, size_b, k, -1.0, slot.values, slot.stride);
    } else {
      add_block(phi_b, size_b, phi_a, size_a, k, -1.0, slot.values, slot.stride);
    }
  });
}

}  // namespace keyblock::dynamics
