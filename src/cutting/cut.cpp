#include "cutting/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/index.h"
#include "cutting/bridges.h"
#include "cutting/cleaning.h"
#include "cutting/linework.h"
#include "cutting/noding.h"
#include "cutting/outline.h"
#include "cutting/sliver_limits.h"

namespace keyblock::cutting {

CutTolerances CutTolerances::for_domain(double domain_area, double trace_length) {
  constexpr double most_spacings = 80.0;
  double size = std::sqrt(domain_area);
  if (trace_length > 0.0) size = std::min(size, most_spacings * domain_area / trace_length);
  return for_size(size);
}

CutTolerances CutTolerances::for_size(double size) {
  CutTolerances t;
  t.size = size;
  t.snapping = 5e-5 * size;
  t.sliver_area = 2.5e-6 * size * size;
  t.sliver_thickness = 2.5e-4 * size;
  t.cluster = 2.5e-4 * size;
  t.collinear = 5e-8 * size;
  return t;
}

namespace {

/// Share of the domain's area by which the blocks may miss it.
constexpr double area_tolerance = 1e-9;
/// An edge goes through a vertex that it passes within this share of the cluster distance.
constexpr double edge_share = 0.2;
/// Lines that should coincide or meet were rounded to less than this many steps of the grid apart.
constexpr double vertex_rounding = 4.0, edge_rounding = 2.0;
/// A domain farther from the origin than this many times its size gets a local origin.
constexpr double far_away = 1000.0;

bool is_joint(EdgeLabel label) {
  return label.kind == EdgeKind::joint_set || label.kind == EdgeKind::trace_map;
}

/// A set of traces, of which the pieces are known.
class TraceMarks {
 public:
  explicit TraceMarks(const std::vector<int>& trace_of_piece) : trace_of_piece_(trace_of_piece) {}

  void add(const std::vector<int>& pieces) {
    for (const int piece : pieces) {
      const int trace = trace_of_piece_[at(piece)];
      if (at(trace) >= marked_.size()) marked_.resize(at(trace) + 1, false);
      marked_[at(trace)] = true;
    }
  }
  [[nodiscard]] int count() const {
    return static_cast<int>(std::count(marked_.begin(), marked_.end(), true));
  }

 private:
  const std::vector<int>& trace_of_piece_;
  std::vector<bool> marked_;
};

JointShare& share_of(EdgeLabel joint, std::vector<JointShare>& shares) {
  const auto found = std::ranges::find(shares, joint, &JointShare::joint);
  return found != shares.end() ? *found : shares.emplace_back(JointShare{joint, 0.0, 0.0});
}

/// All that is cut along as a trace: those of joints, then bridges in gaps.
std::vector<rockmass::Trace> all_traces(const CutInput& input) {
  std::vector<rockmass::Trace> traces = input.traces;
  if (input.bridges)
    traces.insert(traces.end(), input.bridges->in_gaps.begin(), input.bridges->in_gaps.end());
  return traces;
}

NodedLinework noded_with_bridges(const CutInput& input, const std::vector<rockmass::Trace>& traces,
                                 double snapping, Linework& work) {
  NodedLinework noded = node(work);
  if (!input.bridges || !input.bridges->at_dead_ends) return noded;
  const std::vector<SourceLine> bridges =
      bridges_from_dead_ends(work, noded, traces, snapping, input.bridges->label);
  work.lines.insert(work.lines.end(), bridges.begin(), bridges.end());
  return node(work);
}

/// Takes away what bounds no block, and counts it.
class Bounded {
 public:
  Bounded(const CutInput& input, const std::vector<rockmass::Trace>& traces, NodedLinework& noded,
          BlockSystem& system)
      : input_(input),
        traces_(traces),
        noded_(noded),
        system_(system),
        numbers_(rockmass::trace_numbers(traces)) {}

