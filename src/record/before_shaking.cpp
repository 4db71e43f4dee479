#include "record/before_shaking.h"

#include <algorithm>

namespace keyblock::record {

std::optional<std::size_t> last_before_shaking(std::span<const Stage> stages) {
  const auto excavated =
      std::find_if(stages.begin(), stages.end(), [](const Stage& s) { return !s.excavate.empty(); });
  const auto first = excavated == stages.end() ? stages.begin() : excavated;
  const auto shaking =
      std::find_if(first, stages.end(), [](const Stage& s) { return s.kind == StageKind::shake; });
  if (shaking == stages.end() || shaking == stages.begin()) return std::nullopt;
  return static_cast<std::size_t>(shaking - stages.begin()) - 1;
}

}  // namespace keyblock::record
