#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "contact/contact.h"
#include "coupling/spring_array.h"
#include "geometry/pair.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

/// The relative displacement that two springs act on, a normal and a shear spring (SpringArray): of a contact, or of a spring between two
/// points (Coupling).
///
///     r = u(V) − (1 − s) u(A) − s u(B) + moved,      y = y₀ − n·r,      w = w₀ + t·r
///
/// u: displacement of points of the blocks (Points), zero on fixed ones. A cache line: every evaluation of the contacts reads it, and little
/// else.
struct alignas(64) Row {
  /// In place of a pair of blocks in the solver's pattern: one is fixed; the pattern does not have it.
  static constexpr int of_fixed = -1, without_room = -2;

  /// V, of block a. A and B, the ends of the edge of block b, or one point in the place of both.
  std::uint32_t vertex, from, to;
  int unknown_a, unknown_b;  ///< Block::unknown of the two; −1: fixed
  int pair = of_fixed;       ///< of the solver's pattern, or of_fixed, or without_room
  double position;           ///< s
  Vec2 normal;               ///< n
  Vec2 moved;  ///< m, known part of r: prescribed displacement of a less that of b; Drive::rotation

  [[nodiscard]] Vec2 tangent() const { return contact::tangent_of(normal); }
  /// ∂ψ/∂r where the springs push with `force`.
  [[nodiscard]] Vec2 gradient(SpringArray::Force force) const {
    return force.shear * tangent() - force.normal * normal;
  }
  /// r, except for the known part.
  [[nodiscard]] Pair relative(std::span<const Vec2> u) const {
    return load_pair(u[vertex]) - lerp(load_pair(u[from]), load_pair(u[to]), position);
  }
};
static_assert(sizeof(Row) == 64);

/// Where a row has its springs: direction of the normal spring, and how far along the edge.
struct Place {
  Vec2 normal;
  double position = 0.0;
  Place() = default;
  explicit Place(const Row& row) : normal(row.normal), position(row.position) {}
  friend bool operator==(const Place&, const Place&) = default;
};

/// Springs at a row, N/m per thickness; negative: taken away.
struct SpringChange {
  std::size_t row;
  Place place;
  double normal, shear;
};

}  // namespace keyblock::dynamics