  void run() {
    CutStatistics& statistics = system_.statistics;
    PlanarGraph& graph = noded_.graph;
    TraceMarks meeting(numbers_), used(numbers_);
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      const GraphEdge& edge = graph.edges[e];
      if (is_bridge(edge)) {
        share_of(joint_of(e), system_.joints).bridged += graph.length(edge);
        continue;
      }
      meeting.add(noded_.traces[e]);
      if (is_joint(edge.label)) share_of(edge.label, system_.joints).length += graph.length(edge);
    }
    const std::vector<GraphEdge> before = graph.edges;
    const std::vector<GraphEdge> removed = graph.remove_trees();
    for (const GraphEdge& edge : removed) {
      if (!is_bridge(edge)) share_of(edge.label, system_.joints).removed += graph.length(edge);
    }
    // What is left keeps its order.
    std::size_t left = 0;
    for (std::size_t e = 0; e < before.size(); ++e) {
      const GraphEdge& edge = before[e];
      const bool is_left =
          left < graph.edges.size() && graph.edges[left].from == edge.from && graph.edges[left].to == edge.to;
      if (is_left) ++left;
      if (is_left && !is_bridge(edge)) used.add(noded_.traces[e]);
      if (!is_left && is_bridge(edge)) share_of(joint_of(e), system_.joints).bridged -= graph.length(edge);
    }
    for (const JointShare& share : system_.joints) {
      statistics.trace_length += share.length;
      statistics.removed_length += share.removed;
      statistics.bridge_length += share.bridged;
    }
    statistics.removed_pieces += static_cast<int>(removed.size());
    statistics.traces = meeting.count();
    statistics.joints_used = used.count();
  }

 private:
  [[nodiscard]] bool is_bridge(const GraphEdge& edge) const {
    return input_.bridges && edge.label == input_.bridges->label;
  }
  /// The joint on whose line a bridge lies.
  [[nodiscard]] EdgeLabel joint_of(std::size_t e) const {
    return label_of(traces_[at(noded_.traces[e].front())]);
  }

  const CutInput& input_;
  const std::vector<rockmass::Trace>& traces_;
  NodedLinework& noded_;
  BlockSystem& system_;
  std::vector<int> numbers_;  ///< of traces
};

/// A point inside the face: the middle of the widest stretch of a horizontal line through it.
Vec2 interior_point(const PlanarGraph& graph, const Face& face) {
  std::vector<double> heights;
  for (const HalfEdge h : face.rings.front()) heights.push_back(to_vec2(graph.point(graph.origin(h))).y);
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  const std::size_t middle = (heights.size() - 1) / 2;
  const double y = 0.5 * (heights[middle] + heights[middle + 1]);
  std::vector<double> crossings;
  for (const auto& ring : face.rings) {
    for (const HalfEdge h : ring) {
      const Vec2 a = to_vec2(graph.point(graph.origin(h))), b = to_vec2(graph.point(graph.target(h)));
      if ((a.y > y) != (b.y > y)) crossings.push_back(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  Vec2 best{0.0, y};
  double widest = -1.0;
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    if (crossings[k + 1] - crossings[k] > widest) {
      widest = crossings[k + 1] - crossings[k];
      best.x = 0.5 * (crossings[k] + crossings[k + 1]);
    }
  }
  return best;
}

void find_excavations(PlanarGraph& graph, const std::vector<Ring>& outlines) {
  for (Face& face : graph.faces) {
    const Vec2 inside = interior_point(graph, face);
    for (std::size_t k = 0; k < outlines.size(); ++k) {
      if (contains(outlines[k], inside)) face.excavations.push_back(static_cast<int>(k));
    }
  }
}

void check_area(const PlanarGraph& graph, double domain_area) {
  double sum = 0.0;
  for (const Face& face : graph.faces) sum += face.area;
  if (!(std::abs(sum - domain_area) <= area_tolerance * domain_area)) {
    throw RunError(
        fmt::format("cutting failed: the blocks have an area of {} m², the domain {} m²", sum, domain_area));
  }
}

/// Blocks that only the tolerances that were given keep from being merged; places in metres of the graph.
std::vector<SmallBlock> slivers_left(const PlanarGraph& graph, const CutTolerances& given,
                                     const JointStrengths& strengths) {
  std::vector<SmallBlock> left;
  if (!given.sliver_area_is_given && !given.sliver_thickness_is_given) return left;
  const CutTolerances usual = CutTolerances::for_size(given.size);
  SliverLimits limits(graph, usual);
  for (std::size_t f = 0; f < graph.faces.size(); ++f) {
    const Face& face = graph.faces[f];
    if (!limits.is_sliver(f, face.area, face.perimeter)) continue;
    const auto by_strength = [&](HalfEdge g, HalfEdge h) {
      return strengths.of(graph.edge(g).label) < strengths.of(graph.edge(h).label);
    };
    const auto& ring = face.rings.front();
    const HalfEdge weakest = *std::min_element(ring.begin(), ring.end(), by_strength);
    left.push_back(
        {graph.edge(weakest).label, graph.grid * to_vec2(graph.point(graph.origin(weakest))), face.area});
  }
  return left;
}

void sort_blocks(std::vector<CutBlock>& blocks) {
  struct Key {
    Vec2 centroid;
    std::size_t index;
  };
  std::vector<Key> keys;
  for (std::size_t k = 0; k < blocks.size(); ++k) keys.push_back({centroid(blocks[k].polygon), k});
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.centroid.y, a.centroid.x, a.index) < std::tie(b.centroid.y, b.centroid.x, b.index);
  });
  std::vector<CutBlock> sorted;
  sorted.reserve(blocks.size());
  for (const Key& key : keys) sorted.push_back(std::move(blocks[key.index]));
  blocks = std::move(sorted);
}

}  // namespace

