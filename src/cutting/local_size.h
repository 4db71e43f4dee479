#pragma once
#include <vector>

#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// What is small is small beside the blocks around it. Tolerances that were chosen for a model of size L (m) are lowered where these
/// blocks are smaller than L/80: by their size over L/80.
///
/// The blocks around a face are those up to 32 that are fewest steps over edges away, itself included; the way leads through no
/// face of more than 10⁴ times its area. Their size is the square root of an area that four in five of them do not
/// exceed: there are slivers among them.
class LocalSize {
 public:
  /// Size 0: tolerances are as given, everywhere. The graph must outlive this.
  LocalSize(const PlanarGraph& graph, double size) : graph_(graph), size_(size) {}

  /// By what tolerances are multiplied at a face: above 0, at most 1.
  double share(std::size_t face);

 private:
  [[nodiscard]] double size_around(std::size_t face) const;

  const PlanarGraph& graph_;
  double size_;
  std::vector<double> known_;  ///< by face; 0: not asked for yet
};

}  // namespace keyblock::cutting
