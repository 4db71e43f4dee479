#pragma once
#include <span>
#include <string>
#include <string_view>

#include "record/record.h"

namespace keyblock::record {

/// The name of a part in files; null for `none`.
const char* wall_part_name(WallPart part);
/// The part of a name; `none` for any other.
WallPart wall_part_of(std::string_view name);

/// Sets what `damage` says of the largest of these blocks and of the depths from which they came. Depths that are not numbers there, as
/// there is no opening, stay so.
void set_extremes(std::span<const FallenBlock> fallen, Damage& damage);

/// m, how wide a block is along the wall that it was behind: horizontally behind crown and invert, along gravity behind the others. down: unit
/// vector.
double width_along_wall(const Polygon& block, WallPart part, Vec2 down);

/// The command that finds the support pressure of an opening which holds its rock, from ten times a pressure, Pa, down to none. scenario: its
/// file. Empty without an opening, or where nothing has fallen.
std::string pressure_search(std::string_view scenario, std::span<const std::string> openings,
                            const Damage& damage);

}  // namespace keyblock::record
