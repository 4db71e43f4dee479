#pragma once
#include <vector>

#include "cutting/block_system.h"
#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// The faces as blocks in metres: grid × steps + shift. Of each ring, vertices within `collinear` (m) of the straight
/// line between the vertices kept on either side are dropped (Douglas & Peucker 1973), but none where the label
/// changes and none where the rings of a face touch; a block whose rings would cross keeps all of its vertices. Vertices
/// that are left in no block are counted in `statistics`.
/// Throws RunError when a block crosses itself.
std::vector<CutBlock> outlines_of(const PlanarGraph& graph, double collinear, Vec2 shift,
                                  CutStatistics& statistics);

}  // namespace keyblock::cutting
