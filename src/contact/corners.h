#pragma once
#include <span>
#include <vector>

#include "contact/surface.h"
#include "core/lanes.h"
#include "core/parallel.h"

namespace keyblock::contact {

/// A vertex, and the edge that begins there: eight numbers, to be read at once.
struct Corner {
  Vec2 position;
  Vec2 tangent, before;  ///< directions of the edge that begins here and of the edge that ends here
  double length = 0.0;   ///< m, of the edge
  double kinds = 0.0;    ///< CornerKind here, and four times the CornerKind at the end of the edge
  [[nodiscard]] Vec2 normal() const { return {tangent.y, -tangent.x}; }
};
static_assert(sizeof(Corner) == sizeof(Lanes));

/// The whole edge that an edge is a piece of: eight numbers, likewise.
struct WholeEdge {
  Vec2 from, to;             ///< where it begins and ends
  double start_share = 0.5;  ///< Surface::start_share of the piece
  double pieces = 1.0;
  double unused[2]{};
};
static_assert(sizeof(WholeEdge) == sizeof(Lanes));

/// What the contacts of a step read of the outlines of blocks, measured once a step.
class Corners {
 public:
  void measure(const Surface& surface, ThreadTeam& team);
  [[nodiscard]] std::span<const Corner> all() const { return corners_; }  ///< per vertex
  [[nodiscard]] std::span<const WholeEdge> whole_edges() const {
    return wholes_;
  }  ///< per edge; empty: no edge is divided

 private:
  std::vector<Corner> corners_;
  std::vector<WholeEdge> wholes_;
};

}  // namespace keyblock::contact
