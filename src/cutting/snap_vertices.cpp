#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "cutting/cleaning.h"
#include "cutting/local_size.h"
#include "cutting/noding.h"
#include "cutting/segment_index.h"

namespace keyblock::cutting {

namespace {

struct NearPair {
  double distance;  ///< steps
  int vertex, edge;
};

/// One pass over all vertices near edges, the nearest first. The rings of the faces of a changed edge are out of date;
/// they wait for the next pass.
class SnapPass {
 public:
  SnapPass(PlanarGraph& graph, double reach, const JointStrengths& strengths, double local_size)
      : graph_(graph),
        reach_(reach),
        strengths_(strengths),
        local_(graph, local_size),
        incident_(graph.edges_of_vertices()),
        stale_(graph.faces.size(), false) {}

  /// Number of edges bent.
  int run() {
    int bent = 0;
    for (const NearPair& pair : near_pairs()) bent += snap(pair.vertex, pair.edge);
    if (bent > 0) {
      std::erase_if(graph_.edges, [](const GraphEdge& e) { return e.from == e.to; });
      graph_.remove_trees();
      graph_.trace_faces();
    }
    return bent;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] Vec2 place(int v) const { return to_vec2(graph_.point(v)); }

  [[nodiscard]] Vec2 foot(int v, const GraphEdge& e) const {
    const Vec2 a = place(e.from), d = place(e.to) - a;
    return a + std::clamp(dot(place(v) - a, d) / squared_norm(d), 0.0, 1.0) * d;
  }

  [[nodiscard]] std::vector<NearPair> near_pairs() {
    Box box;
    for (const GraphEdge& e : graph_.edges) box.add(place(e.from));
    SegmentIndex segments(
        box, std::clamp(static_cast<int>(std::sqrt(static_cast<double>(graph_.edges.size()))), 8, 4096));
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      segments.add(static_cast<int>(e), place(graph_.edges[e].from), place(graph_.edges[e].to));
    }
    std::vector<NearPair> pairs;
    for (std::size_t k = 0; k < incident_.size(); ++k) {
      if (incident_[k].empty()) continue;
      const int v = static_cast<int>(k);
      const Vec2 p = place(v);
      segments.near({{p.x - reach_, p.y - reach_}, {p.x + reach_, p.y + reach_}}, [&](int id) {
        const GraphEdge& e = graph_.edges[index(id)];
        if (e.from == v || e.to == v) return;
        const Vec2 q = foot(v, e);
        // What is as near to an end of the edge is a matter of clustering.
        if (norm(p - q) >= reach_ || q == place(e.from) || q == place(e.to)) return;
        const int face = side_of(v, id);
        if (face >= 0 && norm(p - q) < local_.share(index(face)) * reach_)
          pairs.push_back({norm(p - q), v, id});
      });
    }
    const auto key = [](const NearPair& pair) { return std::tie(pair.distance, pair.vertex, pair.edge); };
    std::sort(pairs.begin(), pairs.end(),
              [&](const NearPair& a, const NearPair& b) { return key(a) < key(b); });
    pairs.erase(std::unique(pairs.begin(), pairs.end(),
                            [&](const NearPair& a, const NearPair& b) { return key(a) == key(b); }),
                pairs.end());
    return pairs;
  }

  /// The face of edge e on the side of v, if v lies on its border; −1 if not, or if it is out of date.
  [[nodiscard]] int side_of(int v, int e) const {
    const GraphEdge& edge = graph_.edges[index(e)];
    const int turn = orientation(graph_.point(edge.from), graph_.point(edge.to), graph_.point(v));
    const int face = turn >= 0 ? edge.left : edge.right;
    if (face < 0 || stale_[index(face)]) return -1;
    const bool at_border = std::any_of(incident_[index(v)].begin(), incident_[index(v)].end(), [&](int g) {
      return graph_.edges[index(g)].left == face || graph_.edges[index(g)].right == face;
    });
    return at_border ? face : -1;
  }

  /// Whether triangle abc holds no vertex of the face but those given.
  [[nodiscard]] bool is_empty(int face, GridPoint a, GridPoint b, GridPoint c) const {
    Box box;
    for (const GridPoint p : {a, b, c}) box.add(to_vec2(p));
    for (const auto& ring : graph_.faces[index(face)].rings) {
      for (const HalfEdge h : ring) {
        const GridPoint p = graph_.point(graph_.origin(h));
        if (p != a && p != b && p != c && box.contains(to_vec2(p)) && in_triangle(a, b, c, p)) return false;
      }
    }
    return true;
  }

