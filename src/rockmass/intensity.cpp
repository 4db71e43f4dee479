#include "rockmass/intensity.h"

#include <algorithm>

namespace keyblock::rockmass {
namespace {

constexpr int scanlines = 5;

// Whether the trace crosses the horizontal line through height y between x = left and x = right.
bool crosses(const Trace& trace, double y, double left, double right) {
  if ((trace.a.y > y) == (trace.b.y > y)) return false;
  const double x = lerp(trace.a, trace.b, (y - trace.a.y) / (trace.b.y - trace.a.y)).x;
  return left < x && x < right;
}

Vec2 turned(Vec2 p) {
  return {p.y, p.x};
}

Trace turned(const Trace& trace) {
  return {turned(trace.a), turned(trace.b), trace.source};
}

}  // namespace

double length_inside(const Trace& trace, const Box& window) {
  double from = 0.0, to = 1.0;
  const Vec2 d = trace.b - trace.a;
  const auto bound = [&](double p, double q) {  // s p ≤ q
    if (p > 0.0) to = std::min(to, q / p);
    if (p < 0.0) from = std::max(from, q / p);
    if (p == 0.0 && q < 0.0) to = from;
  };
  bound(d.x, window.max.x - trace.a.x);
  bound(-d.x, trace.a.x - window.min.x);
  bound(d.y, window.max.y - trace.a.y);
  bound(-d.y, trace.a.y - window.min.y);
  return std::max(0.0, to - from) * norm(d);
}

Intensity measure_intensity(const std::vector<Trace>& traces, const Box& window) {
  Intensity intensity;
  const double width = window.max.x - window.min.x, height = window.max.y - window.min.y;
  int centres = 0, across = 0, down = 0;
  for (const Trace& trace : traces) {
    const double inside = length_inside(trace, window);
    intensity.traces += inside > 0.0;
    intensity.length += inside;
    centres += window.contains(0.5 * (trace.a + trace.b));
    for (int k = 0; k < scanlines; ++k) {
      const double share = (k + 0.5) / scanlines;
      across += crosses(trace, window.min.y + share * height, window.min.x, window.max.x);
      down += crosses(turned(trace), window.min.x + share * width, window.min.y, window.max.y);
    }
  }
  intensity.p21 = intensity.length / (width * height);
  intensity.p20 = centres / (width * height);
  intensity.p10_across = across / (scanlines * width);
  intensity.p10_down = down / (scanlines * height);
  return intensity;
}

}  // namespace keyblock::rockmass
