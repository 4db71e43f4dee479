// The matrix of a step: stiffness and inertia of its blocks, and springs of its rows.
#include <array>
#include <cstddef>
#include <vector>

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
  owners_.for_rows(model_->bodies(), *team_, [&](std::size_t c, RowOwners::Owner owner) {
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

namespace {

using Vectors = std::vector<std::vector<double>>;

/// φ n, the derivative of a displacement along the normal by the coefficients of a block.
std::vector<double> along_normal(const double* phi, int size, Vec2 normal) {
  std::vector<double> out;
  for (int k = 0; k < size; ++k) {
    out.push_back(phi[k] * normal.x);
    out.push_back(phi[k] * normal.y);
  }
  return out;
}

/// values += Σ h_ij r_i c_jᵀ
void add_products(std::span<const double> h, double scale, const Vectors& rows, const Vectors& columns,
                  double* values, int stride) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const double share = scale * h[i * columns.size() + j];
      for (std::size_t l = 0; l < columns[j].size(); ++l) {
        double* column = values + static_cast<std::ptrdiff_t>(l) * stride;
        for (std::size_t k = 0; k < rows[i].size(); ++k) column[k] += share * rows[i][k] * columns[j][l];
      }
    }
  }
}

}  // namespace

/// −∂(n·r)/∂D of the rows, by the two bodies of the first: all rows of a face are between the same two.
void StepProblem::add_face(std::span<const std::size_t> rows, std::span<const Place> places,
                           std::span<const double> h, double scale, linalg::BlockSolver& solver) const {
  const Row& first = rows_[rows.front()];
  const std::array<int, 2> unknown{first.unknown_a, first.unknown_b};
  std::array<Vectors, 2> g;
  for (Vectors& of_body : g) of_body.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows_[rows[i]];
    const std::size_t a = row.unknown_a == unknown[0] ? 0 : 1;
    g[a][i] =
        along_normal(points_.phi_of(row.vertex), points_.body_of(row.vertex).size, -1.0 * places[i].normal);
    points_.with_phi(row, places[i].position, [&](const double* phi) {
      g[1 - a][i] = along_normal(phi, points_.body_of(row.from).size, places[i].normal);
    });
  }
  for (const std::size_t body : {0U, 1U}) {
    if (unknown[body] >= 0)
      add_products(h, scale, g[body], g[body], solver.diagonal(unknown[body]),
                   linalg::padded_rows(static_cast<int>(g[body][0].size())));
  }
  if (first.pair < 0) return;
  const linalg::BlockSlot slot = solver.slot(first.pair);
  const std::size_t of_rows = slot.row == unknown[0] ? 0 : 1;
  add_products(h, scale, g[of_rows], g[1 - of_rows], slot.values, slot.stride);
}

}  // namespace keyblock::dynamics
