#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

#include "cutting/cleaning.h"
#include "cutting/local_size.h"

namespace keyblock::cutting {

namespace {

class SliverMerger {
 public:
  SliverMerger(PlanarGraph& graph, const CutTolerances& tolerances)
      : graph_(graph), tolerances_(tolerances), local_(graph, tolerances.size), regions_(graph.faces.size()) {
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

 private:
  struct Region {
    double area = 0.0, perimeter = 0.0;
    std::size_t into = 0;  ///< the region it became a part of; itself while alive
    std::vector<std::size_t> edges;
  };

  void consider(std::size_t f) {
    const Region& r = regions_[f];
    const auto is_below = [&](double area, double thickness) {
      return r.area < area || r.area < thickness * r.perimeter;
    };
    if (!is_below(tolerances_.sliver_area, tolerances_.sliver_thickness)) return;
    const double share = local_.share(f);
    const double area = tolerances_.sliver_area_is_given ? 1.0 : share * share;
    const double thickness = tolerances_.sliver_thickness_is_given ? 1.0 : share;
    if (is_below(area * tolerances_.sliver_area, thickness * tolerances_.sliver_thickness))
      queue_.emplace(r.area, f);
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

  void merge(std::size_t f) {
    std::map<std::size_t, double> borders;  // by neighbour, m
    for (const std::size_t e : regions_[f].edges) {
      const std::size_t other = neighbour(f, graph_.edges[e]);
      if (other == f || graph_.faces[f].excavations != graph_.faces[other].excavations) continue;
      borders[other] += graph_.length(graph_.edges[e]);
    }
    if (borders.empty()) return;
    const auto& [best, length] = *std::max_element(
        borders.begin(), borders.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    ++merged_;
    merged_area_ += regions_[f].area;
    Region& target = regions_[best];
    regions_[f].into = best;
    target.area += regions_[f].area;
    target.perimeter += regions_[f].perimeter - 2.0 * length;
    target.edges.insert(target.edges.end(), regions_[f].edges.begin(), regions_[f].edges.end());
    std::erase_if(target.edges, [&](std::size_t e) {
      const GraphEdge& edge = graph_.edges[e];
      return edge.left >= 0 && edge.right >= 0 && root(edge.left) == root(edge.right);
    });
    consider(best);
  }

  PlanarGraph& graph_;
  const CutTolerances& tolerances_;
  LocalSize local_;  ///< of the blocks before any is merged
  std::vector<Region> regions_;
  int merged_ = 0;
  double merged_area_ = 0.0;
  using Entry = std::tuple<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

void merge_slivers(PlanarGraph& graph, const CutTolerances& tolerances, CutStatistics& statistics) {
  if (!(tolerances.sliver_area > 0.0) && !(tolerances.sliver_thickness > 0.0)) return;
  SliverMerger merger(graph, tolerances);
  merger.run();
  statistics.merged_slivers += merger.merged();
  statistics.sliver_area += merger.merged_area();
}

}  // namespace keyblock::cutting
