#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "record/stage_fields.h"

/// Stages as JSON, by the table of their fields.
namespace keyblock::results {

/// All fields that a file has.
nlohmann::ordered_json stage_fields_json(const record::StageRecord& stage, record::RecordFile file);
/// Of a line of `stages` in result.h5, of any version.
void read_stage_fields(const nlohmann::ordered_json& json, record::StageRecord& stage);
/// Adds what a static stage came to, in words, and what each moving block does, to the fields `equilibrium`.
void add_verdict(const record::StageRecord& stage, nlohmann::ordered_json& equilibrium);

/// Names as in the scenario: "settle", "shake", "rest".
std::string stage_kind_name(record::StageKind kind);

}  // namespace keyblock::results
