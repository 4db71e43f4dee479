#include "cutting/planar_graph.h"

#include <algorithm>
#include <optional>

#include "core/index.h"

namespace keyblock::cutting {

Rotation::Rotation(const PlanarGraph& graph)
    : first_(graph.points.size() + 1, 0),
      sorted_(2 * graph.edges.size()),
      place_(sorted_.size()),
      vertex_(sorted_.size()) {
  for (std::size_t h = 0; h < sorted_.size(); ++h) {
    vertex_[h] = graph.origin(static_cast<HalfEdge>(h));
    ++first_[at(vertex_[h]) + 1];
  }
  for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
  std::vector<int> fill(first_.begin(), first_.end() - 1);
  for (std::size_t h = 0; h < sorted_.size(); ++h) {
    sorted_[at(fill[at(vertex_[h])]++)] = static_cast<HalfEdge>(h);
  }
  for (std::size_t v = 0; v + 1 < first_.size(); ++v) {
    const GridPoint centre = graph.points[v];
    const auto upper = [&](GridPoint p) { return p.y > centre.y || (p.y == centre.y && p.x > centre.x); };
    std::sort(sorted_.begin() + first_[v], sorted_.begin() + first_[v + 1], [&](HalfEdge g, HalfEdge h) {
      const GridPoint p = graph.point(graph.target(g)), q = graph.point(graph.target(h));
      if (upper(p) != upper(q)) return upper(p);
      return cross(centre, p, q) > 0;
    });
  }
  for (std::size_t k = 0; k < sorted_.size(); ++k) place_[at(sorted_[k])] = static_cast<int>(k);
}

HalfEdge Rotation::next(HalfEdge h) const {
  const HalfEdge twin = h ^ 1;
  const int vertex = vertex_[at(twin)];
  const int place = place_[at(twin)];
  return sorted_[at(place == first_[at(vertex)] ? first_[at(vertex) + 1] - 1 : place - 1)];
}

std::vector<int> Rotation::walks(int& count) const {
  std::vector<int> walk(sorted_.size(), -1);
  count = 0;
  for (std::size_t start = 0; start < walk.size(); ++start) {
    if (walk[start] >= 0) continue;
    for (auto h = static_cast<HalfEdge>(start); walk[at(h)] < 0; h = next(h)) walk[at(h)] = count;
    ++count;
  }
  return walk;
}

void PlanarGraph::remove_dead_ends(std::vector<GraphEdge>& removed) {
  // Exclusive or of the numbers of a vertex's edges: of a single edge its number.
  std::vector<std::size_t> incident(points.size(), 0);
  std::vector<int> degree(points.size(), 0);
  const auto toggle = [&](std::size_t e, int change) {
    for (const int v : {edges[e].from, edges[e].to}) {
      degree[at(v)] += change;
      incident[at(v)] ^= e;
    }
  };
  for (std::size_t e = 0; e < edges.size(); ++e) toggle(e, 1);
  std::vector<bool> dead(edges.size(), false);
  for (std::size_t start = 0; start < points.size(); ++start) {
    for (int v = static_cast<int>(start); degree[at(v)] == 1;) {
      const std::size_t e = incident[at(v)];
      dead[e] = true;
      removed.push_back(edges[e]);
      toggle(e, -1);
      v = edges[e].from == v ? edges[e].to : edges[e].from;
    }
  }
  std::size_t kept = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!dead[e]) edges[kept++] = edges[e];
  }
  edges.resize(kept);
}

std::vector<std::vector<int>> PlanarGraph::edges_of_vertices() const {
  std::vector<std::vector<int>> incident(points.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    incident[static_cast<std::size_t>(edges[e].from)].push_back(static_cast<int>(e));
    incident[static_cast<std::size_t>(edges[e].to)].push_back(static_cast<int>(e));
  }
  return incident;
}

std::vector<GraphEdge> PlanarGraph::remove_trees() {
  std::vector<GraphEdge> removed;
  remove_dead_ends(removed);
  int count = 0;
  const std::vector<int> walk = Rotation(*this).walks(count);
  std::size_t kept = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (walk[2 * e] == walk[2 * e + 1]) {
      removed.push_back(edges[e]);
    } else {
      edges[kept++] = edges[e];
    }
  }
  edges.resize(kept);
  return removed;
}

