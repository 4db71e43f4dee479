#include "cutting/outline.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace keyblock::cutting {

namespace {

/// A ring on the way out: vertex numbers and the label of the edge that leaves each.
struct LabelledRing {
  std::vector<int> vertices;
  std::vector<EdgeLabel> labels;
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
    keep_.assign(n, false);
    std::vector<std::size_t> anchors{0, farthest(ring)};
    for (std::size_t k = 0; k < n; ++k) {
      const bool label_changes = !(ring.labels[k] == ring.labels[(k + n - 1) % n]);
      const bool is_pinned = std::binary_search(pinned.begin(), pinned.end(), ring.vertices[k]);
      if (label_changes || is_pinned) anchors.push_back(k);
    }
    std::sort(anchors.begin(), anchors.end());
    anchors.erase(std::unique(anchors.begin(), anchors.end()), anchors.end());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      keep_[anchors[i]] = true;
      const std::size_t end = i + 1 < anchors.size() ? anchors[i + 1] : n + anchors.front();
      simplify(ring, anchors[i], end);
    }
    LabelledRing result;
    for (std::size_t k = 0; k < n; ++k) {
      if (!keep_[k]) continue;
      result.vertices.push_back(ring.vertices[k]);
      result.labels.push_back(ring.labels[k]);
    }
    return result;
  }

 private:
  [[nodiscard]] Vec2 place(const LabelledRing& ring, std::size_t k) const {
    return to_vec2(graph_.point(ring.vertices[k % ring.vertices.size()]));
  }

  /// The vertex farthest from the first one: like the first one a corner of the convex hull.
  [[nodiscard]] std::size_t farthest(const LabelledRing& ring) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < ring.vertices.size(); ++k) {
      if (squared_norm(place(ring, k) - place(ring, 0)) > squared_norm(place(ring, best) - place(ring, 0))) {
        best = k;
      }
    }
    return best;
  }

  void simplify(const LabelledRing& ring, std::size_t from, std::size_t to) {
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
    keep_[worst % ring.vertices.size()] = true;
    simplify(ring, from, worst);
    simplify(ring, worst, to);
  }

  const PlanarGraph& graph_;
  double tolerance_;  ///< steps
  std::vector<bool> keep_;
};

/// Begins at the lowest, then leftmost vertex. Vertex numbers are sorted by place only before vertices are moved, so
/// the points are compared.
LabelledRing labelled_ring(const PlanarGraph& graph, const std::vector<HalfEdge>& ring) {
  const auto lowest = std::min_element(ring.begin(), ring.end(), [&](HalfEdge g, HalfEdge h) {
    return graph.point(graph.origin(g)) < graph.point(graph.origin(h));
  });
  LabelledRing result;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const HalfEdge h = ring[(k + static_cast<std::size_t>(lowest - ring.begin())) % ring.size()];
    result.vertices.push_back(graph.origin(h));
    EdgeLabel label = graph.edge(h).label;
    if (label.kind == EdgeKind::domain) label.index = 0;
    result.labels.push_back(label);
  }
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

}  // namespace

std::vector<CutBlock> outlines_of(const PlanarGraph& graph, double collinear, Vec2 shift,
                                  CutStatistics& statistics) {
  RingSimplifier simplifier(graph, collinear / graph.grid);
  std::vector<char> seen(graph.points.size(), 0);  // 1: a vertex of a face, 2: a vertex of a block
  std::vector<CutBlock> blocks;
  blocks.reserve(graph.faces.size());
  for (const Face& face : graph.faces) {
    std::vector<LabelledRing> full, rings;
    for (const auto& ring : face.rings) {
      full.push_back(labelled_ring(graph, ring));
      for (const int v : full.back().vertices) {
        seen[static_cast<std::size_t>(v)] |= 1;
      }
    }
    const std::vector<int> common = common_vertices(full);
    for (const LabelledRing& ring : full) {
      rings.push_back(collinear > 0.0 ? simplifier.simplified(ring, common) : ring);
    }
    if (crosses_itself(graph, rings)) rings = full;
    CutBlock block;
    block.excavations = face.excavations;
    for (std::size_t r = 0; r < rings.size(); ++r) {
      Ring outline;
      for (const int v : rings[r].vertices) {
        outline.push_back(shift + graph.grid * to_vec2(graph.point(v)));
        seen[static_cast<std::size_t>(v)] |= 2;
      }
      r == 0 ? block.polygon.outer = std::move(outline)
             : block.polygon.holes.emplace_back(std::move(outline));
      block.labels.push_back(std::move(rings[r].labels));
    }
    if (crosses_itself(graph, full)) {
      const Vec2 place = block.polygon.outer.front();
      throw RunError(fmt::format("cutting failed: the block at ({}, {}) crosses itself", place.x, place.y));
    }
    blocks.push_back(std::move(block));
  }
  statistics.merged_vertices += static_cast<int>(std::count(seen.begin(), seen.end(), 1));
  return blocks;
}

}  // namespace keyblock::cutting
