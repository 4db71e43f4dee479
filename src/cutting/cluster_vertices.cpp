#include <algorithm>
#include <cmath>
#include <compare>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include "cutting/cleaning.h"
#include "cutting/local_size.h"
#include "cutting/noding.h"

namespace keyblock::cutting {

namespace {

struct Pair {
  double bent;              ///< Pa, strength of the weakest joint that must bend for the two to become one
  double squared_distance;  ///< steps²
  int u, v;
};

/// A vertex in a cell of a grid of the size of the reach.
struct Cell {
  std::int64_t row, column;
  int vertex;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

std::vector<int> common(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// One pass over all close pairs. A move that takes away more than the edge between two vertices leaves the rings of
/// its faces out of date; those faces wait for the next pass.
class ClusterPass {
 public:
  ClusterPass(PlanarGraph& graph, double reach, const JointStrengths& strengths, double local_size)
      : graph_(graph),
        reach_(reach),
        strengths_(strengths),
        alike_(strengths.alike()),
        local_(graph, local_size),
        incident_(graph.edges_of_vertices()),
        stale_(graph.faces.size(), false) {}

  /// Number of vertices moved.
  int run() {
    int moved = 0;
    for (const Pair& pair : close_pairs()) {
      const std::vector<int> faces = faces_at(pair.u), others = faces_at(pair.v);
      const auto stale = [&](int f) { return stale_[index(f)]; };
      if (common(faces, others).empty() || std::any_of(faces.begin(), faces.end(), stale) ||
          std::any_of(others.begin(), others.end(), stale)) {
        continue;
      }
      moved += move_either(pair.u, pair.v);
    }
    if (moved > 0) {
      std::erase_if(graph_.edges, [](const GraphEdge& e) { return e.from == e.to; });
      graph_.remove_trees();
      graph_.trace_faces();
    }
    return moved;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] std::vector<Pair> close_pairs() {
    std::vector<Cell> cells;
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      if (incident_[v].empty()) continue;
      const Vec2 p = to_vec2(graph_.points[v]) / reach_;
      cells.push_back({static_cast<std::int64_t>(std::floor(p.y)), static_cast<std::int64_t>(std::floor(p.x)),
                       static_cast<int>(v)});
    }
    std::sort(cells.begin(), cells.end());
    std::vector<Pair> pairs;
    // Partners lie in the own cell, the next one of the row, or one of three in the row above.
    auto above = cells.begin();
    for (auto cell = cells.begin(); cell != cells.end(); ++cell) {
      for (auto other = cell + 1; other != cells.end() && other->row == cell->row; ++other) {
        if (other->column > cell->column + 1) break;
        add_pair(pairs, cell->vertex, other->vertex);
      }
      const Cell first{cell->row + 1, cell->column - 1, -1};
      while (above != cells.end() && *above < first) ++above;
      for (auto other = above; other != cells.end() && other->row == first.row; ++other) {
        if (other->column > cell->column + 1) break;
        add_pair(pairs, cell->vertex, other->vertex);
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      return std::tie(b.bent, a.squared_distance, a.u, a.v) < std::tie(a.bent, b.squared_distance, b.u, b.v);
    });
    return pairs;
  }

  void add_pair(std::vector<Pair>& pairs, int u, int v) {
    const double d = squared_norm(to_vec2(graph_.point(u)) - to_vec2(graph_.point(v)));
    if (!(d < reach_ * reach_)) return;
    double reach = reach_;
    for (const int f : common(faces_at(u), faces_at(v)))
      reach = std::min(reach, local_.share(index(f)) * reach_);
    if (!(d < reach * reach)) return;
    pairs.push_back({std::max(weakest_bent(u, v), weakest_bent(v, u)), d, std::min(u, v), std::max(u, v)});
  }

  [[nodiscard]] std::vector<int> faces_at(int v) const {
    std::vector<int> faces;
    for (const int e : incident_[index(v)]) {
      const GraphEdge& edge = graph_.edges[index(e)];
      for (const int f : {edge.left, edge.right}) {
        if (f >= 0) faces.push_back(f);
      }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  [[nodiscard]] int other_end(int e, int v) const {
    const GraphEdge& edge = graph_.edges[index(e)];
    return edge.from == v ? edge.to : edge.from;
  }

  /// The edge between two vertices, −1 if there is none.
  [[nodiscard]] int edge_between(int v, int w) const {
    for (const int e : incident_[index(v)]) {
      if (other_end(e, v) == w) return e;
    }
    return -1;
  }

  /// The sides of the domain and the outlines on which v lies.
  [[nodiscard]] std::set<std::pair<EdgeKind, int>> ties(int v) const {
    std::set<std::pair<EdgeKind, int>> result;
    for (const int e : incident_[index(v)]) {
      const EdgeLabel label = graph_.edges[index(e)].label;
      if (label.kind == EdgeKind::domain || label.kind == EdgeKind::excavation) {
        result.emplace(label.kind, label.index);
      }
    }
    return result;
  }

  [[nodiscard]] double swept_area(int u, int v) const {
    double sum = 0.0;
    for (const int e : incident_[index(u)]) {
      sum += std::abs(
          static_cast<double>(cross(graph_.point(u), graph_.point(v), graph_.point(other_end(e, u)))));
    }
    return sum;
  }

  /// Strength of the weakest joint that is no longer where it was when u has gone to v; infinite where all stay. Not
  /// looked for where all are alike.
  [[nodiscard]] double weakest_bent(int u, int v) const {
    constexpr double rounding = 4.0;  // steps
    if (alike_) return 0.0;
    double weakest = std::numeric_limits<double>::infinity();
    for (const int e : incident_[index(u)]) {
      const int w = other_end(e, u);
      if (w == v) continue;
      const GridPoint from = graph_.point(u), to = graph_.point(v), end = graph_.point(w);
      const double off =
          std::abs(static_cast<double>(cross(from, to, end))) / norm(to_vec2(end) - to_vec2(to));
      if (off > rounding) weakest = std::min(weakest, strengths_.of(graph_.edges[index(e)].label));
    }
    return weakest;
  }

  bool move_either(int u, int v) {
    const double bent_by_u = weakest_bent(u, v), bent_by_v = weakest_bent(v, u);
    if (bent_by_v > bent_by_u || (bent_by_v == bent_by_u && swept_area(v, u) < swept_area(u, v)))
      std::swap(u, v);
    return move(u, v) || move(v, u);
  }

  /// Whether u can go to v without an edge passing a vertex or the way crossing an edge. It is enough to look at the
  /// faces at u: what is hit first lies on the border of one of them.
  [[nodiscard]] bool is_free(int u, int v) const {
    Box way, swept;
    for (const int end : {u, v}) way.add(to_vec2(graph_.point(end)));
    swept.add(way);
    for (const int e : incident_[index(u)]) swept.add(to_vec2(graph_.point(other_end(e, u))));
    for (const int f : faces_at(u)) {
      for (const auto& ring : graph_.faces[index(f)].rings) {
        for (const HalfEdge h : ring) {
          if (crosses_way(u, v, way, h)) return false;
          const int a = graph_.origin(h);
          if (a != u && a != v && swept.contains(to_vec2(graph_.point(a))) && is_swept(u, v, a)) return false;
        }
      }
    }
    return true;
  }

  [[nodiscard]] bool crosses_way(int u, int v, const Box& way, HalfEdge h) const {
    const int a = graph_.origin(h), b = graph_.target(h);
    if (a == u || a == v || b == u || b == v) return false;
    Box edge;
    for (const int end : {a, b}) edge.add(to_vec2(graph_.point(end)));
    return edge.overlaps(way) &&
           cross_properly(graph_.point(u), graph_.point(v), graph_.point(a), graph_.point(b));
  }

  [[nodiscard]] bool is_swept(int u, int v, int a) const {
    const GridPoint from = graph_.point(u), to = graph_.point(v), p = graph_.point(a);
    if (in_triangle(from, to, to, p)) return true;
    return std::any_of(incident_[index(u)].begin(), incident_[index(u)].end(), [&](int e) {
      const int w = other_end(e, u);
      return w != a && w != v && in_triangle(from, to, graph_.point(w), p);
    });
  }

  bool move(int u, int v) {
    const auto ties_u = ties(u), ties_v = ties(v);
    if (!std::includes(ties_v.begin(), ties_v.end(), ties_u.begin(), ties_u.end())) return false;
    if (!is_free(u, v)) return false;
    std::vector<int> faces = faces_at(u);
    bool simple = false;  // only the edge between the two goes
    bool united = false;
    std::vector<int>& at_v = incident_[index(v)];
    for (const int e : incident_[index(u)]) {
      GraphEdge& edge = graph_.edges[index(e)];
      const int w = other_end(e, u);
      const int twin = w == v ? -1 : edge_between(v, w);
      if (w == v) {
        std::erase(at_v, e);
        edge.from = edge.to = v;
        simple = true;
      } else if (twin >= 0) {
        unite(graph_.edges[index(twin)], edge, u, v, w);
        std::erase(incident_[index(w)], e);
        edge.from = edge.to = v;
        united = true;
      } else {
        (edge.from == u ? edge.from : edge.to) = v;
        at_v.push_back(e);
      }
    }
    incident_[index(u)].clear();
    if (united || !simple) {
      for (const int f : faces) stale_[index(f)] = true;
      for (const int f : faces_at(v)) stale_[index(f)] = true;
    }
    return true;
  }

  /// Edges vw and uw become one: it takes one of their labels and, on the side of u, the face beyond uw.
  void unite(GraphEdge& kept, const GraphEdge& gone, int u, int v, int w) {
    if (strengths_.is_weaker_joint(gone.label, kept.label) ||
        (!strengths_.is_weaker_joint(kept.label, gone.label) && rank(gone.label) < rank(kept.label))) {
      kept.label = gone.label;
    }
    const bool u_left = orientation(graph_.point(v), graph_.point(w), graph_.point(u)) > 0;
    const int beyond_left = gone.from == u ? gone.left : gone.right;  // seen from u to w
    const int beyond_right = gone.from == u ? gone.right : gone.left;
    if (u_left) {
      (kept.from == v ? kept.left : kept.right) = beyond_left;
    } else {
      (kept.from == v ? kept.right : kept.left) = beyond_right;
    }
  }

  PlanarGraph& graph_;
  double reach_;  ///< steps
  const JointStrengths& strengths_;
  bool alike_;
  LocalSize local_;
  std::vector<std::vector<int>> incident_;
  std::vector<bool> stale_;
};

}  // namespace

int cluster_vertices(PlanarGraph& graph, double distance, const JointStrengths& strengths,
                     double local_size) {
  int total = 0;
  if (distance > 0.0) {
    while (const int moved = ClusterPass(graph, distance / graph.grid, strengths, local_size).run())
      total += moved;
  }
  return total;
}

}  // namespace keyblock::cutting
