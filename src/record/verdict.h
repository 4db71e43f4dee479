#pragma once
#include <string>

#include "record/record.h"

namespace keyblock::record {

/// What a static stage came to.
enum class Verdict {
  equilibrium,               ///< every block balances
  unstable,                  ///< every block balances, and the least push brings it down
  equilibrium_after_moving,  ///< the same, and on the way a block went farther than 0.02 ℓ out of balance
  moving,  ///< the other blocks balance, or the stage ended before they did (`not_reached` is for stages without any)
  not_reached
};

/// What a moving block does.
enum class Movement {
  mechanism,  ///< its group carries its weight, each block nine tenths of it at least: it slides, tips or turns about hinges
  falling,    ///< less than a tenth of its weight is carried
  partly_held  ///< its group carries less than its weight
};
/// carried: share of the weight.
[[nodiscard]] bool is_falling(double carried);

[[nodiscard]] Verdict verdict_of(const StageRecord& stage);
/// Of moving block k of the stage.
[[nodiscard]] Movement movement_of(const StageRecord& stage, std::size_t k);
[[nodiscard]] std::string movement_name(Movement movement);
/// "in equilibrium", "in equilibrium after moving 0.031 m", "mechanism of 22 blocks, 1 block falling", "not reached".
[[nodiscard]] std::string verdict_text(const StageRecord& stage);

}  // namespace keyblock::record
