#pragma once
#include <vector>

#include "geometry/polygon.h"
#include "rockmass/trace.h"

namespace keyblock::cutting {

/// How the traces of a map meet (Manzocchi 2002; Sanderson & Nixon 2015).
struct NodeCounts {
  int isolated = 0;  ///< I: ends of traces in intact rock
  int abutting = 0;  ///< Y: a trace ends on another
  int crossing = 0;  ///< X: traces cross (or more than three branches meet)
  int boundary = 0;  ///< E: traces cut off by the edge of the area
  int branches =
      0;  ///< (I + 3Y + 4X)/2, rounded down; pieces between nodes, the halves at E nodes not counted
  double length = 0;  ///< m of traces in the area
};

/// Counts the nodes of the traces within `area`. Ends closer than `snapping` (m) to another trace or to the edge of
/// the area count as lying on it. Traces that follow one another end to end are one trace. A trace along the edge of
/// the area is left out. Throws InputError when the area is no simple polygon.
NodeCounts count_nodes(const std::vector<rockmass::Trace>& traces, const Ring& area, double snapping);

}  // namespace keyblock::cutting
