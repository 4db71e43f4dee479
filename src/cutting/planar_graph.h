#pragma once
#include <vector>

#include "cutting/block_system.h"
#include "cutting/grid_point.h"

namespace keyblock::cutting {

/// A straight edge between two vertices, with the faces on its two sides as seen from `from` to `to`.
struct GraphEdge {
  int from = 0;
  int to = 0;
  EdgeLabel label;
  int left = -1;  ///< −1: outside of the domain, or not known yet
  int right = -1;
};

/// Edge e seen from its `from` is half-edge 2e, seen from its `to` half-edge 2e + 1.
using HalfEdge = int;

/// A region bounded by edges; a block in the making.
struct Face {
  /// Ring 0 is the outer one, counter-clockwise, then the holes, clockwise. No vertex comes twice in a ring; two rings
  /// may touch in one.
  std::vector<std::vector<HalfEdge>> rings;
  std::vector<int> excavations;
  double area = 0.0;       ///< m²
  double perimeter = 0.0;  ///< m
};

/// A plane straight-line graph on a grid: edges meet in their ends only. Vertices are never renumbered; one
/// without edges is no longer there.
class PlanarGraph {
 public:
  double grid = 0.0;  ///< m
  std::vector<GridPoint> points;
  std::vector<GraphEdge> edges;
  std::vector<Face> faces;

  [[nodiscard]] int origin(HalfEdge h) const { return h % 2 == 0 ? edge(h).from : edge(h).to; }
  [[nodiscard]] int target(HalfEdge h) const { return origin(h ^ 1); }
  [[nodiscard]] int face_left_of(HalfEdge h) const { return h % 2 == 0 ? edge(h).left : edge(h).right; }
  [[nodiscard]] const GraphEdge& edge(HalfEdge h) const { return edges[static_cast<std::size_t>(h / 2)]; }
  [[nodiscard]] GridPoint point(int vertex) const { return points[static_cast<std::size_t>(vertex)]; }
  [[nodiscard]] double length(const GraphEdge& e) const {
    return grid * norm(to_vec2(point(e.to)) - to_vec2(point(e.from)));
  }

  /// Indices of the edges that begin or end at each vertex, ascending.
  [[nodiscard]] std::vector<std::vector<int>> edges_of_vertices() const;

  /// Takes away dead ends (edges to a vertex that has no other, again and again) and bridges (edges with the same
  /// face on both sides). Returns what was taken.
  std::vector<GraphEdge> remove_trees();

  /// Finds the faces anew and sets left and right of the edges. A face takes the excavations of the old face
  /// on that side of one of its edges. Precondition: no trees; a component within another lies in one of its
  /// faces or outside of all.
  void trace_faces();

 private:
  void remove_dead_ends(std::vector<GraphEdge>& removed);
};

/// The half-edges that leave each vertex, counter-clockwise.
class Rotation {
 public:
  explicit Rotation(const PlanarGraph& graph);
  /// Half-edge that follows h around the face on its left.
  [[nodiscard]] HalfEdge next(HalfEdge h) const;
  /// walks[h]: number of the closed walk around a face that half-edge h belongs to.
  [[nodiscard]] std::vector<int> walks(int& count) const;

 private:
  std::vector<int> first_;  ///< per vertex, into sorted_
  std::vector<HalfEdge> sorted_;
  std::vector<int> place_;   ///< of each half-edge in sorted_
  std::vector<int> vertex_;  ///< origin of each half-edge
};

}  // namespace keyblock::cutting
