#pragma once
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "core/index.h"

namespace keyblock::contact {

/// What belongs to a vertex and an edge each, ascending by vertex, then edge: that of both is found at once. T has the members `vertex` and
/// `edge`.
template <typename T>
class VertexEdgeList {
 public:
  /// Of a surface of so many vertices.
  void assign(std::vector<T> all, std::size_t vertices) {
    all_ = std::move(all);
    of_vertex_.assign(vertices + 1, 0);
    for (const T& one : all_) ++of_vertex_[at(one.vertex) + 1];
    std::partial_sum(of_vertex_.begin(), of_vertex_.end(), of_vertex_.begin());
  }
  /// Null where there is none.
  [[nodiscard]] const T* find(int vertex, int edge) const {
    if (all_.empty()) return nullptr;
    for (int k = of_vertex_[at(vertex)]; k < of_vertex_[at(vertex) + 1]; ++k)
      if (all_[at(k)].edge == edge) return &all_[at(k)];
    return nullptr;
  }
  [[nodiscard]] bool empty() const { return all_.empty(); }
  [[nodiscard]] const std::vector<T>& all() const { return all_; }
  /// Vertices and edges have to stay as they are.
  [[nodiscard]] std::vector<T>& all() { return all_; }

 private:
  std::vector<T> all_;
  std::vector<int> of_vertex_;  ///< where those of each vertex begin; empty before assign()
};

}  // namespace keyblock::contact
