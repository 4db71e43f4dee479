#pragma once
#include <span>
#include <string_view>

#include "simulation/record.h"

namespace keyblock::simulation {

/// The name of a part in files; null for `none`.
const char* wall_part_name(WallPart part);
/// The part of a name; `none` for any other.
WallPart wall_part_of(std::string_view name);

/// Sets what `damage` says of the largest of these blocks and of the depths from which they came. Depths that are not numbers there, as
/// there is no opening, stay so.
void set_extremes(std::span<const FallenBlock> fallen, Damage& damage);

}  // namespace keyblock::simulation
