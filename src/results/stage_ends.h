#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "results/run_data.h"

namespace keyblock::results {

/// The last frame of a stage, and the file of an export that it goes into: `stage_2_first-quake.geojson`.
struct StageEnd {
  std::string file;
  const record::Frame* frame = nullptr;
};

/// Of all stages that have one, in their order; `extension` with its point.
std::vector<StageEnd> stage_ends(const RunData& data, std::string_view extension);

}  // namespace keyblock::results
