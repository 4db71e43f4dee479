#pragma once
#include <vector>

#include "cutting/linework.h"
#include "cutting/noding.h"

namespace keyblock::cutting {

/// Lines from dead ends of traces straight on to the next line, which are to be cut as rock bridges. A dead end is a vertex within the domain
/// that has one edge. The next line is the first that the way crosses, or a vertex within the snapping distance (m) of it: so a bridge
/// between two traces on one line ends at the other trace. Each has the trace that it goes on from as its `trace`.
///
/// traces: as lines of the linework name them.
std::vector<SourceLine> bridges_from_dead_ends(const Linework& work, const NodedLinework& noded,
                                               const std::vector<rockmass::Trace>& traces, double snapping,
                                               EdgeLabel bridge);

}  // namespace keyblock::cutting
