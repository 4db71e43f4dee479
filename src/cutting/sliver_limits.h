#pragma once
#include "cutting/cut.h"
#include "cutting/local_size.h"

namespace keyblock::cutting {

/// Which faces are slivers by the tolerances of a cut and the blocks around them.
class SliverLimits {
 public:
  /// Graph and tolerances must outlive this; faces are those that the graph has when this is made.
  SliverLimits(const PlanarGraph& graph, const CutTolerances& tolerances)
      : tolerances_(tolerances), local_(graph, tolerances.size) {}

  /// Whether a region about face f, of this area (m²) and perimeter (m), is one.
  bool is_sliver(std::size_t f, double area, double perimeter) {
    const auto is_below = [&](double area_share, double thickness_share) {
      return area < area_share * tolerances_.sliver_area ||
             area < thickness_share * tolerances_.sliver_thickness * perimeter;
    };
    if (!is_below(1.0, 1.0)) return false;
    const double share = local_.share(f);
    return is_below(tolerances_.sliver_area_is_given ? 1.0 : share * share,
                    tolerances_.sliver_thickness_is_given ? 1.0 : share);
  }

 private:
  const CutTolerances& tolerances_;
  LocalSize local_;
};

}  // namespace keyblock::cutting
