#include "cutting/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/index.h"

namespace keyblock::cutting {

namespace {

/// A ring on the way out: vertex numbers and the label of the edge that leaves each.
struct LabelledRing {
  std::vector<int> vertices;
  std::vector<EdgeLabel> labels;
};

/// The label of pieces of one set, map or outline that become one edge: its trace is that of most of the length, of equals the first by number.
class LabelOfPieces {
 public:
  void add(EdgeLabel label, double length) {
    if (lengths_.empty()) label_ = label;
    const auto known = std::ranges::find(lengths_, label.trace, &std::pair<int, double>::first);
    known == lengths_.end() ? void(lengths_.emplace_back(label.trace, length))
                            : void(known->second += length);
  }
  [[nodiscard]] EdgeLabel label() const {
    EdgeLabel label = label_;
    double longest = -1.0;
    for (const auto& [trace, length] : lengths_) {
      if (length < longest || (length == longest && trace > label.trace)) continue;
      longest = length;
      label.trace = trace;
    }
    return label;
  }

 private:
  EdgeLabel label_;
  std::vector<std::pair<int, double>> lengths_;  ///< by trace
};

double distance_to_line(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double s = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
  return norm(p - a - s * d);
}

class RingSimplifier {
 public:
  RingSimplifier(const PlanarGraph& graph, double tolerance) : graph_(graph), tolerance_(tolerance) {}

  /// `pinned` vertices, which are sorted, stay.
  LabelledRing simplified(const LabelledRing& ring, const std::vector<int>& pinned) {
    const std::size_t n = ring.vertices.size();
    std::vector<std::size_t> anchors{0, farthest(ring.vertices)};
    for (std::size_t k = 0; k < n; ++k) {
      const bool label_changes = !(ring.labels[k] == ring.labels[(k + n - 1) % n]);
      const bool is_pinned = std::binary_search(pinned.begin(), pinned.end(), ring.vertices[k]);
      if (label_changes || is_pinned) anchors.push_back(k);
    }
    const std::vector<bool>& keep = kept(ring.vertices, std::move(anchors));
    LabelledRing result;
    for (std::size_t k = 0; k < n; ++k) {
      if (!keep[k]) continue;
      LabelOfPieces label;
      std::size_t end = k;
      do {
        label.add(ring.labels[end], norm(place(ring.vertices, end + 1) - place(ring.vertices, end)));
      } while (++end < n && !keep[end]);
      result.vertices.push_back(ring.vertices[k]);
      result.labels.push_back(label.label());
    }
    return result;
  }

  /// Which vertices of a closed ring stay, those at `anchors` among them.
  const std::vector<bool>& kept(const std::vector<int>& ring, std::vector<std::size_t> anchors) {
    const std::size_t n = ring.size();
    keep_.assign(n, false);
    std::sort(anchors.begin(), anchors.end());
    anchors.erase(std::unique(anchors.begin(), anchors.end()), anchors.end());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      keep_[anchors[i]] = true;
      const std::size_t end = i + 1 < anchors.size() ? anchors[i + 1] : n + anchors.front();
      simplify(ring, anchors[i], end);
    }
    return keep_;
  }

  /// The vertex farthest from the first one: like the first one, where that is the lowest, a corner of the convex hull.
  [[nodiscard]] std::size_t farthest(const std::vector<int>& ring) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < ring.size(); ++k) {
      if (squared_norm(place(ring, k) - place(ring, 0)) > squared_norm(place(ring, best) - place(ring, 0))) {
        best = k;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] Vec2 place(const std::vector<int>& ring, std::size_t k) const {
    return to_vec2(graph_.point(ring[k % ring.size()]));
  }

  void simplify(const std::vector<int>& ring, std::size_t from, std::size_t to) {
    std::size_t worst = from;
    double largest = tolerance_;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double distance = distance_to_line(place(ring, k), place(ring, from), place(ring, to));
      if (distance > largest) {
        worst = k;
        largest = distance;
      }
    }
    if (worst == from) return;
    keep_[worst % ring.size()] = true;
    simplify(ring, from, worst);
    simplify(ring, worst, to);
  }

  const PlanarGraph& graph_;
  double tolerance_;  ///< steps
  std::vector<bool> keep_;
};