BlockSystem cut(const CutInput& input) {
  const double rough_area = std::abs(signed_area(input.domain));
  const CutTolerances tolerances = input.tolerances.value_or(CutTolerances::for_domain(rough_area));
  Linework work = make_linework(input, tolerances);

  BlockSystem system;
  CutStatistics& statistics = system.statistics;
  statistics.domain_area = work.domain_area;
  const double size =
      work.grid * std::max(bounds({work.domain, {}}).size().x, bounds({work.domain, {}}).size().y);
  if (norm(work.shift) > far_away * size) system.origin = work.shift;

  const std::vector<rockmass::Trace> traces = all_traces(input);
  NodedLinework noded = noded_with_bridges(input, traces, tolerances.snapping, work);
  Bounded(input, traces, noded, system).run();
  PlanarGraph& graph = noded.graph;
  graph.trace_faces();
  cluster_vertices(graph, vertex_rounding * graph.grid);
  snap_vertices_to_edges(graph, edge_rounding * graph.grid);
  find_excavations(graph, work.excavations);
  check_area(graph, work.domain_area);

  const Vec2 shift = work.shift - system.origin;
  const auto merge = [&] {
    for (JointTooth tooth : merge_slivers(graph, tolerances, input.strengths, statistics)) {
      tooth.place += shift;
      statistics.highest_tooth = std::max(statistics.highest_tooth, tooth.height);
      system.teeth.push_back(tooth);
    }
  };
  merge();
  const double local = tolerances.cluster_is_given ? 0.0 : tolerances.size;
  statistics.merged_vertices += cluster_vertices(graph, tolerances.cluster, input.strengths, local);
  snap_vertices_to_edges(graph, edge_share * tolerances.cluster, input.strengths, local);
  merge();
  check_area(graph, work.domain_area);
  for (SmallBlock block : slivers_left(graph, tolerances, input.strengths)) {
    block.place += shift;
    system.slivers_left.push_back(block);
  }
  statistics.slivers_left = static_cast<int>(system.slivers_left.size());

  // No default is larger than that of a domain without traces.
  const double straight = CutTolerances::for_domain(rough_area).collinear;
  system.blocks = outlines_of(graph, tolerances.collinear, straight, shift, statistics);
  sort_blocks(system.blocks);
  return system;
}

}  // namespace keyblock::cutting
