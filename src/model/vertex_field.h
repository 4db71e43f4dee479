#pragma once
#include <cstddef>

#include "contact/surface.h"
#include "core/index.h"
#include "core/known_size.h"
#include "geometry/pair.h"

namespace keyblock::dynamics {

/// Σ φ_k c_k: what a block's coefficients (x and y of each, N times) are at a point. N = 3 is order 1.
template <typename Size>
Vec2 field_at(const double* phi, Size size, const double* coefficients) {
  Pair sum{};
  for (int k = 0; k < size; ++k) sum += phi[k] * load_pair(coefficients + 2 * k);
  return vec2_of(sum);
}

/// out_k += φ_k force.
template <typename Size>
void add_at(const double* phi, Size size, Vec2 force, double* out) {
  const Pair pair = pair_of(force);
  for (int k = 0; k < size; ++k) store_pair(out + 2 * k, load_pair(out + 2 * k) + phi[k] * pair);
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
