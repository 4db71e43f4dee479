#include "study/plan_json.h"

#include <fmt/format.h>

#include <utility>

#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "core/folder.h"
#include "study/folder.h"
#include "study/plan_checks.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using scenario::Keep;

constexpr int plan_format = 1;
const std::string repair = "remove it and run the study again in this folder: what is done is not done again";
constexpr std::pair<Keep, const char*> keeps[] = {
    {Keep::all, "all"}, {Keep::report, "report"}, {Keep::measures, "measures"}};

ordered_json until_json(const scenario::UntilSpec& until) {
  ordered_json json{{"measure", until.measure}, {"minimum", until.minimum}, {"maximum", until.maximum}};
  if (until.half_width) json["half_width"] = *until.half_width;
  if (until.width) json["width"] = *until.width;
  return json;
}

scenario::UntilSpec read_until(const ordered_json& json) {
  scenario::UntilSpec until;
  json.at("measure").get_to(until.measure);
  json.at("minimum").get_to(until.minimum);
  json.at("maximum").get_to(until.maximum);
  if (json.contains("half_width")) until.half_width = json.at("half_width").get<double>();
  if (json.contains("width")) until.width = json.at("width").get<double>();
  return until;
}

ordered_json runs_json(const std::vector<PlannedRun>& runs) {
  ordered_json list = ordered_json::array();
  for (const PlannedRun& run : runs) {
    ordered_json row{{"key", run.key}, {"realization", run.realization}, {"values", run.values}};
    if (!run.variant.empty()) row["variant"] = run.variant;
    if (!run.control.empty()) row["control"] = run.control;
    if (!run.wanted) row["wanted"] = false;
    list.push_back(std::move(row));
  }
  return list;
}

void read_runs(const ordered_json& list, std::vector<PlannedRun>& runs) {
  runs.reserve(list.size());
  for (const auto& row : list) {
    PlannedRun& run = runs.emplace_back();
    row.at("key").get_to(run.key);
    row.at("realization").get_to(run.realization);
    row.at("values").get_to(run.values);
    if (row.contains("variant")) row.at("variant").get_to(run.variant);
    if (row.contains("control")) row.at("control").get_to(run.control);
    run.wanted = !row.contains("wanted");
  }
}

ordered_json description_json(const Plan& plan) {
  ordered_json axes = ordered_json::array(), levels = ordered_json::array(), outlines = ordered_json::array();
  for (const auto& axis : plan.axes) axes.push_back({{"keys", axis.keys}, {"values", axis.values}});
  for (const auto& level : plan.levels)
    levels.push_back({{"name", level.name}, {"measure", level.measure}, {"threshold", level.threshold}});
  for (const Ring& outline : plan.outlines) {
    ordered_json points = ordered_json::array();
    for (const Vec2 p : outline) points.push_back({p.x, p.y});
    outlines.push_back(std::move(points));
  }
  ordered_json json{
      {"title", plan.title}, {"seed", plan.seed}, {"realizations", plan.realizations}, {"axes", axes},
      {"stage", plan.stage}, {"levels", levels},  {"confidence", plan.confidence}};
  if (!plan.since.empty()) json["since"] = plan.since;
  if (!plan.before_shaking.empty()) json["before_shaking"] = plan.before_shaking;
  if (plan.strata > 0) json["strata"] = plan.strata;
  if (plan.control) json["control"] = true;
  if (plan.until) json["until"] = until_json(*plan.until);
  if (plan.marginal)
    json["marginal"] = {{"friction", plan.marginal->friction}, {"share", plan.marginal->share}};
  for (const auto& [keep, word] : keeps) {
    if (keep == plan.keep) json["keep"] = word;
  }
  json["map"] = {{"corner", {plan.grid.corner.x, plan.grid.corner.y}},
                 {"cell", plan.grid.cell},
                 {"columns", plan.grid.columns},
                 {"rows", plan.grid.rows}};
  json["outlines"] = outlines;
  ordered_json ground = ordered_json::array();
  for (const auto& fact : plan.ground) ground.push_back({fact.name, fact.value});
  json["ground"] = std::move(ground);
  return json;
}

