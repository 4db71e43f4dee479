#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "geometry/moments.h"
#include "geometry/polygon.h"

namespace {

keyblock::Polygon regular(long corners) {
  keyblock::Polygon polygon;
  for (long k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(corners);
    polygon.outer.push_back({std::cos(angle), std::sin(angle)});
  }
  return polygon;
}

/// Moments up to degree 2n, as the mass matrix of a block of order n needs them.
void moments_of_order(benchmark::State& state) {
  const keyblock::Polygon polygon = regular(6);
  const int degree = 2 * static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(keyblock::Moments(polygon, {0, 0}, 1.0, degree));
}
BENCHMARK(moments_of_order)->Arg(1)->Arg(3)->Arg(6);

void triangulate_polygon(benchmark::State& state) {
  const keyblock::Polygon polygon = regular(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(keyblock::triangulate(polygon));
}
BENCHMARK(triangulate_polygon)->Arg(6)->Arg(60);

}  // namespace
