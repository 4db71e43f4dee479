#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidates.h"
#include "contact/corners.h"
#include "contact/step_motion.h"
#include "contact/tolerances.h"
#include "core/index.h"

namespace keyblock::contact {

/// A candidate that passes the geometry. It is a contact unless it loses to another competitor of the same two corners, or another block
/// decides against it (contact_choice.h). The edge of a competitor is called its line: the vertex may pass it or not.
struct Competitor {
  int candidate;    ///< −1: it is no contact
  int pair;         ///< of blocks
  int memory;       ///< of the list, that it continues; −1: none
  bool first_half;  ///< of the edge is where the vertex is
  bool is_beyond;  ///< the vertex is past the end zone: a contact only in a concave corner between two blocks
  bool disputed;   ///< the vertex is near an end of the edge, so that two corners meet
  std::uint64_t corners;  ///< the two that meet; 0: none
  double gap, along;      ///< m
};

/// What the functions that choose the contacts of a step read.
struct CornerView {
  const Surface& surface;
  const CandidateList& candidates;
  const Tolerances& tolerances;
  const StepMotion& motion;
  std::span<const Corner> corners;  ///< Corners::all
  std::span<const double> pressed;  ///< m, pressed_depths()
  std::span<const int> deep = {};   ///< deep_contacts()

  [[nodiscard]] const Corner& corner(int vertex) const { return corners[at(vertex)]; }
  [[nodiscard]] const Candidate& candidate(const Competitor& c) const {
    return candidates.pairs[at(c.candidate)];
  }
  /// The edge that the vertex may pass.
  [[nodiscard]] const Corner& line(const Competitor& c) const { return corner(candidate(c).edge); }
  [[nodiscard]] const Memory& memory(const Competitor& c) const { return candidates.memory[at(c.memory)]; }
  /// m: how far the two blocks together may move in the step.
  [[nodiscard]] double reach(int block_a, int block_b) const {
    return motion.reach[at(block_a)] + motion.reach[at(block_b)];
  }
  /// Directions of the edges of a vertex, away from it.
  [[nodiscard]] std::array<Vec2, 2> sides(int vertex) const {
    return {corner(vertex).tangent, -1.0 * corner(vertex).before};
  }
};

/// m by which the vertex lies over the edge; negative: beyond the end.
inline double inside(double along, double length) {
  return std::min(along, length - along);
}
inline double inside(const CornerView& view, const Competitor& c) {
  return inside(c.along, view.line(c).length);
}

/// The line of the edge beside an edge, and a vertex.
struct TipLine {
  double outside;  ///< m, of the vertex; inside where negative: −∞ at a reflex corner
  double away;     ///< m, of the vertex from the corner between the two edges
  double length;   ///< m, of the edge beside
};
/// At the two ends of the whole edge of a candidate. Near the tip of a wedge a vertex that is deep behind one edge may be in front of the other one:
/// it is through the tip, and outside the block.
std::array<TipLine, 2> tip_lines(const CornerView& view, const Candidate& candidate);

/// The candidates of these pairs of blocks, ascending, that pass the geometry: gap, place along the edge, edges of the vertex outside the line,
/// and the vertex not through the tip of a wedge. `disputed` and `corners` say which of them compete.
void find_competitors(const CornerView& view, std::span<const std::size_t> pairs,
                      std::vector<Competitor>& competitors);

}  // namespace keyblock::contact
