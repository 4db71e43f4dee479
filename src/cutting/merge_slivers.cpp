#include <algorithm>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "cutting/cleaning.h"
#include "cutting/joint_course.h"
#include "cutting/sliver_limits.h"

namespace keyblock::cutting {

namespace {

class SliverMerger {
 public:
  SliverMerger(PlanarGraph& graph, const CutTolerances& tolerances, const JointStrengths& strengths)
      : graph_(graph), strengths_(strengths), limits_(graph, tolerances), regions_(graph.faces.size()) {
    for (std::size_t f = 0; f < regions_.size(); ++f) {
      regions_[f].area = graph.faces[f].area;
      regions_[f].perimeter = graph.faces[f].perimeter;
      regions_[f].into = f;
    }
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      for (const int side : {graph.edges[e].left, graph.edges[e].right}) {
        if (side >= 0) regions_[static_cast<std::size_t>(side)].edges.push_back(e);
      }
    }
    for (std::size_t f = 0; f < regions_.size(); ++f) consider(f);
  }

  void run() {
    while (!queue_.empty()) {
      const auto [area, f] = queue_.top();
      queue_.pop();
      if (regions_[f].into == f && regions_[f].area == area) merge(f);
    }
    if (merged_ == 0) return;
    std::erase_if(graph_.edges, [&](const GraphEdge& e) {
      return e.left >= 0 && e.right >= 0 && root(e.left) == root(e.right);
    });
    graph_.trace_faces();
  }

  [[nodiscard]] int merged() const { return merged_; }
  [[nodiscard]] double merged_area() const { return merged_area_; }
  [[nodiscard]] int merged_across_joints() const { return merged_across_joints_; }
  [[nodiscard]] const std::vector<JointTooth>& teeth() const { return teeth_; }

 private:
  struct Region {
    double area = 0.0, perimeter = 0.0;
    std::size_t into = 0;  ///< the region it became a part of; itself while alive
    std::vector<std::size_t> edges;
  };

  void consider(std::size_t f) {
    const Region& r = regions_[f];
    if (limits_.is_sliver(f, r.area, r.perimeter)) queue_.emplace(r.area, f);
  }

  std::size_t root(int face) {
    auto f = static_cast<std::size_t>(face);
    while (regions_[f].into != f) f = regions_[f].into = regions_[regions_[f].into].into;
    return f;
  }

  /// The region across edge e as seen from f; f itself where there is none to merge with.
  std::size_t neighbour(std::size_t f, const GraphEdge& e) {
    if (e.label.kind == EdgeKind::excavation) return f;
    if (e.left < 0 || e.right < 0) return f;
    const std::size_t left = root(e.left), right = root(e.right);
    return left == f ? right : left;
  }

  /// What a region shares with one neighbour.
  struct Border {
    double length = 0.0;  ///< m
    std::vector<std::size_t> edges{};
    double strength = 0.0;  ///< Pa, of its weakest joint
    std::vector<JointCourse::Stretch> through{};
  };

  std::map<std::size_t, Border> borders_of(std::size_t f) {
    std::map<std::size_t, Border> borders;  // by neighbour
    for (const std::size_t e : regions_[f].edges) {
      const std::size_t other = neighbour(f, graph_.edges[e]);
      if (other == f || graph_.faces[f].excavations != graph_.faces[other].excavations) continue;
      Border& border = borders[other];
      border.length += graph_.length(graph_.edges[e]);
      border.edges.push_back(e);
    }
    for (auto& [other, border] : borders) look_at(border);
    return borders;
  }

  void look_at(Border& border) {
    if (!course_) {
      course_.emplace(graph_, [this](const GraphEdge& e) {
        return e.left < 0 || e.right < 0 || root(e.left) != root(e.right);
      });
    }
    border.strength = strengths_.of(graph_.edges[border.edges.front()].label);
    for (const std::size_t e : border.edges)
      border.strength = std::min(border.strength, strengths_.of(graph_.edges[e].label));
    border.through = course_->stretches(border.edges);
    std::erase_if(border.through, [](const JointCourse::Stretch& stretch) { return !stretch.runs_through; });
  }

