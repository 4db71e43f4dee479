#include "record/stage_checks.h"

#include <algorithm>

namespace keyblock::record {

bool has_known_blocks(const StageRecord& stage, std::size_t blocks) {
  const auto is_block = [&](int block) { return block >= 0 && static_cast<std::size_t>(block) < blocks; };
  const auto is_known = [&](const auto& of) { return is_block(of.block); };
  return std::ranges::all_of(stage.moving, is_known) &&
         (stage.unstable_block == -1 || is_block(stage.unstable_block)) &&
         (stage.movers.heaviest == -1 || is_block(stage.movers.heaviest)) &&
         std::ranges::all_of(
             stage.fallen, [&](const FallenBlock& f) { return is_known(f) && f.part <= WallPart::invert; }) &&
         (!stage.standing || *stage.standing <= Standing::unstable);
}

}  // namespace keyblock::record
