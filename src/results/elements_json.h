#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "results/run_data.h"

/// Elements, such as springs and supports, in files.
namespace keyblock::results {

/// For the page: names, kinds and limits of the elements, null: none; histories that follow one.
nlohmann::ordered_json element_names_json(const record::ModelRecord& model);
nlohmann::ordered_json element_histories_json(const record::ModelRecord& model);
/// Names of the elements of a model and of the histories that follow one, into and out of a JSON object.
void add_element_names(const record::ModelRecord& model, nlohmann::ordered_json& json);
/// Files of earlier versions have none. Throws nlohmann::json::exception for what is missing or has another type, RunError for elements that
/// are not there.
void read_element_names(const nlohmann::ordered_json& json, record::ModelRecord& model);

/// `origin` is added to places. What is infinite or has no limit is null.
nlohmann::ordered_json elements_json(const std::vector<record::ElementRecord>& elements, Vec2 origin);
/// Throws nlohmann::json::exception for what is missing or has another type.
std::vector<record::ElementRecord> read_elements(const nlohmann::ordered_json& json);
/// What water does to blocks.
nlohmann::ordered_json water_json(const record::WaterRecord& water);
/// Throws likewise.
record::WaterRecord read_water(const nlohmann::ordered_json& json);
/// elements.csv; empty where there are none.
std::string element_table(const std::vector<record::ElementRecord>& elements, Vec2 origin);
/// element_frames.csv, a row for each frame and element; likewise.
std::string element_state_table(const RunData& run);

}  // namespace keyblock::results
