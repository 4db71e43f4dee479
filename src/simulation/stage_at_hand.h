#pragma once
#include <optional>

#include "record/record.h"
#include "simulation/settle.h"
#include "simulation/stage_motion.h"
#include "simulation/stillness.h"

namespace keyblock::simulation {

/// A stage that has begun and has not ended.
struct StageAtHand {
  record::StageRecord record;
  long most_steps = 0;
  bool is_in_equilibrium = false;      ///< static: there is nothing more to do
  std::optional<Settler> settler;      ///< of a static stage
  std::optional<StageMotion> motion;   ///< of one that shakes
  std::optional<Stillness> stillness;  ///< of one that ends when all is still
  bool is_still = false;
};

}  // namespace keyblock::simulation
