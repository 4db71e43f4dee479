#include "cutting/noding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "cutting/segment_index.h"
#include "cutting/snap_rounding.h"

namespace keyblock::cutting {

namespace {

/// Finds the source lines along which a noded segment runs.
class SourceFinder {
 public:
  /// About as many cells as there are segments to find sources for.
  SourceFinder(const std::vector<SourceLine>& lines, const Box& bounds, std::size_t segments)
      : lines_(lines),
        index_(bounds, std::clamp(static_cast<int>(std::sqrt(static_cast<double>(segments))), 8, 4096)) {
    for (std::size_t k = 0; k < lines.size(); ++k) {
      index_.add(static_cast<int>(k), to_vec2(lines[k].a), to_vec2(lines[k].b));
    }
  }

  /// Snap rounding keeps a piece within half a diagonal of a cell of its line.
  [[nodiscard]] std::vector<int> find(const Segment& segment) const {
    constexpr double reach = 1.5;
    const Vec2 a = to_vec2(segment[0]), b = to_vec2(segment[1]);
    const Vec2 middle = 0.5 * (a + b);
    std::vector<int> found;
    index_.near({{middle.x - reach, middle.y - reach}, {middle.x + reach, middle.y + reach}}, [&](int id) {
      if (distance(id, a) <= reach && distance(id, b) <= reach) found.push_back(id);
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  [[nodiscard]] double distance(int id, Vec2 p) const {
    const SourceLine& line = lines_[static_cast<std::size_t>(id)];
    const Vec2 a = to_vec2(line.a), d = to_vec2(line.b) - a;
    const double s = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
    return norm(p - a - s * d);
  }

  const std::vector<SourceLine>& lines_;
  SegmentIndex index_;
};

}  // namespace

std::pair<int, int> rank(EdgeLabel label) {
  constexpr std::array<int, 5> by_kind{4, 3, 2, 1, 0};  // free, joint set, trace map, excavation, domain
  return {by_kind[static_cast<std::size_t>(label.kind)], label.index};
}

NodedLinework node(const Linework& work) {
  const std::vector<SourceLine> lines = split_at_nodes(work.lines);
  const std::vector<Segment> segments = snap_round(lines);

  NodedLinework result;
  PlanarGraph& graph = result.graph;
  graph.grid = work.grid;
  for (const Segment& segment : segments)
    graph.points.insert(graph.points.end(), segment.begin(), segment.end());
  std::sort(graph.points.begin(), graph.points.end());
  graph.points.erase(std::unique(graph.points.begin(), graph.points.end()), graph.points.end());
  const auto vertex = [&](GridPoint p) {
    return static_cast<int>(std::lower_bound(graph.points.begin(), graph.points.end(), p) -
                            graph.points.begin());
  };

  const SourceFinder finder(lines, bounds({work.domain, {}}), segments.size());
  for (const Segment& segment : segments) {
    const std::vector<int> sources = finder.find(segment);
    if (sources.empty()) {
      const Vec2 place = work.shift + work.grid * to_vec2(segment[0]);
      throw RunError(
          fmt::format("a noded line at ({}, {}) belongs to no joint or outline", place.x, place.y));
    }
    GraphEdge edge{vertex(segment[0]), vertex(segment[1]), lines[static_cast<std::size_t>(sources[0])].label};
    std::vector<int> traces;
    for (const int id : sources) {
      const SourceLine& line = lines[static_cast<std::size_t>(id)];
      if (rank(line.label) < rank(edge.label)) edge.label = line.label;
      if (line.trace >= 0) traces.push_back(line.trace);
    }
    const Vec2 middle = 0.5 * (to_vec2(segment[0]) + to_vec2(segment[1]));
    if (edge.label.kind != EdgeKind::domain && !contains(work.domain, middle)) continue;
    traces.erase(std::unique(traces.begin(), traces.end()), traces.end());
    graph.edges.push_back(edge);
    result.traces.push_back(std::move(traces));
  }
  return result;
}

}  // namespace keyblock::cutting
