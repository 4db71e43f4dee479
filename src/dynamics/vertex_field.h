#pragma once
#include <cstddef>

#include "contact/surface.h"
#include "core/index.h"
#include "core/known_size.h"

namespace keyblock::dynamics {

/// Σ φ_k c_k: what a block's coefficients (x and y of each, N times) are at a point. N = 3 is order 1.
template <typename Size>
Vec2 field_at(const double* phi, Size size, const double* coefficients) {
  Vec2 sum;
  for (int k = 0; k < size; ++k) sum += phi[k] * Vec2{coefficients[2 * k], coefficients[2 * k + 1]};
  return sum;
}

/// out_k += φ_k force.
template <typename Size>
void add_at(const double* phi, Size size, Vec2 force, double* out) {
  for (int k = 0; k < size; ++k) {
    out[2 * k] += phi[k] * force.x;
    out[2 * k + 1] += phi[k] * force.y;
  }
}

/// Calls of_vertex(v, x) with what the coefficients of block b, of N basis functions, are at each of its vertices.
template <typename OfVertex>
void for_vertex_values(const contact::Surface& surface, std::size_t b, int size, const double* coefficients,
                       const OfVertex& of_vertex) {
  with_known_size(size, [&](auto known) {
    for (std::size_t v = at(surface.block_begin[b]); v < at(surface.block_begin[b + 1]); ++v)
      of_vertex(v, field_at(&surface.phi[surface.phi_begin[v]], known, coefficients));
  });
}

}  // namespace keyblock::dynamics
