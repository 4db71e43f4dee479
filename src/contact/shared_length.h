#pragma once
#include "core/lanes.h"

// Two edges that face each other have a length in common. How much of it belongs to the contact of a vertex
// (docs/decisions/0008-contacts.md).
namespace keyblock::contact {

/// An edge beside a line, as SharedLength sees it. Number: double or Lanes.
template <typename Number>
struct Beside {
  Number share;     ///< Surface::start_share of the end at the vertex
  Number from, to;  ///< m, along the line: the ends of the whole edge that it is a piece of
  Number pieces;    ///< of the whole edge
};

/// The length that the edges of a vertex have in common with a line.
template <typename Number>
struct SharedLength {
  Number along, length;  ///< m: of the edge, where the vertex is on it and how long it is
  double zone;           ///< m, by which edges may miss each other and still begin or end together
  double apart;          ///< m, up to which they are beside each other
  double deep;           ///< m, that counts of what they are pressed into each other
  double facing;         ///< sine of the angle from which on they do not face each other

  /// m that an edge of the vertex lies opposite to this edge. It reaches to `to`.
  [[nodiscard]] Number opposite(Number to) const {
    const Number low = smaller(along, to), high = larger(along, to), zero{};
    return larger(zero, smaller(length, high) - larger(zero, low));
  }
  /// m of the edge, over which an edge opposite to it is beside it. depth: m, of the vertex in this edge; slope: how the gap grows away from the
  /// vertex, the sine of their angle. What is pressed in is not apart, so from the deepest point of the two the gap may grow by that depth and by
  /// `apart`: by less, the nearer the angle comes to that of edges that do not face each other, where nothing is left of the length.
  [[nodiscard]] Number stretch(Number depth, Number slope, Number opposite) const {
    const Number zero{}, sine = size(slope),
                         flat = smaller(zero + 1.0, larger(zero, 2.0 - sine * (2.0 / facing))),
                         deepest = depth + larger(zero, -slope) * opposite,
                         most = flat * larger(zero, smaller(deepest, zero + deep)) + apart;
    return most / larger(sine, most * (1.0 / largest_length));
  }
  /// m that both have in common.
  [[nodiscard]] Number common(Number to, Number long_beside) const {
    return smaller(opposite(to), long_beside);
  }
  /// m that the vertex has of the common length: the half, in general. Where one edge lies within the other with all of its pieces, the vertex
  /// has what Surface::start_share of that edge gives it. Where both are divided alike, it has the mean of both; as blocks slide, that
  /// becomes the half. Shares of some pieces beside halves of others would move the middle of an even pressure.
  Number operator()(Number to, Number long_beside, const Beside<Number>& other,
                    const Beside<Number>& here) const {
    constexpr double slid = 0.5;  // of an edge: edges that miss each other by more are not divided alike
    const Number low = smaller(along, to), high = larger(along, to), zero{};
    const Number other_low = smaller(other.from, other.to), other_high = larger(other.from, other.to);
    const Number from_slid = other_low - here.from, to_slid = other_high - here.to,
                 beyond_zone = larger(zero, larger(size(from_slid), size(to_slid)) - zone),
                 left = zero + 1.0 - beyond_zone / larger(slid * (here.to - here.from), zero + zone);
    const auto alike = (other.pieces <= here.pieces) & (other.pieces >= here.pieces) &
                       (size(to_slid - from_slid) <= zone) & (left > 0.0),
               other_within = (other_low >= -zone) & (other_high <= length + zone),
               here_within = (here.from >= low - zone) & (here.to <= high + zone);
    const Number half = zero + 0.5, both = 0.5 + left * (0.5 * (other.share + here.share) - 0.5);
    return common(to, long_beside) *
           where(alike, both, where(other_within, other.share, where(here_within, here.share, half)));
  }

 private:
  static constexpr double largest_length = 1e100;  // m
  static Number smaller(Number a, Number b) { return where(b < a, b, a); }
  static Number larger(Number a, Number b) { return where(a < b, b, a); }
  static Number size(Number a) { return larger(a, -a); }
};

/// With the share of its other end.
template <typename Number>
Beside<Number> at_end(Beside<Number> edge) {
  edge.share = 1.0 - edge.share;
  return edge;
}

}  // namespace keyblock::contact
