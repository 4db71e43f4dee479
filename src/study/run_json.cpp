#include "study/run_json.h"

#include "core/checked_json.h"
#include "core/error.h"
#include "record/fallen.h"
#include "results/json_parts.h"
#include "results/stage_json.h"
#include "study/measures.h"
#include "study/plan.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

using nlohmann::ordered_json;
using record::BlockStatus;
using record::StageKind;
using results::number;

constexpr int run_format = 6;
constexpr std::uint64_t largest_map = 4'000'000;  // cells
const std::string expected_words = "the measures of a run as keyblock wrote them";
const std::string checksum_mark = ",\"checksum\":\"";

ordered_json stage_json(const StageMeasures& stage) {
  ordered_json json{{"name", stage.name}, {"kind", results::stage_kind_name(stage.kind)}};
  for (const Intensity& intensity : intensities()) json[intensity.name] = stage.*intensity.of;
  json["damage"] = results::damage_json(stage.damage);
  json["standing"] = results::standing_json(stage.standing);
  json["movers"] = results::movers_json(stage.movers);
  json["heaviest_name"] = stage.heaviest;
  json["record"] = stage.record;
  return json;
}

StageMeasures read_stage(const ordered_json& json) {
  StageMeasures stage;
  json.at("name").get_to(stage.name);
  for (const StageKind kind : {StageKind::settle, StageKind::shake, StageKind::rest}) {
    if (json.at("kind") == results::stage_kind_name(kind)) stage.kind = kind;
  }
  for (const Intensity& intensity : intensities()) stage.*intensity.of = number(json.at(intensity.name));
  stage.damage = results::read_damage(json.at("damage"));
  stage.standing = results::read_standing(json.at("standing")).value_or(record::Standing::unsettled);
  stage.movers = results::read_movers(json.at("movers"));
  json.at("heaviest_name").get_to(stage.heaviest);
  json.at("record").get_to(stage.record);
  return stage;
}

ordered_json map_json(const std::vector<BlockStatus>& map) {
  ordered_json runs = ordered_json::array();
  for (std::size_t k = 0; k < map.size();) {
    std::size_t end = k;
    while (end < map.size() && map[end] == map[k]) ++end;
    runs.push_back(static_cast<int>(map[k]));
    runs.push_back(end - k);
    k = end;
  }
  return runs;
}

std::vector<BlockStatus> read_map(const ordered_json& runs) {
  std::vector<BlockStatus> map;
  for (std::size_t k = 0; k + 1 < runs.size(); k += 2) {
    const auto status = runs[k].get<std::int64_t>();
    const auto count = runs[k + 1].get<std::uint64_t>();
    if (status < 0 || status > static_cast<int>(BlockStatus::excavated) || count > largest_map - map.size())
      refuse("", "a map of unknown states, or of too many cells", expected_words);
    map.insert(map.end(), count, static_cast<BlockStatus>(status));
  }
  return map;
}

RunResult read_result(const ordered_json& json) {
  RunResult run;
  json.at("key").get_to(run.key);
  json.at("realization").get_to(run.realization);
  json.at("values").get_to(run.values);
  json.at("variant").get_to(run.variant);
  json.at("error").get_to(run.error);
  json.at("blocks").get_to(run.blocks);
  run.block_size = number(json.at("block_size_m"));
  json.at("steps").get_to(run.steps);
  run.wall_time = number(json.at("wall_time_s"));
  json.at("state_hash").get_to(run.state_hash);
  json.at("unconverged_steps").get_to(run.unconverged_steps);
  run.max_overlap = number(json.at("max_overlap_m"));
  run.energy_residual_ratio = number(json.at("energy_residual_ratio"));
  if (json.contains("strengths"))
    for (const auto& [name, value] : json.at("strengths").items())
      run.strengths.emplace_back(name, number(value));
  for (const auto& stage : json.at("stages")) run.stages.push_back(read_stage(stage));
  for (const auto& block : json.at("fallen")) {
    const auto& centroid = block.at("centroid");
    const auto& wall = block.at("wall");
    run.fallen.push_back({block.at("block").get<int>(),
                          block.at("name").get<std::string>(),
                          block.at("stage").get<int>(),
                          {number(centroid.at(0)), number(centroid.at(1))},
                          number(block.at("area_m2")),
                          number(block.at("weight_n_m")),
                          number(block.at("depth_m")),
                          record::wall_part_of(wall.is_null() ? "" : wall.get<std::string>())});
  }
  run.map = read_map(json.at("map"));
  return run;
}

}  // namespace

std::string run_json(const RunResult& run, const std::string& input) {
  ordered_json stages = ordered_json::array(), fallen = ordered_json::array();
  for (const StageMeasures& stage : run.stages) stages.push_back(stage_json(stage));
  for (const FallenBlock& block : run.fallen) {
    const char* wall = record::wall_part_name(block.part);
    fallen.push_back({{"block", block.block},
                      {"name", block.name},
                      {"stage", block.stage},
                      {"centroid", {block.centroid.x, block.centroid.y}},
                      {"area_m2", block.area},
                      {"weight_n_m", block.weight},
                      {"depth_m", block.depth},
                      {"wall", wall == nullptr ? ordered_json() : ordered_json(wall)}});
  }
  ordered_json strengths = ordered_json::object();
  for (const auto& [name, value] : run.strengths) strengths[name] = results::number_or_null(value);
  const ordered_json json{{"format", run_format},
                          {"input", input},
                          {"key", run.key},
                          {"realization", run.realization},
                          {"values", run.values},
                          {"variant", run.variant},
                          {"error", run.error},
                          {"blocks", run.blocks},
                          {"block_size_m", run.block_size},
                          {"steps", run.steps},
                          {"wall_time_s", run.wall_time},
                          {"state_hash", run.state_hash},
                          {"unconverged_steps", run.unconverged_steps},
                          {"max_overlap_m", run.max_overlap},
                          {"energy_residual_ratio", run.energy_residual_ratio},
                          {"strengths", strengths},
                          {"stages", stages},
                          {"fallen", fallen},
                          {"map", map_json(run.map)}};
  std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  text.pop_back();
  return text + checksum_mark + hash_text(text) + "\"}\n";
}

RunResult read_run_json(const std::string& text, const std::string& input) {
  const std::size_t mark = text.rfind(checksum_mark);
  if (mark == std::string::npos) refuse("", "a truncated file", expected_words);
  const std::string sum = text.substr(mark + checksum_mark.size());
  if (sum != hash_text(std::string_view(text).substr(0, mark)) + "\"}\n")
    refuse("", "a file that was truncated or changed", expected_words);
  try {
    const ordered_json json = ordered_json::parse(text);
    if (json.at("format") != run_format) refuse("", "another format", "format " + std::to_string(run_format));
    if (json.at("input") != input) refuse("", "the run of another study or version", "one of this study");
    return read_result(json);
  } catch (const nlohmann::json::exception& error) {
    refuse("", error.what(), expected_words);
  }
}

}  // namespace keyblock::study