  bool snap(int v, int e) {
    const GraphEdge edge = graph_.edges[index(e)];
    if (edge.from == v || edge.to == v || edge.from == edge.to) return false;
    const int face = side_of(v, e);
    const int beyond = face == edge.left ? edge.right : edge.left;
    if (face < 0 || (beyond >= 0 && stale_[index(beyond)])) return false;
    const GridPoint a = graph_.point(edge.from), b = graph_.point(edge.to), p = graph_.point(v);
    if (!is_empty(face, a, b, p)) return false;
    if ((beyond < 0 || is_weaker_than_all(edge, v)) &&
        !move_to_border(v, nearest_grid_point(foot(v, edge)))) {
      return false;
    }
    mark_stale(v, edge);
    bent_to_left_ = face == edge.left;
    replace(e, edge.from, v, edge);
    replace(-1, v, edge.to, edge);
    return true;
  }

  [[nodiscard]] bool is_weaker_than_all(const GraphEdge& edge, int v) const {
    const auto& here = incident_[index(v)];
    return std::all_of(here.begin(), here.end(), [&](int g) {
      return strengths_.of(edge.label) < strengths_.of(graph_.edges[index(g)].label);
    });
  }

  /// The domain and weak planes keep their shape: the vertex goes to the border, not the border to the vertex.
  bool move_to_border(int v, GridPoint target) {
    const GridPoint from = graph_.point(v);
    for (const int g : incident_[index(v)]) {
      const GraphEdge& edge = graph_.edges[index(g)];
      const GridPoint far = graph_.point(edge.from == v ? edge.to : edge.from);
      if (edge.left < 0 || edge.right < 0) return false;
      for (const int face : {edge.left, edge.right}) {
        if (stale_[index(face)] || !is_empty(face, from, target, far)) return false;
      }
    }
    graph_.points[index(v)] = target;
    return true;
  }

  void mark_stale(int v, const GraphEdge& edge) {
    const auto mark = [&](const GraphEdge& e) {
      for (const int face : {e.left, e.right}) {
        if (face >= 0) stale_[index(face)] = true;
      }
    };
    mark(edge);
    for (const int g : incident_[index(v)]) mark(graph_.edges[index(g)]);
  }

  /// Puts a piece of an edge from one vertex to another, in place of edge e or as a new one (−1). An edge that is there
  /// already takes over the face beyond, which is where the old edge had it.
  void replace(int e, int from, int to, const GraphEdge& old) {
    const auto& here = incident_[index(from)];
    const auto twin = std::find_if(here.begin(), here.end(), [&](int g) {
      const GraphEdge& edge = graph_.edges[index(g)];
      return g != e && (edge.from == to || edge.to == to);
    });
    if (twin == here.end()) {
      GraphEdge piece = old;
      piece.from = from;
      piece.to = to;
      if (e >= 0) {
        graph_.edges[index(e)] = piece;
      } else {
        graph_.edges.push_back(piece);
      }
      return;
    }
    GraphEdge& kept = graph_.edges[index(*twin)];
    if (strengths_.is_weaker_joint(old.label, kept.label) ||
        (!strengths_.is_weaker_joint(kept.label, old.label) && rank(old.label) < rank(kept.label))) {
      kept.label = old.label;
    }
    const bool same_way = kept.from == from;
    // The sliver lay between the old edge and this one: its side now shows the face beyond the old edge.
    (bent_to_left_ == same_way ? kept.right : kept.left) = bent_to_left_ ? old.right : old.left;
    if (e >= 0) graph_.edges[index(e)].from = graph_.edges[index(e)].to = from;
  }

  PlanarGraph& graph_;
  double reach_;  ///< steps
  const JointStrengths& strengths_;
  LocalSize local_;
  std::vector<std::vector<int>> incident_;
  std::vector<bool> stale_;
  bool bent_to_left_ = false;
};

}  // namespace

void snap_vertices_to_edges(PlanarGraph& graph, double distance, const JointStrengths& strengths,
                            double local_size) {
  // Every pass closes gaps; a bent edge may come near another vertex, so that some are needed, but never many.
  constexpr int max_passes = 100;
  if (!(distance > 0.0)) return;
  for (int pass = 0;
       pass < max_passes && SnapPass(graph, distance / graph.grid, strengths, local_size).run() > 0; ++pass) {
  }
}

}  // namespace keyblock::cutting
