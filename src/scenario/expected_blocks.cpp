#include "scenario/expected_blocks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "rockmass/intensity.h"

namespace keyblock::scenario {
namespace {

constexpr std::size_t most_samples = 64;
constexpr double standard_errors = 4.0;
// Sine of the angle below which traces in the same place are one.
constexpr double parallel = 1e-2;

// How often a trace meets others per metre of it in the window, `inside`.
double crossings_per_metre(const std::vector<rockmass::Trace>& traces, std::size_t sampled, double inside,
                           const Box& window, double same_place) {
  const Vec2 a = traces[sampled].a, d = traces[sampled].b - a;
  std::vector<double> places;  // m along the trace
  double copies = 0.0;
  for (const rockmass::Trace& other : traces) {
    const Vec2 e = other.b - other.a;
    const double turn = cross(d, e);
    if (std::abs(turn) <= parallel * norm(d) * norm(e)) {
      const double from = dot(other.a - a, d) / norm(d), to = dot(other.b - a, d) / norm(d);
      const bool overlap =
          std::min(std::max(from, to), norm(d)) - std::max(std::min(from, to), 0.0) > same_place;
      const double off = std::min(std::abs(cross(d, other.a - a)), std::abs(cross(d, other.b - a))) / norm(d);
      copies += overlap && off <= same_place;
      if (turn == 0.0) continue;
    }
    const double s = cross(other.a - a, e) / turn, t = cross(other.a - a, d) / turn;
    if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0 || !window.contains(a + s * d)) continue;
    places.push_back(s * norm(d));
  }
  std::sort(places.begin(), places.end());
  double count = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) count += k == 0 || places[k] - places[k - 1] > same_place;
  return count / (inside * std::max(copies, 1.0));
}

}  // namespace

double expected_blocks(const std::vector<rockmass::Trace>& traces, const Box& window,
                       const cutting::CutTolerances& tolerances) {
  std::vector<double> lengths;
  double length = 0.0, feet = 0.0, count = 0.0;
  for (const rockmass::Trace& trace : traces) {
    lengths.push_back(rockmass::length_inside(trace, window));
    length += lengths.back();
    if (lengths.back() == 0.0) continue;
    count += 1.0;
    feet += !window.contains(trace.a) + !window.contains(trace.b);
  }
  if (length == 0.0) return 1.0;

  // Traces are drawn by their length: crossings per metre vary little.
  const RandomStream stream(0, 0, 0, 0);
  const double same_place = std::max(tolerances.cluster, tolerances.snapping);
  const double samples = static_cast<double>(std::min(most_samples, traces.size()));
  double sum = 0.0, squares = 0.0, passed = 0.0;
  std::size_t trace = 0;
  for (double k = 0.0; k < samples; k += 1.0) {
    const double place = (k + stream.uniform(static_cast<std::uint32_t>(k))) / samples * length;
    while (trace + 1 < traces.size() && passed + lengths[trace] < place) passed += lengths[trace++];
    if (lengths[trace] == 0.0) continue;
    const double crossings = crossings_per_metre(traces, trace, lengths[trace], window, same_place);
    sum += crossings;
    squares += crossings * crossings;
  }
  const double mean = sum / samples;
  const double error = std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples);
  // A crossing lies on two traces.
  const double crossings = 0.5 * length * std::max(0.0, mean - standard_errors * error);
  const double blocks = std::max(1.0, 1.0 + crossings + feet - count);
  // A block of less than the one area or the other is merged: no shape has less perimeter for its area than a circle.
  const double least_area =
      std::max(tolerances.sliver_area,
               4.0 * std::numbers::pi * tolerances.sliver_thickness * tolerances.sliver_thickness);
  const Vec2 size = window.size();
  return least_area > 0.0 ? std::min(blocks, size.x * size.y / least_area) : blocks;
}

}  // namespace keyblock::scenario
