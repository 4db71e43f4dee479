#pragma once
#include <hdf5.h>

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "record/record.h"

/// Strengths of joints, by set and map and by trace, in files.
namespace keyblock::results {

/// The group `joints`; nothing where a model has neither sets nor maps.
void write_joints(hid_t file, const record::ModelRecord& model);
/// Files of earlier versions have none. Throws RunError.
void read_joints(hid_t file, record::ModelRecord& model);

/// Strengths that were drawn (record/strengths_json.h). Throws nlohmann::json::exception for what is missing or has another type.
std::vector<record::DrawnStrength> read_strengths(const nlohmann::ordered_json& json);

/// joints.csv; empty where there are none.
std::string joint_table(const record::ModelRecord& model);

}  // namespace keyblock::results
