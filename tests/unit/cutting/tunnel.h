#pragma once
#include <cmath>
#include <numbers>

#include "cutting/cut.h"
#include "rockmass/trace_generator.h"

namespace keyblock::cutting {

/// The tunnel of Hsiung & Shi (2001): 20 × 20 m, three joint sets, a circle of 5.5 m.
inline CutInput paper_tunnel(int realization, int circle_vertices = 64) {
  using namespace rockmass;
  const auto uniform = [](double mean) { return Distribution{DistributionKind::uniform, mean, 0.35 * mean}; };
  const auto set = [&](double dip, double dip_direction, double spacing, double length, double gap) {
    JointSet s;
    s.dip = dip;
    s.dip_direction = dip_direction;
    s.spacing = uniform(spacing);
    s.length = uniform(length);
    s.gap = uniform(gap);
    return s;
  };
  CutInput input;
  input.domain = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
  int index = 0;
  for (const JointSet& s :
       {set(79, 270, 0.3, 1.8, 0.4), set(81, 230, 0.3, 2.4, 0.3), set(5, 165, 0.5, 1.8, 0.5)}) {
    const auto traces = generate_traces(s, index++, 165.0, {{-10, -10}, {10, 10}}, 2001, realization);
    input.traces.insert(input.traces.end(), traces.begin(), traces.end());
  }
  Ring circle;
  for (int k = 0; k < circle_vertices; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / circle_vertices;
    circle.push_back({2.75 * std::cos(angle), 2.75 * std::sin(angle)});
  }
  input.excavations = {circle};
  return input;
}

}  // namespace keyblock::cutting
