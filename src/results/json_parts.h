#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec2.h"
#include "record/record.h"
#include "record/record_file.h"

/// Parts of records that several files write as JSON alike. Reading throws nlohmann::json::exception for what is missing
/// or has another type.
namespace keyblock::results {

nlohmann::ordered_json damage_json(const record::Damage& damage);
/// The columns of damage in the report of a run: interface DamageMeasure in viewer/src/data.ts.
nlohmann::ordered_json damage_measures_json();
nlohmann::ordered_json fallen_json(const std::vector<record::FallenBlock>& fallen);
/// What the stage waits for; null where it is nothing.
nlohmann::ordered_json wait_json(const std::optional<record::StageWait>& wait);
/// Heights and places less none; `origin` is added to them.
nlohmann::ordered_json planes_json(const std::vector<record::PlaneRecord>& planes, Vec2 origin);
std::vector<record::PlaneRecord> read_planes(const nlohmann::ordered_json& json);
nlohmann::ordered_json standing_json(const std::optional<record::Standing>& standing);
nlohmann::ordered_json movers_json(const record::Movers& movers);
nlohmann::ordered_json energy_json(const record::Energy& energy);
nlohmann::ordered_json moving_json(const std::vector<record::MovingBlock>& moving);
/// With what each block does (record/verdict.h).
nlohmann::ordered_json movements_json(const record::StageRecord& stage);
/// With the names of excavations; where none are given, with their numbers.
nlohmann::ordered_json release_json(const std::vector<record::ReleasePoint>& points,
                                    const std::vector<std::string>& excavations);
nlohmann::ordered_json open_close_json(const record::OpenCloseStatistics& statistics);
/// Names and values of ModelRecord::ground.
nlohmann::ordered_json ground_json(const std::vector<std::pair<std::string, std::string>>& ground);
/// Which blocks, where, and when; null where none overlap.
nlohmann::ordered_json overlap_place_json(const record::OverlapRecord& overlap, Vec2 origin);
/// Fields of a run as far as a file has them (record/run_fields.h).
nlohmann::ordered_json run_fields_json(const record::RunRecord& run, record::RecordFile file);
nlohmann::ordered_json points_json(const std::vector<Vec2>& points);  ///< [[x, y], …]

record::Damage read_damage(const nlohmann::ordered_json& json);
std::vector<record::FallenBlock> read_fallen(const nlohmann::ordered_json& json);
std::optional<record::StageWait> read_wait(const nlohmann::ordered_json& json);
std::optional<record::Standing> read_standing(const nlohmann::ordered_json& json);
record::Movers read_movers(const nlohmann::ordered_json& json);
record::Energy read_energy(const nlohmann::ordered_json& json);
std::vector<record::MovingBlock> read_moving(const nlohmann::ordered_json& json);
/// Of excavations by number.
std::vector<record::ReleasePoint> read_release(const nlohmann::ordered_json& json);
record::OpenCloseStatistics read_open_close(const nlohmann::ordered_json& json);
/// Into an overlap, except for its depth; the origin of its coordinates stays in them.
nlohmann::ordered_json contact_checks_json(const record::ContactChecks& vertices, Vec2 origin);
record::ContactChecks read_contact_checks(const nlohmann::ordered_json& json);
void read_overlap_place(const nlohmann::ordered_json& json, record::OverlapRecord& overlap);
std::vector<std::pair<std::string, std::string>> read_ground(const nlohmann::ordered_json& json);
std::vector<Vec2> read_points(const nlohmann::ordered_json& json);

/// The value of a field by its name, or by an earlier one, if it had one; null: there is neither.
const nlohmann::ordered_json* find_field(const nlohmann::ordered_json& json, const char* name,
                                         const char* earlier);

/// JSON has no NaN: it is written as null.
double number(const nlohmann::ordered_json& value);

nlohmann::ordered_json or_null(const std::optional<double>& value);
nlohmann::ordered_json or_null(const std::optional<int>& value);
/// null: it is infinite, or no number.
nlohmann::ordered_json number_or_null(double value);

}  // namespace keyblock::results
