#pragma once
#include <vector>

#include "core/checked_json.h"
#include "loading/motion_file.h"

namespace keyblock::app {

/// A list with what `keyblock motion` tells of each component. Its names are in docs/guide/loads.md.
nlohmann::ordered_json components_json(const std::vector<loading::MotionComponent>& components);

}  // namespace keyblock::app