namespace {

using Cycle = std::vector<HalfEdge>;

/// Cuts a closed walk into cycles that pass no vertex twice. `position` of every vertex is −1 before and after.
std::vector<Cycle> simple_cycles(const PlanarGraph& graph, const Cycle& walk, std::vector<int>& position) {
  std::vector<Cycle> cycles;
  Cycle open;
  open.reserve(walk.size());
  for (const HalfEdge h : walk) {
    int& place = position[at(graph.origin(h))];  // among the origins of `open`
    if (place >= 0) {
      const auto begin = open.begin() + place;
      cycles.emplace_back(begin, open.end());
      for (const HalfEdge g : cycles.back()) position[at(graph.origin(g))] = -1;
      open.erase(begin, open.end());
    }
    place = static_cast<int>(open.size());
    open.push_back(h);
  }
  for (const HalfEdge h : open) position[at(graph.origin(h))] = -1;
  cycles.push_back(std::move(open));
  return cycles;
}

/// Twice the signed area in steps², exact.
Wide twice_area(const PlanarGraph& graph, const Cycle& cycle) {
  const GridPoint base = graph.point(graph.origin(cycle.front()));
  Wide sum = 0;
  for (const HalfEdge h : cycle) {
    sum += cross(base, graph.point(graph.origin(h)), graph.point(graph.target(h)));
  }
  return sum;
}

Box box_of(const PlanarGraph& graph, const Cycle& cycle) {
  Box box;
  for (const HalfEdge h : cycle) box.add(to_vec2(graph.point(graph.origin(h))));
  return box;
}

bool encloses(const PlanarGraph& graph, const Cycle& cycle, GridPoint p) {
  bool inside = false;
  for (const HalfEdge h : cycle) {
    const GridPoint a = graph.point(graph.origin(h)), b = graph.point(graph.target(h));
    if ((a.y > p.y) != (b.y > p.y) && (orientation(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

/// The faces as they are found, before their edges know them.
class FaceTracer {
 public:
  explicit FaceTracer(PlanarGraph& graph) : graph_(graph), position_(graph.points.size(), -1) {}

  void run() {
    std::vector<Face> old = std::move(graph_.faces);
    graph_.faces.clear();
    collect_walks();
    for (std::size_t w = 0; w < walks_.size(); ++w) add_face(w);
    find_components();
    for (const std::size_t w : holes_) attach_hole(w);
    inherit(old);
    label_sides();
  }

 private:
  void collect_walks() {
    const Rotation rotation(graph_);
    int count = 0;
    const std::vector<int> walk_of = rotation.walks(count);
    walks_.resize(at(count));
    for (std::size_t h = 0; h < walk_of.size(); ++h) {
      Cycle& walk = walks_[at(walk_of[h])];
      if (!walk.empty()) continue;
      const auto start = static_cast<HalfEdge>(h);
      HalfEdge g = start;
      do {
        walk.push_back(g);
        g = rotation.next(g);
      } while (g != start);
    }
  }

  /// A walk with a counter-clockwise cycle bounds a face; its other cycles are holes that touch that one. A walk
  /// without is the outside of a component.
  void add_face(std::size_t w) {
    Face face;
    face.rings.emplace_back();
    for (Cycle& cycle : simple_cycles(graph_, walks_[w], position_)) {
      if (twice_area(graph_, cycle) > 0) {
        face.rings.front() = std::move(cycle);
      } else {
        face.rings.push_back(std::move(cycle));
      }
    }
    if (face.rings.front().empty()) {
      holes_.push_back(w);
    } else {
      graph_.faces.push_back(std::move(face));
    }
  }

  void find_components() {
    component_.resize(graph_.points.size());
    for (std::size_t v = 0; v < component_.size(); ++v) component_[v] = static_cast<int>(v);
    for (const GraphEdge& e : graph_.edges) component_[at(root(e.from))] = root(e.to);
    for (const Face& face : graph_.faces) {
      boxes_.push_back(box_of(graph_, face.rings.front()));
      areas_.push_back(twice_area(graph_, face.rings.front()));
    }
  }

  int root(int v) {
    while (component_[at(v)] != v) v = component_[at(v)] = component_[at(component_[at(v)])];
    return v;
  }

  /// The face around a component is the one with the smallest outer ring around any of its vertices.
  void attach_hole(std::size_t w) {
    const int vertex = graph_.origin(walks_[w].front());
    const GridPoint p = graph_.point(vertex);
    std::optional<std::size_t> best;
    for (std::size_t f = 0; f < boxes_.size(); ++f) {
      if (!boxes_[f].contains(to_vec2(p)) || (best && areas_[f] >= areas_[*best])) continue;
      const Cycle& outer = graph_.faces[f].rings.front();
      if (root(graph_.origin(outer.front())) != root(vertex) && encloses(graph_, outer, p)) best = f;
    }
    if (!best) return;
    for (Cycle& cycle : simple_cycles(graph_, walks_[w], position_)) {
      graph_.faces[*best].rings.push_back(std::move(cycle));
    }
  }

  void inherit(const std::vector<Face>& old) {
    for (Face& face : graph_.faces) {
      const int before = graph_.face_left_of(face.rings.front().front());
      if (before >= 0 && at(before) < old.size()) face.excavations = old[at(before)].excavations;
    }
  }

  void label_sides() {
    for (GraphEdge& e : graph_.edges) e.left = e.right = -1;
    for (std::size_t f = 0; f < graph_.faces.size(); ++f) {
      Face& face = graph_.faces[f];
      for (const Cycle& ring : face.rings) {
        face.area += 0.5 * static_cast<double>(twice_area(graph_, ring)) * graph_.grid * graph_.grid;
        for (const HalfEdge h : ring) {
          GraphEdge& e = graph_.edges[at(h / 2)];
          (h % 2 == 0 ? e.left : e.right) = static_cast<int>(f);
          face.perimeter += graph_.length(e);
        }
      }
    }
  }

  PlanarGraph& graph_;
  std::vector<int> position_;  ///< of each vertex in an open cycle; −1: in none
  std::vector<Cycle> walks_;
  std::vector<std::size_t> holes_;  ///< walks that bound no face from inside
  std::vector<int> component_;
  std::vector<Box> boxes_;
  std::vector<Wide> areas_;
};

}  // namespace

void PlanarGraph::trace_faces() {
  FaceTracer(*this).run();
}

}  // namespace keyblock::cutting
