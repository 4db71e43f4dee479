#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "simulation/element_record.h"

/// Springs and supports in files.
namespace keyblock::results {

/// `origin` is added to places. What is infinite or has no limit is null.
nlohmann::ordered_json elements_json(const std::vector<simulation::ElementRecord>& elements, Vec2 origin);
/// Throws nlohmann::json::exception for what is missing or has another type.
std::vector<simulation::ElementRecord> read_elements(const nlohmann::ordered_json& json);
/// elements.csv; empty where there are none.
std::string element_table(const std::vector<simulation::ElementRecord>& elements, Vec2 origin);

}  // namespace keyblock::results
