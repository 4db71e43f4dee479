#pragma once
#include <array>
#include <vector>

#include "cutting/grid_point.h"
#include "cutting/linework.h"

namespace keyblock::cutting {

/// A piece of a line between two nodes, the lower point first.
using Segment = std::array<GridPoint, 2>;

/// The pieces into which snap rounding (Hobby 1999; GEOS) cuts the lines, each once, sorted. By the noder of GEOS alone where the
/// build has found it, by snap_round_by_union() elsewhere: both have the same pieces. Throws RunError when the library
/// fails.
std::vector<Segment> snap_round(const std::vector<SourceLine>& lines);

/// The same by the union of all lines, the one way to the noder that GEOS's stable interface has: slower.
std::vector<Segment> snap_round_by_union(const std::vector<SourceLine>& lines);

/// The segments of two points each, directed upward, those of no length left out, sorted, each once.
void tidy(std::vector<Segment>& segments);

}  // namespace keyblock::cutting
