#pragma once
#include <vector>

#include "geometry/vec2.h"
#include "rockmass/trace.h"

namespace keyblock::rockmass {

/// How many traces there are in a window, and how much of them (Dershowitz & Herda 1992). Those of a realization scatter
/// about the values of the statistics; see generate_traces.
struct Intensity {
  int traces = 0;           ///< that meet the window
  double length = 0.0;      ///< m of them in it
  double p21 = 0.0;         ///< 1/m, length per area
  double p20 = 0.0;         ///< 1/m², centres of traces per area
  double p10_across = 0.0;  ///< 1/m, crossings per length of horizontal scanlines
  double p10_down = 0.0;    ///< 1/m, likewise of vertical ones
};

/// Precondition: the window has an area. Five scanlines each way, at equal distances.
Intensity measure_intensity(const std::vector<Trace>& traces, const Box& window);

/// The part of a trace in the window, m.
double length_inside(const Trace& trace, const Box& window);

}  // namespace keyblock::rockmass