/// Begins at the lowest, then leftmost vertex. Vertex numbers are sorted by place only before vertices are moved, so
/// the points are compared. Vertices that are `dropped` are left out.
LabelledRing labelled_ring(const PlanarGraph& graph, const std::vector<HalfEdge>& whole,
                           const std::vector<char>& dropped) {
  const std::size_t n = whole.size();
  std::size_t lowest = n;
  for (std::size_t k = 0; k < n; ++k) {
    const int v = graph.origin(whole[k]);
    if (!dropped[at(v)] && (lowest == n || graph.point(v) < graph.point(graph.origin(whole[lowest]))))
      lowest = k;
  }
  LabelledRing result;
  std::vector<LabelOfPieces> labels;
  for (std::size_t k = 0; k < n && lowest < n; ++k) {
    const HalfEdge h = whole[(k + lowest) % n];
    if (!dropped[at(graph.origin(h))]) {
      result.vertices.push_back(graph.origin(h));
      labels.emplace_back();
    }
    EdgeLabel label = graph.edge(h).label;
    if (label.kind == EdgeKind::domain) label.index = 0;
    labels.back().add(label, graph.length(graph.edge(h)));
  }
  for (const LabelOfPieces& label : labels) result.labels.push_back(label.label());
  return result;
}

/// The vertices at which rings touch, ascending. No ring passes a vertex twice.
std::vector<int> common_vertices(const std::vector<LabelledRing>& rings) {
  std::vector<int> common;
  if (rings.size() < 2) return common;
  for (const LabelledRing& ring : rings)
    common.insert(common.end(), ring.vertices.begin(), ring.vertices.end());
  std::sort(common.begin(), common.end());
  std::size_t kept = 0;
  for (std::size_t k = 1; k < common.size(); ++k) {
    if (common[k] == common[k - 1]) common[kept++] = common[k];
  }
  common.resize(kept);
  return common;
}

bool crosses_itself(const PlanarGraph& graph, const std::vector<LabelledRing>& rings) {
  std::vector<std::pair<GridPoint, GridPoint>> edges;
  for (const LabelledRing& ring : rings) {
    if (ring.vertices.size() < 3) return true;
    for (std::size_t k = 0; k < ring.vertices.size(); ++k) {
      edges.emplace_back(graph.point(ring.vertices[k]),
                         graph.point(ring.vertices[(k + 1) % ring.vertices.size()]));
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      if (cross_properly(edges[i].first, edges[i].second, edges[j].first, edges[j].second)) return true;
    }
  }
  return false;
}

/// Whether a vertex of the rings lies within `distance` (steps) of an edge of them that does not end in it.
bool touches_itself(const PlanarGraph& graph, const std::vector<LabelledRing>& rings, double distance) {
  for (const LabelledRing& ring : rings) {
    for (std::size_t k = 0; k < ring.vertices.size(); ++k) {
      const int from = ring.vertices[k], to = ring.vertices[(k + 1) % ring.vertices.size()];
      const Vec2 a = to_vec2(graph.point(from)), b = to_vec2(graph.point(to));
      for (const LabelledRing& other : rings) {
        for (const int v : other.vertices) {
          if (v != from && v != to && distance_to_line(to_vec2(graph.point(v)), a, b) <= distance)
            return true;
        }
      }
    }
  }
  return false;
}

/// Whether the face is a polygon the right way round without the `dropped` vertices.
bool is_simple(const PlanarGraph& graph, const Face& face, const std::vector<char>& dropped,
               double distance) {
  std::vector<LabelledRing> rings;
  for (const auto& ring : face.rings) {
    rings.push_back(labelled_ring(graph, ring, dropped));
    Ring points;
    for (const int v : rings.back().vertices) points.push_back(to_vec2(graph.point(v)));
    const double area = signed_area(points);
    if (rings.size() == 1 ? area <= 0.0 : area >= 0.0) return false;
  }
  return !crosses_itself(graph, rings) && !touches_itself(graph, rings, distance);
}

