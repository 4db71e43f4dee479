#include "cutting/local_size.h"

#include <algorithm>
#include <cmath>

namespace keyblock::cutting {

double LocalSize::share(std::size_t face) {
  /// CutTolerances::for_domain knows the length of joints, but no blocks, and takes 40 blocks of two sets at right angles.
  constexpr double most_blocks = 80.0;
  if (!(size_ > 0.0)) return 1.0;
  known_.resize(graph_.faces.size(), 0.0);
  if (known_[face] == 0.0) known_[face] = std::min(1.0, most_blocks * size_around(face) / size_);
  return known_[face];
}

double LocalSize::size_around(std::size_t face) const {
  constexpr std::size_t enough = 32;
  constexpr double much_larger = 1e4;  // by area
  constexpr double not_exceeded_by = 0.8;
  std::vector<std::size_t> around{face};
  for (std::size_t k = 0; k < around.size() && around.size() < enough; ++k) {
    const Face& from = graph_.faces[around[k]];
    if (k > 0 && from.area > much_larger * graph_.faces[face].area) continue;
    for (const auto& ring : from.rings) {
      for (const HalfEdge h : ring) {
        const int beyond = graph_.face_left_of(h ^ 1);
        if (beyond < 0 || around.size() == enough) continue;
        const auto other = static_cast<std::size_t>(beyond);
        if (std::find(around.begin(), around.end(), other) == around.end()) around.push_back(other);
      }
    }
  }
  std::vector<double> areas;
  for (const std::size_t f : around) areas.push_back(graph_.faces[f].area);
  const auto at = static_cast<std::size_t>(not_exceeded_by * static_cast<double>(areas.size()));
  std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(at), areas.end());
  return std::sqrt(areas[at]);
}

}  // namespace keyblock::cutting
