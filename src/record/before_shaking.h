#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "record/stage.h"

namespace keyblock::record {

/// Place of the last stage before the first shaking of the opening. What has come down by its end, gravity brought down
/// before anything shook; what comes down later, the shaking adds.
///
/// The first shaking of the opening is the first stage of kind "shake" that is not before the first excavation; without
/// excavations, the first of all. None where there is no such stage, or none before it.
std::optional<std::size_t> last_before_shaking(std::span<const Stage> stages);

}  // namespace keyblock::record
