#pragma once
#include <utility>
#include <vector>

#include "cutting/linework.h"
#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// Order of labels where lines overlap, the least wins: domain, excavation, trace map, joint set; then by index.
std::pair<int, int> rank(EdgeLabel label);

/// The linework as a plane graph, trees and all, without faces.
struct NodedLinework {
  PlanarGraph graph;
  std::vector<std::vector<int>> traces;  ///< per edge: the traces that run along it, ascending
};

/// Nodes the lines by snap rounding (Hobby 1999; GEOS): every end and every crossing becomes a vertex on the grid, and a
/// line that passes a vertex within half a step goes through it. Overlaps become one edge that carries the
/// label of highest rank (see cut). Edges outside of the domain are left out. Vertices and edges are
/// sorted, so that nothing depends on the order in which the library returns them.
/// Throws RunError when the library fails.
NodedLinework node(const Linework& work);

}  // namespace keyblock::cutting