  /// Across which border to merge: see cleaning.h.
  const std::pair<const std::size_t, Border>& best_of(std::size_t f,
                                                      const std::map<std::size_t, Border>& borders) const {
    constexpr double longest_tongue = 10.0, thin = 0.05, side_by_side = 0.9;
    const double area = regions_[f].area;
    double longest = 0.0;
    for (const auto& [other, border] : borders) longest = std::max(longest, border.length);
    const Vec2 upwards = area < thin * longest * longest ? upward_normal(f) : Vec2{};
    const bool is_strip = norm(upwards) > 0.0;
    const auto key = [&](const Border& border) {
      const bool is_side = is_strip && border.length > side_by_side * longest;
      const GraphEdge& edge = graph_.edges[border.edges.front()];
      return std::tuple(area <= longest_tongue * border.length * border.length, border.strength,
                        border.through.empty(), is_side ? longest : border.length,
                        dot(upwards, to_vec2(graph_.point(edge.from)) + to_vec2(graph_.point(edge.to))));
    };
    return *std::max_element(borders.begin(), borders.end(),
                             [&](const auto& a, const auto& b) { return key(a.second) < key(b.second); });
  }

  /// Normal on the longest edge of a region. Of the two the one that is alike for edges that are nearly parallel, unless
  /// they happen to lie along (0.36, −0.93).
  Vec2 upward_normal(std::size_t f) const {
    constexpr Vec2 ahead{0.93, 0.36};
    Vec2 along;
    for (const std::size_t e : regions_[f].edges) {
      const GraphEdge& edge = graph_.edges[e];
      const Vec2 d = to_vec2(graph_.point(edge.to)) - to_vec2(graph_.point(edge.from));
      if (squared_norm(d) > squared_norm(along)) along = d;
    }
    if (dot(along, ahead) < 0.0) along = -along;
    return Vec2{-along.y, along.x} / norm(along);
  }

  void note_teeth(std::size_t f, const Border& border) {
    if (!border.through.empty()) ++merged_across_joints_;
    for (const JointCourse::Stretch& stretch : border.through) {
      const Vec2 a = to_vec2(graph_.point(stretch.from)), b = to_vec2(graph_.point(stretch.to));
      double height = 0.0;
      for (const std::size_t e : regions_[f].edges) {
        for (const int v : {graph_.edges[e].from, graph_.edges[e].to})
          height = std::max(height, std::abs(cross(b - a, to_vec2(graph_.point(v)) - a)) / norm(b - a));
      }
      teeth_.push_back({stretch.label, 0.5 * graph_.grid * (a + b), graph_.grid * height});
    }
  }

  void merge(std::size_t f) {
    const std::map<std::size_t, Border> borders = borders_of(f);
    if (borders.empty()) return;
    const auto& [best, border] = best_of(f, borders);
    note_teeth(f, border);
    ++merged_;
    merged_area_ += regions_[f].area;
    Region& target = regions_[best];
    regions_[f].into = best;
    target.area += regions_[f].area;
    target.perimeter += regions_[f].perimeter - 2.0 * border.length;
    target.edges.insert(target.edges.end(), regions_[f].edges.begin(), regions_[f].edges.end());
    std::erase_if(target.edges, [&](std::size_t e) {
      const GraphEdge& edge = graph_.edges[e];
      return edge.left >= 0 && edge.right >= 0 && root(edge.left) == root(edge.right);
    });
    consider(best);
  }

  PlanarGraph& graph_;
  const JointStrengths& strengths_;
  std::optional<JointCourse> course_;  ///< where there are slivers
  SliverLimits limits_;                ///< of the blocks before any is merged
  std::vector<Region> regions_;
  int merged_ = 0, merged_across_joints_ = 0;
  std::vector<JointTooth> teeth_;  ///< metres of the graph
  double merged_area_ = 0.0;
  using Entry = std::tuple<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

std::vector<JointTooth> merge_slivers(PlanarGraph& graph, const CutTolerances& tolerances,
                                      const JointStrengths& strengths, CutStatistics& statistics) {
  if (!(tolerances.sliver_area > 0.0) && !(tolerances.sliver_thickness > 0.0)) return {};
  SliverMerger merger(graph, tolerances, strengths);
  merger.run();
  statistics.merged_slivers += merger.merged();
  statistics.merged_across_joints += merger.merged_across_joints();
  statistics.sliver_area += merger.merged_area();
  return merger.teeth();
}

}  // namespace keyblock::cutting
