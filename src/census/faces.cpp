#include "census/faces.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "cutting/interfaces.h"
#include "cutting/segment_index.h"

namespace keyblock::census {
namespace {

using cutting::BlockSystem;
using cutting::CutBlock;
using cutting::EdgeKind;

struct Edge {
  int block = 0;
  Vec2 from, to;
  cutting::EdgeLabel label;
};

struct Stretch {
  double from = 0.0, to = 0.0;  ///< m along an edge
  int block = 0;
};

std::vector<Edge> edges_of(const BlockSystem& system) {
  std::vector<Edge> edges;
  for (std::size_t b = 0; b < system.blocks.size(); ++b) {
    const CutBlock& block = system.blocks[b];
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k)
        edges.push_back({static_cast<int>(b), ring[k], ring[(k + 1) % ring.size()], block.labels[r][k]});
    }
  }
  return edges;
}

/// What an edge has in common with one that runs the other way; empty where they do not lie against each other.
Stretch common_stretch(const Edge& edge, const Edge& other, double reach) {
  const double length = norm(edge.to - edge.from);
  const Vec2 along = (edge.to - edge.from) / length;
  const double start = dot(along, other.to - edge.from), end = dot(along, other.from - edge.from);
  const Stretch none{0.0, 0.0, other.block};
  if (!(start < end)) return none;
  const double start_off = cross(along, other.to - edge.from), end_off = cross(along, other.from - edge.from);
  const double low = std::max(0.0, start), high = std::min(length, end);
  if (high - low <= reach) return none;
  const auto off = [&](double s) { return std::lerp(start_off, end_off, (s - start) / (end - start)); };
  if (std::abs(off(low)) > reach || std::abs(off(high)) > reach) return none;
  return {low, high, other.block};
}

/// m of an edge that no stretch covers.
double uncovered(std::vector<Stretch>& stretches, double length) {
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  double open = 0.0, reached = 0.0;
  for (const Stretch& s : stretches) {
    open += std::max(0.0, s.from - reached);
    reached = std::max(reached, s.to);
  }
  return open + std::max(0.0, length - reached);
}

}  // namespace

double touching_distance(const BlockSystem& system) {
  constexpr double share_of_size = 1e-4;
  double sum = 0.0;
  for (const CutBlock& block : system.blocks) sum += area(block.polygon);
  return share_of_size * std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, system.blocks.size())));
}

std::vector<std::vector<Face>> find_faces(const BlockSystem& system) {
  const std::vector<Edge> edges = edges_of(system);
  const double reach = touching_distance(system);
  Box box;
  for (const Edge& edge : edges) box.add(edge.from);
  const auto columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(edges.size() + 1))));
  cutting::SegmentIndex index(box, columns);
  for (std::size_t e = 0; e < edges.size(); ++e) index.add(static_cast<int>(e), edges[e].from, edges[e].to);

  std::vector<std::vector<Face>> faces(system.blocks.size());
  std::vector<int> found;
  std::vector<Stretch> stretches;
  for (const Edge& edge : edges) {
    Box around;
    around.add(edge.from);
    around.add(edge.to);
    found.clear();
    stretches.clear();
    index.near(around.grown(reach), [&](int id) { found.push_back(id); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const int id : found) {
      if (edges[at(id)].block == edge.block) continue;
      const Stretch common = common_stretch(edge, edges[at(id)], reach);
      if (common.to > common.from) stretches.push_back(common);
    }
    const auto label_towards = [&](int block) {
      return cutting::joint_between(system, at(edge.block), at(block)).value_or(edge.label);
    };
    std::vector<Face>& own = faces[at(edge.block)];
    const double open = uncovered(stretches, norm(edge.to - edge.from));
    for (const Stretch& s : stretches)
      own.push_back({edge.from, edge.to, label_towards(s.block), s.block, s.to - s.from});
    if (open <= reach) continue;
    const int beyond = edge.label.kind == EdgeKind::domain ? edge_of_domain : nothing;
    own.push_back({edge.from, edge.to, edge.label, beyond, open});
  }
  return faces;
}

}  // namespace keyblock::census
