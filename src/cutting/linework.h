#pragma once
#include <vector>

#include "cutting/block_system.h"
#include "cutting/cut.h"
#include "cutting/grid_point.h"

namespace keyblock::cutting {

/// A straight line to cut along, on the grid.
struct SourceLine {
  GridPoint a;
  GridPoint b;
  /// For a line of the domain, index counts the edges of its ring, so that corners can be told.
  EdgeLabel label;
  int trace =
      -1;  ///< index into the input's traces, then its bridges in gaps; −1: a piece of the domain or of an outline
  std::vector<GridPoint> nodes{};  ///< points on the line where a trace was made to end
};

/// The lines of a cut, rounded to a common grid. A real coordinate is shift + grid × whole number.
struct Linework {
  double grid = 0.0;  ///< m, a power of two
  Vec2 shift;
  Ring domain;                    ///< counter-clockwise, in grid steps
  std::vector<Ring> excavations;  ///< counter-clockwise, in grid steps
  std::vector<SourceLine> lines;  ///< domain, then outlines, then traces; none of length zero
  double domain_area = 0.0;       ///< m²

  [[nodiscard]] GridPoint to_grid(Vec2 real) const { return nearest_grid_point((real - shift) / grid); }
};

/// Of the pieces of a trace.
EdgeLabel label_of(const rockmass::Trace& trace);

/// Checks the rings, chooses the grid and puts the ends of traces on the lines within the snapping distance of them.
/// Traces are clipped to a box a little larger than the domain. Throws InputError.
Linework make_linework(const CutInput& input, const CutTolerances& tolerances);

/// The lines as polylines through their nodes, in order.
std::vector<SourceLine> split_at_nodes(const std::vector<SourceLine>& lines);

}  // namespace keyblock::cutting
