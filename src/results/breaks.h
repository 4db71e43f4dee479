#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "results/run_data.h"

/// What broke in a run (record/break_records.h), as files other than result.h5 have it.
namespace keyblock::results {

/// What broke, for each joint set, trace map or element and mode. Names: of this model, if given.
nlohmann::ordered_json breaks_json(const std::vector<record::BreakCount>& counts,
                                   const record::ModelRecord* model = nullptr);
std::vector<record::BreakCount> read_breaks(const nlohmann::ordered_json& json);

/// All events, CSV; empty where nothing broke.
std::string break_table(const RunData& data);
/// A point for each event, VTK.
std::string vtk_breaks(const RunData& data);

}  // namespace keyblock::results