/// A chain is a piece of joint or outline between two vertices at which more than two edges meet or the label changes.
/// Both of its sides lose the same vertices, so that blocks neither overlap nor part whatever the tolerance.
class ChainSimplifier {
 public:
  /// Both in steps. Vertices do not come within `distance` of other edges.
  ChainSimplifier(const PlanarGraph& graph, double tolerance, double distance)
      : graph_(graph),
        simplifier_(graph, tolerance),
        distance_(distance),
        edges_at_(graph.points.size()),
        seen_(graph.edges.size(), 0),
        dropped_(graph.points.size(), 0) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      edges_at_[at(graph.edges[e].from)].push_back(static_cast<HalfEdge>(2 * e));
      edges_at_[at(graph.edges[e].to)].push_back(static_cast<HalfEdge>(2 * e + 1));
    }
  }

  /// The vertices to leave out. A face that would cross itself or turn over keeps all of its vertices, and with it its
  /// neighbours keep those that they share.
  std::vector<char> run() {
    for (std::size_t v = 0; v < edges_at_.size(); ++v) {
      if (is_inner(static_cast<int>(v))) continue;
      for (const HalfEdge h : edges_at_[v]) follow(h);
    }
    follow_rings();
    while (restore_faces()) {
    }
    return std::move(dropped_);
  }

 private:
  /// What is left are rings without ends. Their lowest vertex is one that both sides agree on.
  void follow_rings() {
    std::vector<int> by_place;
    for (std::size_t e = 0; e < seen_.size(); ++e) {
      if (!seen_[e]) by_place.insert(by_place.end(), {graph_.edges[e].from, graph_.edges[e].to});
    }
    std::sort(by_place.begin(), by_place.end(),
              [&](int v, int w) { return graph_.point(v) < graph_.point(w); });
    for (const int v : by_place) follow(edges_at_[at(v)].front());
  }

  /// Faces that are not simple get all their vertices back. Whether any did.
  bool restore_faces() {
    bool restored = false;
    for (const Face& face : graph_.faces) {
      if (is_simple(graph_, face, dropped_, distance_)) continue;
      for (const auto& ring : face.rings) {
        for (const HalfEdge h : ring) restored = std::exchange(dropped_[at(graph_.origin(h))], 0) || restored;
      }
    }
    return restored;
  }

  [[nodiscard]] bool is_inner(int vertex) const {
    const auto& edges = edges_at_[at(vertex)];
    return edges.size() == 2 && graph_.edge(edges[0]).label == graph_.edge(edges[1]).label;
  }

  void follow(HalfEdge h) {
    if (seen_[at(h / 2)]) return;
    const int start = graph_.origin(h);
    std::vector<int> chain{start};
    for (;;) {
      seen_[at(h / 2)] = 1;
      const int v = graph_.target(h);
      if (v == start) break;
      chain.push_back(v);
      if (!is_inner(v)) break;
      const auto& edges = edges_at_[at(v)];
      h = edges[0] == (h ^ 1) ? edges[1] : edges[0];
    }
    const bool closed = graph_.target(h) == start;
    const std::vector<bool>& keep =
        simplifier_.kept(chain, {0, closed ? simplifier_.farthest(chain) : chain.size() - 1});
    for (std::size_t k = 0; k < chain.size(); ++k) dropped_[at(chain[k])] = !keep[k];
  }

  const PlanarGraph& graph_;
  RingSimplifier simplifier_;
  double distance_;
  std::vector<std::vector<HalfEdge>> edges_at_;  ///< that leave each vertex
  std::vector<char> seen_;                       ///< per edge
  std::vector<char> dropped_;                    ///< per vertex
};

/// The block of a face. Points of the graph, in metres, are moved by `shift`.
CutBlock block_of(const PlanarGraph& graph, const Face& face, std::vector<LabelledRing> rings, Vec2 shift) {
  CutBlock block;
  block.excavations = face.excavations;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    Ring outline;
    for (const int v : rings[r].vertices) outline.push_back(shift + graph.grid * to_vec2(graph.point(v)));
    r == 0 ? block.polygon.outer = std::move(outline) : block.polygon.holes.emplace_back(std::move(outline));
    block.labels.push_back(std::move(rings[r].labels));
  }
  return block;
}

void check_outline(const PlanarGraph& graph, const std::vector<LabelledRing>& rings, const CutBlock& block) {
  if (!crosses_itself(graph, rings)) return;
  const Vec2 place = block.polygon.outer.front();
  throw RunError(fmt::format("cutting failed: the block at ({}, {}) crosses itself", place.x, place.y));
}

}  // namespace

std::vector<CutBlock> outlines_of(const PlanarGraph& graph, double collinear, double straight, Vec2 shift,
                                  CutStatistics& statistics) {
  std::vector<char> dropped(graph.points.size(), 0);
  if (collinear > straight)
    dropped = ChainSimplifier(graph, collinear / graph.grid, straight / graph.grid).run();
  RingSimplifier simplifier(graph, std::min(collinear, straight) / graph.grid);
  std::vector<char> seen(graph.points.size(), 0);  // 1: a vertex of a face, 2: a vertex of a block
  std::vector<CutBlock> blocks;
  blocks.reserve(graph.faces.size());
  for (const Face& face : graph.faces) {
    std::vector<LabelledRing> full, rings;
    for (const auto& ring : face.rings) {
      full.push_back(labelled_ring(graph, ring, dropped));
      for (const HalfEdge h : ring) seen[at(graph.origin(h))] |= 1;
    }
    const std::vector<int> common = common_vertices(full);
    for (const LabelledRing& ring : full) {
      rings.push_back(collinear > 0.0 ? simplifier.simplified(ring, common) : ring);
    }
    if (crosses_itself(graph, rings)) rings = full;
    for (const LabelledRing& ring : rings) {
      for (const int v : ring.vertices) seen[at(v)] |= 2;
    }
    blocks.push_back(block_of(graph, face, std::move(rings), shift));
    check_outline(graph, full, blocks.back());
  }
  statistics.merged_vertices += static_cast<int>(std::count(seen.begin(), seen.end(), 1));
  return blocks;
}

}  // namespace keyblock::cutting
