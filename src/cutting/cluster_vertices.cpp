#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "cutting/cleaning.h"
#include "cutting/noding.h"

namespace keyblock::cutting {

namespace {

struct Pair {
  double squared_distance;  ///< steps²
  int u, v;
};

/// One pass over all close pairs: those are moved together that have no face in common with one moved before.
class ClusterPass {
 public:
  ClusterPass(PlanarGraph& graph, double reach)
      : graph_(graph), reach_(reach), incident_(graph.points.size()) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      incident_[index(graph.edges[e].from)].push_back(static_cast<int>(e));
      incident_[index(graph.edges[e].to)].push_back(static_cast<int>(e));
    }
    touched_.resize(graph.faces.size(), false);
  }

  /// Number of vertices moved.
  int run() {
    int moved = 0;
    for (const Pair& pair : close_pairs()) {
      std::set<int> faces = faces_at(pair.u);
      const std::set<int> others = faces_at(pair.v);
      const bool common = std::any_of(faces.begin(), faces.end(), [&](int f) { return others.contains(f); });
      faces.insert(others.begin(), others.end());
      if (!common || std::any_of(faces.begin(), faces.end(), [&](int f) { return touched_[index(f)]; }))
        continue;
      if (!move_either(pair.u, pair.v)) continue;
      for (const int f : faces) touched_[index(f)] = true;
      ++moved;
    }
    if (moved > 0) remove_collapsed();
    return moved;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] std::vector<Pair> close_pairs() const {
    // Vertices by the cell of a hash grid, sorted; only pairs of neighbouring cells can be close.
    std::map<std::pair<std::int64_t, std::int64_t>, std::vector<int>> cells;
    const auto cell = [&](GridPoint p) {
      return std::pair{static_cast<std::int64_t>(std::floor(static_cast<double>(p.x) / reach_)),
                       static_cast<std::int64_t>(std::floor(static_cast<double>(p.y) / reach_))};
    };
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      if (!incident_[v].empty()) cells[cell(graph_.points[v])].push_back(static_cast<int>(v));
    }
    std::vector<Pair> pairs;
    for (const auto& [place, members] : cells) {
      for (std::int64_t dx = -1; dx <= 1; ++dx) {
        for (std::int64_t dy = -1; dy <= 1; ++dy) {
          const auto other = cells.find({place.first + dx, place.second + dy});
          if (other == cells.end()) continue;
          for (const int u : members) {
            for (const int v : other->second) {
              const double d = squared_norm(to_vec2(graph_.point(u)) - to_vec2(graph_.point(v)));
              if (u < v && d < reach_ * reach_) pairs.push_back({d, u, v});
            }
          }
        }
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      return std::tie(a.squared_distance, a.u, a.v) < std::tie(b.squared_distance, b.u, b.v);
    });
    return pairs;
  }

  [[nodiscard]] std::set<int> faces_at(int v) const {
    std::set<int> faces;
    for (const int e : incident_[index(v)]) {
      const GraphEdge& edge = graph_.edges[index(e)];
      for (const int f : {edge.left, edge.right}) {
        if (f >= 0) faces.insert(f);
      }
    }
    return faces;
  }

  [[nodiscard]] int other_end(int e, int v) const {
    const GraphEdge& edge = graph_.edges[index(e)];
    return edge.from == v ? edge.to : edge.from;
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

  bool move_either(int u, int v) {
    if (swept_area(v, u) < swept_area(u, v)) std::swap(u, v);
    return move(u, v) || move(v, u);
  }

  [[nodiscard]] bool in_triangle(GridPoint a, GridPoint b, GridPoint c, GridPoint p) const {
    const int s = orientation(a, b, p), t = orientation(b, c, p), r = orientation(c, a, p);
    if (s == 0 && t == 0 && r == 0) {  // a flat triangle: the segment between its extremes
      return std::min({a, b, c}) <= p && p <= std::max({a, b, c});
    }
    return (s >= 0 && t >= 0 && r >= 0) || (s <= 0 && t <= 0 && r <= 0);
  }

  [[nodiscard]] bool is_free(int u, int v) const {
    const GridPoint from = graph_.point(u), to = graph_.point(v);
    for (const int f : faces_at(u)) {
      for (const auto& ring : graph_.faces[index(f)].rings) {
        for (const HalfEdge h : ring) {
          const int a = graph_.origin(h), b = graph_.target(h);
          if (a != u && a != v && b != u && b != v &&
              cross_properly(from, to, graph_.point(a), graph_.point(b))) {
            return false;
          }
          if (a == u || a == v) continue;
          const GridPoint p = graph_.point(a);
          if (in_triangle(from, to, to, p)) return false;
          for (const int e : incident_[index(u)]) {
            const int w = other_end(e, u);
            if (w != a && w != v && in_triangle(from, to, graph_.point(w), p)) return false;
          }
        }
      }
    }
    return true;
  }

  bool move(int u, int v) {
    const auto ties_u = ties(u), ties_v = ties(v);
    if (!std::includes(ties_v.begin(), ties_v.end(), ties_u.begin(), ties_u.end())) return false;
    if (!is_free(u, v)) return false;
    for (const int e : incident_[index(u)]) {
      const int w = other_end(e, u);
      GraphEdge& edge = graph_.edges[index(e)];
      const auto twin = std::find_if(incident_[index(v)].begin(), incident_[index(v)].end(),
                                     [&](int g) { return w != v && other_end(g, v) == w; });
      if (w == v) {
        edge.from = edge.to = v;
      } else if (twin != incident_[index(v)].end()) {
        unite(graph_.edges[index(*twin)], edge, u, v, w);
        edge.from = edge.to = v;
      } else {
        (edge.from == u ? edge.from : edge.to) = v;
      }
    }
    return true;
  }

  /// Edges vw and uw become one: it takes the label of higher rank and, on the side of u, the face beyond uw.
  void unite(GraphEdge& kept, const GraphEdge& gone, int u, int v, int w) {
    if (rank(gone.label) < rank(kept.label)) kept.label = gone.label;
    const bool u_left = orientation(graph_.point(v), graph_.point(w), graph_.point(u)) > 0;
    const int beyond_left = gone.from == u ? gone.left : gone.right;  // seen from u to w
    const int beyond_right = gone.from == u ? gone.right : gone.left;
    if (u_left) {
      (kept.from == v ? kept.left : kept.right) = beyond_left;
    } else {
      (kept.from == v ? kept.right : kept.left) = beyond_right;
    }
  }

  void remove_collapsed() {
    std::erase_if(graph_.edges, [](const GraphEdge& e) { return e.from == e.to; });
    graph_.remove_trees();
    graph_.trace_faces();
  }

  PlanarGraph& graph_;
  double reach_;  ///< steps
  std::vector<std::vector<int>> incident_;
  std::vector<bool> touched_;
};

}  // namespace

int cluster_vertices(PlanarGraph& graph, double distance) {
  int total = 0;
  if (distance > 0.0) {
    while (const int moved = ClusterPass(graph, distance / graph.grid).run()) total += moved;
  }
  return total;
}

}  // namespace keyblock::cutting
