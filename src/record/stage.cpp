#include "record/stage.h"

#include <algorithm>

namespace keyblock::record {

bool wears_joints(std::span<const Stage> stages, std::size_t k) {
  if (stages[k].wears_joints) return *stages[k].wears_joints;
  const auto turns_gravity_on = [](const Stage& stage) {
    return stage.kind == StageKind::settle && stage.excavate.empty() && stage.release.empty() &&
           stage.install.empty() && stage.k_h == 0.0 && stage.k_v == 0.0 && stage.strength_factor == 1.0;
  };
  return k + 1 == stages.size() || !std::ranges::all_of(stages.first(k + 1), turns_gravity_on);
}

}  // namespace keyblock::record