void read_description(const ordered_json& json, Plan& plan) {
  json.at("title").get_to(plan.title);
  json.at("seed").get_to(plan.seed);
  json.at("realizations").get_to(plan.realizations);
  for (const auto& axis : json.at("axes")) {
    scenario::VarySpec& spec = plan.axes.emplace_back();
    axis.at("keys").get_to(spec.keys);
    axis.at("values").get_to(spec.values);
  }
  json.at("stage").get_to(plan.stage);
  if (json.contains("since")) json.at("since").get_to(plan.since);
  if (json.contains("before_shaking")) json.at("before_shaking").get_to(plan.before_shaking);
  for (const auto& level : json.at("levels")) {
    plan.levels.push_back({level.at("name").get<std::string>(), level.at("measure").get<std::string>(),
                           level.at("threshold").get<double>()});
  }
  json.at("confidence").get_to(plan.confidence);
  if (json.contains("strata")) json.at("strata").get_to(plan.strata);
  if (json.contains("control")) json.at("control").get_to(plan.control);
  if (json.contains("until")) plan.until = read_until(json.at("until"));
  if (json.contains("marginal")) {
    plan.marginal = MarginalCheck{json.at("marginal").at("friction").get<double>(),
                                  json.at("marginal").at("share").get<double>()};
  }
  for (const auto& [keep, word] : keeps) {
    if (json.at("keep") == word) plan.keep = keep;
  }
  const auto& map = json.at("map");
  plan.grid = {{map.at("corner").at(0).get<double>(), map.at("corner").at(1).get<double>()},
               map.at("cell").get<double>(),
               map.at("columns").get<int>(),
               map.at("rows").get<int>()};
  for (const auto& points : json.at("outlines")) {
    Ring& outline = plan.outlines.emplace_back();
    for (const auto& p : points) outline.push_back({p.at(0).get<double>(), p.at(1).get<double>()});
  }
  if (!json.contains("ground")) return;
  for (const auto& fact : json.at("ground"))
    plan.ground.push_back({fact.at(0).get<std::string>(), fact.at(1).get<std::string>()});
}

// What is run must be what the results go by.
void check_copy(const fs::path& directory, const Plan& plan) {
  const fs::path file = scenario_path(directory);
  if (scenario_identity(plan.text, file, plan.overrides) == plan.input) return;
  refuse(file.string(), "a scenario other than that of plan.json",
         "the scenario as it was when the study was planned",
         "put it back, or plan the changed one in another folder");
}

}  // namespace

std::string plan_json(const Plan& plan, const fs::path& directory) {
  ordered_json files = ordered_json::array();
  for (const InputFile& file : plan.files) files.push_back({{"name", file.name}, {"hash", file.hash}});
  const fs::path scenario = fs::absolute(plan.scenario).lexically_normal();
  ordered_json json{
      {"format", plan_format},
      {"version", plan.version},
      {"scenario", scenario.lexically_relative(fs::absolute(directory).lexically_normal()).string()},
      {"scenario_path", scenario.string()},
      {"overrides", plan.overrides},
      {"input", plan.input},
      {"files", files}};
  json.update(description_json(plan));
  // A line for each member, and one for each run: its place is its index.
  const auto dump = [](const ordered_json& value) {
    return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  };
  std::string text = "{\n";
  for (const auto& [key, value] : json.items()) text += dump(key) + ": " + dump(value) + ",\n";
  text += "\"runs\": [";
  const ordered_json runs = runs_json(plan.runs);
  for (std::size_t k = 0; k < runs.size(); ++k) text += (k == 0 ? "\n" : ",\n") + dump(runs[k]);
  return text + "\n]}\n";
}

Plan read_plan(const fs::path& directory) {
  const fs::path path = plan_path(directory);
  if (!file_exists(path)) {
    refuse(directory.string(), "no plan.json", "the folder of a study, as keyblock study run makes it");
  }
  Plan plan;
  try {
    const ordered_json json = ordered_json::parse(read_own_file(path));
    if (json.at("format") != plan_format)
      refuse(path.string(), "another format", fmt::format("format {} of the plan of a study", plan_format));
    json.at("version").get_to(plan.version);
    // Both may have been moved together, or the folder alone.
    plan.scenario = (directory / json.at("scenario").get<std::string>()).lexically_normal();
    if (!file_exists(plan.scenario)) plan.scenario = json.at("scenario_path").get<std::string>();
    json.at("overrides").get_to(plan.overrides);
    json.at("input").get_to(plan.input);
    for (const auto& file : json.at("files")) {
      plan.files.push_back({file.at("name").get<std::string>(), file.at("hash").get<std::string>()});
    }
    read_description(json, plan);
    read_runs(json.at("runs"), plan.runs);
  } catch (const nlohmann::json::exception&) {
    refuse(path.string(), "a damaged file", "the plan of a study", repair);
  }
  if (const std::string found = mistake_in(plan); !found.empty())
    refuse(path.string(), found, "the plan of a study as keyblock wrote it", repair);
  plan.text = read_own_file(scenario_path(directory));
  check_copy(directory, plan);
  return plan;
}

}  // namespace keyblock::study
