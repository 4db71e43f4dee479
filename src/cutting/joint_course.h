#pragma once
#include <functional>
#include <vector>

#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// Follows joints from edge to edge. A joint goes on at a vertex along the edge of its own set or map that turns least, by less than
/// 30°, or along one of another label that turns by less than 1°.
class JointCourse {
 public:
  /// `is_there`: whether an edge still parts two faces. The graph must outlive this.
  JointCourse(const PlanarGraph& graph, std::function<bool(const GraphEdge&)> is_there);

  /// A stretch of a joint.
  struct Stretch {
    EdgeLabel label;
    int from = 0, to = 0;  ///< vertices
    /// Whether the joint goes on beyond both ends, or beyond one and reaches the edge of the domain or an outline at the other.
    bool runs_through = false;
  };

  /// The stretches of joints that given edges make up.
  [[nodiscard]] std::vector<Stretch> stretches(const std::vector<std::size_t>& edges);

 private:
  /// How a stretch ends.
  struct End {
    int vertex = 0;
    bool goes_on = false, at_edge_of_rock = false;
  };

  /// Follows the joint of half-edge h within the given edges, and marks them as seen.
  End follow(HalfEdge h);
  [[nodiscard]] HalfEdge next(HalfEdge h) const;
  [[nodiscard]] bool is_at_edge_of_rock(int vertex) const;

  const PlanarGraph& graph_;
  std::function<bool(const GraphEdge&)> is_there_;
  std::vector<std::vector<int>> incident_;
  enum class Mark : char { none, given, seen };
  std::vector<Mark> marks_;  ///< per edge
};

}  // namespace keyblock::cutting
