#pragma once
#include <vector>

#include "cutting/cut.h"
#include "geometry/polygon.h"
#include "rockmass/trace.h"

namespace keyblock::scenario {

/// Unknowns beyond which a model is refused: its matrices would not fit into the memory of a large machine.
constexpr double most_unknowns = 2e7;

/// How many blocks traces cut the window into at least, estimated from the crossings of a sample of them, four standard
/// errors below the mean. By Euler's formula each trace makes one block less than the crossings and feet on the edge that
/// it adds; dead ends change nothing. Traces in the same place count once, and so do crossings closer than vertices that
/// become one; slivers are merged. Takes milliseconds per thousand traces.
double expected_blocks(const std::vector<rockmass::Trace>& traces, const Box& window,
                       const cutting::CutTolerances& tolerances);

}  // namespace keyblock::scenario
