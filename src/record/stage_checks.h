#pragma once
#include <cstddef>

#include "record/record.h"

namespace keyblock::record {

/// Whether a record that was read from a file names only blocks of a model of so many, and words that there are.
[[nodiscard]] bool has_known_blocks(const StageRecord& stage, std::size_t blocks);

}  // namespace keyblock::record
