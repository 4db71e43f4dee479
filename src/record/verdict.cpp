#include "record/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

namespace keyblock::record {

namespace {

constexpr double carried_whole = 0.9, carried_none = 0.1;  // shares of the weight
constexpr double far_share = 0.02;  // of the block size: a way out of balance that the verdict tells of

std::string blocks_text(int count) {
  return fmt::format("{} {}", count, count == 1 ? "block" : "blocks");
}

}  // namespace

Verdict verdict_of(const StageRecord& stage) {
  if (!stage.moving.empty()) return Verdict::moving;
  if (!stage.equilibrium_reached) return Verdict::not_reached;
  if (stage.unstable_block >= 0) return Verdict::unstable;
  return stage.way_share > far_share ? Verdict::equilibrium_after_moving : Verdict::equilibrium;
}

Movement movement_of(const StageRecord& stage, std::size_t k) {
  const MovingBlock& block = stage.moving[k];
  if (is_falling(block.carried)) return Movement::falling;
  const bool carries_all = std::ranges::all_of(stage.moving, [&](const MovingBlock& other) {
    return other.group != block.group || other.carried >= carried_whole;
  });
  return carries_all ? Movement::mechanism : Movement::partly_held;
}

bool is_falling(double carried) {
  return carried < carried_none;
}

std::string movement_name(Movement movement) {
  switch (movement) {
    case Movement::mechanism:
      return "mechanism";
    case Movement::falling:
      return "falling";
    case Movement::partly_held:
      return "partly held";
  }
  return {};
}

std::string verdict_text(const StageRecord& stage) {
  switch (verdict_of(stage)) {
    case Verdict::equilibrium:
      return "in equilibrium";
    case Verdict::unstable:
      return fmt::format("in equilibrium that is not stable: block {} gives way", stage.unstable_block);
    case Verdict::equilibrium_after_moving:
      return fmt::format("in equilibrium after moving {:.2g} m", stage.way);
    case Verdict::not_reached:
      return "not reached";
    case Verdict::moving:
      break;
  }
  std::map<int, int> mechanisms;  // blocks of each group
  int falling = 0, partly_held = 0;
  for (std::size_t k = 0; k < stage.moving.size(); ++k) {
    const Movement movement = movement_of(stage, k);
    if (movement == Movement::mechanism) ++mechanisms[stage.moving[k].group];
    falling += movement == Movement::falling;
    partly_held += movement == Movement::partly_held;
  }
  std::vector<std::string> parts;
  for (const auto& [group, count] : mechanisms) parts.push_back("mechanism of " + blocks_text(count));
  if (mechanisms.size() > 2) {
    int count = 0;
    for (const auto& [group, of_group] : mechanisms) count += of_group;
    parts = {fmt::format("{} mechanisms of {}", mechanisms.size(), blocks_text(count))};
  }
  if (partly_held > 0) parts.push_back(blocks_text(partly_held) + " moving");
  if (falling > 0) parts.push_back(blocks_text(falling) + " falling");
  if (!stage.equilibrium_reached) parts.emplace_back("equilibrium of the others not reached");
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace keyblock::record
