#include "cutting/bridges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/index.h"
#include "cutting/segment_index.h"

namespace keyblock::cutting {

namespace {

/// Finds where the way on from a vertex ends. Lengths are in grid steps.
class NextLine {
 public:
  NextLine(const PlanarGraph& graph, const Box& bounds, double snapping)
      : graph_(graph),
        size_(std::max(bounds.size().x, bounds.size().y)),
        snapping_(snapping),
        index_(bounds, std::clamp(static_cast<int>(std::sqrt(static_cast<double>(graph.edges.size()))), 8,
                                  most_columns)) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e)
      index_.add(static_cast<int>(e), place(graph.edges[e].from), place(graph.edges[e].to));
  }

  /// None: there is nothing, which the edge of the domain keeps from being.
  [[nodiscard]] std::optional<GridPoint> from(int vertex, Vec2 direction) const {
    const Vec2 start = place(vertex);
    // Where nothing is near, twice as far. What lies beyond the reach may not be the first.
    for (double reach = size_ / most_columns; reach <= 4.0 * size_; reach *= 2.0) {
      std::optional<Hit> first;
      Box box;
      box.add(start);
      box.add(start + reach * direction);
      index_.near(box.grown(snapping_ + 1.0), [&](int e) { see(at(e), vertex, start, direction, first); });
      if (first && first->way <= reach) return first->place;
    }
    return std::nullopt;
  }

 private:
  static constexpr int most_columns = 1024;
  struct Hit {
    double way;
    GridPoint place;
  };
  [[nodiscard]] Vec2 place(int vertex) const { return to_vec2(graph_.point(vertex)); }

  void see(std::size_t e, int vertex, Vec2 start, Vec2 direction, std::optional<Hit>& first) const {
    const GraphEdge& edge = graph_.edges[e];
    if (edge.from == vertex || edge.to == vertex) return;
    const auto take = [&](double way, GridPoint where) {
      if (!first || way < first->way) first = Hit{way, where};
    };
    bool is_met_at_end = false;
    for (const int end : {edge.from, edge.to}) {
      const Vec2 r = place(end) - start;
      const double way = dot(r, direction);
      if (way <= snapping_ || std::abs(cross(direction, r)) > snapping_) continue;
      take(way, graph_.point(end));
      is_met_at_end = true;
    }
    const Vec2 a = place(edge.from) - start, b = place(edge.to) - start;
    const double side_a = cross(direction, a), side_b = cross(direction, b);
    if (is_met_at_end || (side_a > 0.0) == (side_b > 0.0)) return;
    const Vec2 crossing = lerp(a, b, side_a / (side_a - side_b));
    const double way = dot(crossing, direction);
    if (way > 0.0) take(way, nearest_grid_point(start + crossing));
  }

  const PlanarGraph& graph_;
  double size_, snapping_;
  SegmentIndex index_;
};

}  // namespace

std::vector<SourceLine> bridges_from_dead_ends(const Linework& work, const NodedLinework& noded,
                                               const std::vector<rockmass::Trace>& traces, double snapping,
                                               EdgeLabel bridge) {
  const PlanarGraph& graph = noded.graph;
  const double reach = std::max(snapping / work.grid, 1.0);
  const NextLine next(graph, bounds({work.domain, {}}), reach);
  const std::vector<std::vector<int>> edges = graph.edges_of_vertices();
  std::vector<SourceLine> bridges;
  for (std::size_t v = 0; v < edges.size(); ++v) {
    if (edges[v].size() != 1) continue;
    const std::size_t e = at(edges[v].front());
    const int vertex = static_cast<int>(v),
              other = graph.edges[e].from == vertex ? graph.edges[e].to : graph.edges[e].from;
    // On as the trace runs, which an edge of a few grid steps does not say.
    const int trace = noded.traces[e].front();
    const Vec2 along = normalized(traces[at(trace)].b - traces[at(trace)].a),
               back = to_vec2(graph.point(vertex)) - to_vec2(graph.point(other));
    const auto end = next.from(vertex, dot(along, back) >= 0.0 ? along : -along);
    if (end) bridges.push_back({graph.point(vertex), *end, bridge, trace});
  }
  return bridges;
}

}  // namespace keyblock::cutting
