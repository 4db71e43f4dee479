#pragma once
#include <array>
#include <span>

#include "contact/competitor.h"

/// Where two corners meet, up to four candidates describe the same pair of corners. They compete, so that one contact remains
/// (vertex-vertex contact with a unique entrance line):
///   - All lines parallel: the end of an edge-edge contact. The vertex wins that lies over the other's edge. The competitor that was in
///     contact before stays until it has clearly left, and then hands its memory over.
///   - Otherwise corner to corner: the line wins that is passed last in the step, as the corners go now. Of lines that are not passed, or
///     were passed before, the line of the largest gap wins: it is the shortest way out. While that is a tie, no line wins, or the line that
///     presses.
namespace keyblock::contact {

struct Outcome {
  Competitor* winner = nullptr;  ///< null: none
  bool parallel = true;          ///< all their lines
  bool each = false;             ///< each of the lines holds: the corners press on each other tip to tip
  bool handed_over = false;      ///< the winner continues the memory of another competitor
  bool left_out =
      false;  ///< others did not compete: no edge of their vertex faces, or another block is in the way
};

/// Most competitors for a pair of corners: two edges end in each corner.
inline constexpr std::size_t most_competitors = 4;

/// Whether lines cannot count as one.
inline bool are_turned(const Corner& one, const Corner& other) {
  return std::abs(cross(one.tangent, other.tangent)) >= Tolerances::sine_parallel;
}

/// m, how far beyond an end the contact of parallel lines stays where it is.
inline double leave(const Tolerances& tolerances) {
  return -0.5 * tolerances.end_zone;
}

/// Cosine of the angle between the directions in which two lines push the same block away from the other.
double cosine_between(const CornerView& view, const Competitor& one, const Competitor& other);

/// Whether it matters which of two lines of the same corners parts them.
bool part_otherwise(const CornerView& view, const Competitor& one, const Competitor& other);

/// Whether an edge of the vertex and the line face each other: they run against each other, each with its block on the left.
bool faces(const CornerView& view, const Competitor& c);

/// Which of the competitors for one pair of corners is the contact. Other blocks do not count (blocking.h).
Outcome compete(const CornerView& view, std::span<Competitor* const> competitors);

}  // namespace keyblock::contact
