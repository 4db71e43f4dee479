#pragma once
#include <vector>

#include "cutting/block_system.h"
#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// The faces as blocks in metres: grid × steps + shift. Vertices within `collinear` (m) of the straight line between the
/// vertices kept on either side are dropped (Douglas & Peucker 1973), but none where the label changes. Where more than
/// two edges meet, a block keeps its vertex unless it lies within `straight` (m) of its line, if that is less, as only
/// this block loses it: it is the foot of a T. Elsewhere the blocks on both sides lose the same vertices, so that they fit whatever
/// the tolerance. A block whose rings would cross keeps all of its vertices, and any block those where its rings touch.
/// Vertices that are left in no block are counted in `statistics`.
/// Throws RunError when a block crosses itself.
std::vector<CutBlock> outlines_of(const PlanarGraph& graph, double collinear, double straight, Vec2 shift,
                                  CutStatistics& statistics);

}  // namespace keyblock::cutting
