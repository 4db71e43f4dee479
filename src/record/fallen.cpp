#include "record/fallen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace keyblock::record {
namespace {

struct NamedPart {
  WallPart part;
  const char* name;
  double Damage::*depth;
};
constexpr NamedPart wall_parts[] = {{WallPart::crown, "crown", &Damage::fallen_depth_crown},
                                    {WallPart::left, "left", &Damage::fallen_depth_left},
                                    {WallPart::right, "right", &Damage::fallen_depth_right},
                                    {WallPart::invert, "invert", &Damage::fallen_depth_invert}};

}  // namespace

const char* wall_part_name(WallPart part) {
  const auto found = std::find_if(std::begin(wall_parts), std::end(wall_parts),
                                  [&](const NamedPart& p) { return p.part == part; });
  return found == std::end(wall_parts) ? nullptr : found->name;
}

WallPart wall_part_of(std::string_view name) {
  const auto found = std::find_if(std::begin(wall_parts), std::end(wall_parts),
                                  [&](const NamedPart& p) { return p.name == name; });
  return found == std::end(wall_parts) ? WallPart::none : found->part;
}

void set_extremes(std::span<const FallenBlock> fallen, Damage& damage) {
  const FallenBlock none;
  const FallenBlock* largest = &none;
  for (const FallenBlock& block : fallen) {
    if (block.area > largest->area) largest = &block;
  }
  damage.largest_fallen_area = largest->area;
  damage.largest_fallen_weight = largest->weight;
  if (std::isnan(damage.fallen_depth)) return;
  damage.fallen_depth = 0.0;
  for (const NamedPart& p : wall_parts) {
    double& depth = damage.*p.depth;
    depth = 0.0;
    for (const FallenBlock& block : fallen)
      if (block.part == p.part) depth = std::max(depth, block.depth);
    damage.fallen_depth = std::max(damage.fallen_depth, depth);
  }
}

double width_along_wall(const Polygon& block, WallPart part, Vec2 down) {
  const bool upright = part == WallPart::left || part == WallPart::right;
  const Vec2 along = upright ? down : Vec2{-down.y, down.x};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Vec2 corner : block.outer) {
    least = std::min(least, dot(along, corner));
    most = std::max(most, dot(along, corner));
  }
  return most - least;
}

std::string pressure_search(std::string_view scenario, std::span<const std::string> openings,
                            const Damage& damage) {
  if (openings.empty() || !(damage.largest_block_pressure > 0.0)) return {};
  const auto is_bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  const std::string& name = openings.front();
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), is_bare);
  const std::string key =
      bare ? fmt::format("excavation.{}.pressure", name) : fmt::format("\"excavation.'{}'.pressure\"", name);
  return fmt::format("keyblock limit {} --key {} --from {:.0e} --to 0 -o pressure", scenario, key,
                     10.0 * damage.largest_block_pressure);
}

}  // namespace keyblock::record
