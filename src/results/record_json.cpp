#include "results/record_json.h"

#include <optional>
#include <utility>

#include "core/checked_json.h"
#include "core/error.h"
#include "results/elements_json.h"
#include "results/json_parts.h"

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;
using simulation::StageKind;

constexpr std::pair<StageKind, const char*> kinds[] = {
    {StageKind::settle, "settle"}, {StageKind::shake, "shake"}, {StageKind::rest, "rest"}};

std::optional<double> optional_number(const ordered_json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

// Of a field that files of version 0.1 do not have.
std::optional<double> later_number(const ordered_json& json, const char* name) {
  return json.contains(name) ? optional_number(json.at(name)) : std::nullopt;
}

// Field names beside members, for writing and reading alike.
template <class Record, class Visit>
void visit_cutting(Record& c, const Visit& visit) {
  visit("traces", c.traces);
  visit("joints_used", c.joints_used);
  visit("trace_length", c.trace_length);
  visit("removed_length", c.removed_length);
  visit("removed_pieces", c.removed_pieces);
  visit("merged_slivers", c.merged_slivers);
  visit("merged_vertices", c.merged_vertices);
  visit("domain_area", c.domain_area);
  visit("sliver_area", c.sliver_area);
}

// Those that files of earlier versions do not have.
template <class Record, class Visit>
void visit_later_cutting(Record& c, const Visit& visit) {
  visit("merged_across_joints", c.merged_across_joints);
  visit("highest_tooth", c.highest_tooth);
  visit("slivers_left", c.slivers_left);
}

// Calls visit_… with a function that writes into, or reads from, `json`.
struct Write {
  ordered_json& json;
  template <class T>
  void operator()(const char* name, const T& value) const {
    json[name] = value;
  }
};
struct Read {
  const ordered_json& json;
  void operator()(const char* name, double& value) const { value = number(json.at(name)); }
  void operator()(const char* name, int& value) const { value = json.at(name).get<int>(); }
};

template <class Parse>
auto parsed(const std::string& text, const Parse& parse) {
  try {
    return parse(ordered_json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    Diagnostic diagnostic;
    diagnostic.found = error.what();
    diagnostic.expected = "a record as keyblock writes it";
    throw InputError(std::move(diagnostic));
  }
}

}  // namespace

std::string stage_kind_name(StageKind kind) {
  for (const auto& [known, name] : kinds) {
    if (known == kind) return name;
  }
  return {};
}

std::string model_json(const simulation::ModelRecord& model) {
  ordered_json outlines = ordered_json::array(), cutting;
  for (const auto& outline : model.excavation_outlines) outlines.push_back(points_json(outline));
  visit_cutting(model.cutting, Write{cutting});
  visit_later_cutting(model.cutting, Write{cutting});
  ordered_json json{{"title", model.title},
                    {"version", model.version},
                    {"seed", model.seed},
                    {"realization", model.realization},
                    {"threads", model.threads},
                    {"step_size", model.step_size},
                    {"origin", {model.origin.x, model.origin.y}},
                    {"stage_names", model.stage_names},
                    {"joint_set_names", model.joint_set_names},
                    {"trace_map_names", model.trace_map_names},
                    {"excavation_names", model.excavation_names},
                    {"excavation_outlines", outlines},
                    {"history_names", model.history_names},
                    {"opening_width", or_null(model.opening_width)},
                    {"slip_limit", or_null(model.slip_limit)},
                    {"opening_limit", or_null(model.opening_limit)},
                    {"cutting", cutting},
                    {"warnings", model.warnings},
                    {"closure_is_lower_bound", model.closure_is_lower_bound},
                    {"ground", ground_json(model.ground)},
                    {"hooks", model.hooks}};
  add_element_names(model, json);
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void read_model_json(const std::string& text, simulation::ModelRecord& model) {
  parsed(text, [&](const ordered_json& json) {
    json.at("title").get_to(model.title);
    json.at("version").get_to(model.version);
    json.at("seed").get_to(model.seed);
    json.at("realization").get_to(model.realization);
    json.at("threads").get_to(model.threads);
    model.step_size = number(json.at("step_size"));
    model.origin = {number(json.at("origin").at(0)), number(json.at("origin").at(1))};
    if (json.contains("stage_names")) json.at("stage_names").get_to(model.stage_names);
    json.at("joint_set_names").get_to(model.joint_set_names);
    json.at("trace_map_names").get_to(model.trace_map_names);
    json.at("excavation_names").get_to(model.excavation_names);
    for (const auto& outline : json.at("excavation_outlines"))
      model.excavation_outlines.push_back(read_points(outline));
    json.at("history_names").get_to(model.history_names);
    read_element_names(json, model);
    model.opening_width = optional_number(json.at("opening_width"));
    model.slip_limit = later_number(json, "slip_limit");
    model.opening_limit = later_number(json, "opening_limit");
    const ordered_json& cutting = json.at("cutting");
    visit_cutting(model.cutting, Read{cutting});
    if (cutting.contains("slivers_left")) visit_later_cutting(model.cutting, Read{cutting});
    // Files of earlier versions have none of these.
    if (json.contains("warnings")) json.at("warnings").get_to(model.warnings);
    if (json.contains("closure_is_lower_bound"))
      json.at("closure_is_lower_bound").get_to(model.closure_is_lower_bound);
    if (json.contains("ground")) model.ground = read_ground(json.at("ground"));
    if (json.contains("hooks")) json.at("hooks").get_to(model.hooks);
    return 0;
  });
}

std::string stage_json(int index, const simulation::StageRecord& r, bool ended) {
  const ordered_json json{{"index", index},
                          {"ended", ended},
                          {"name", r.stage.name},
                          {"kind", stage_kind_name(r.stage.kind)},
                          {"excavate", r.stage.excavate},
                          {"install", r.stage.install},
                          {"motion_index", r.stage.motion},
                          {"scale", r.stage.scale},
                          {"k_h", r.stage.k_h},
                          {"k_v", r.stage.k_v},
                          {"given_duration", or_null(r.stage.duration)},
                          {"max_steps", or_null(r.stage.max_steps)},
                          {"tolerance", r.stage.tolerance},
                          {"steps", r.steps},
                          {"start_time", r.start_time},
                          {"duration", r.duration},
                          {"planned_duration", or_null(r.planned_duration)},
                          {"pga", r.pga},
                          {"pgv", r.pgv},
                          {"arias", r.arias},
                          {"equilibrium_reached", r.equilibrium_reached},
                          {"still", r.still},
                          {"waits_for", wait_json(r.waits_for)},
                          {"worst_residual_ratio", r.worst_residual_ratio},
                          {"way", r.way},
                          {"way_share", r.way_share},
                          {"moving", moving_json(r.moving)},
                          {"blocks_by_order", r.blocks_by_order},
                          {"release", release_json(r.release, {})},
                          {"damage", damage_json(r.damage)},
                          {"fallen", fallen_json(r.fallen)},
                          {"standing", standing_json(r.standing)},
                          {"movers", movers_json(r.movers)},
                          {"unstable_block", r.unstable_block},
                          {"largest_speed", r.largest_speed},
                          {"wall_time", r.wall_time},
                          {"interrupted", r.interrupted},
                          {"motion_time", r.motion_time},
                          {"motion", points_json(r.motion)}};
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// What the scenario says of a stage.
static simulation::Stage read_given_stage(const ordered_json& json) {
  simulation::Stage stage;
  json.at("name").get_to(stage.name);
  for (const auto& [kind, name] : kinds) {
    if (json.at("kind") == name) stage.kind = kind;
  }
  json.at("excavate").get_to(stage.excavate);
  if (json.contains("install")) json.at("install").get_to(stage.install);
  json.at("motion_index").get_to(stage.motion);
  stage.scale = number(json.at("scale"));
  if (json.contains("k_h")) {  // not in files of version 0.1
    stage.k_h = number(json.at("k_h"));
    stage.k_v = number(json.at("k_v"));
  }
  stage.duration = optional_number(json.at("given_duration"));
  if (!json.at("max_steps").is_null()) stage.max_steps = json.at("max_steps").get<int>();
  stage.tolerance = number(json.at("tolerance"));
  return stage;
}

StageLine read_stage_json(const std::string& text) {
  return parsed(text, [](const ordered_json& json) {
    StageLine line;
    json.at("index").get_to(line.index);
    json.at("ended").get_to(line.ended);
    simulation::StageRecord& r = line.stage;
    r.stage = read_given_stage(json);
    json.at("steps").get_to(r.steps);
    r.start_time = number(json.at("start_time"));
    r.duration = number(json.at("duration"));
    r.planned_duration = later_number(json, "planned_duration");
    r.pga = number(json.at("pga"));
    if (json.contains("pgv")) r.pgv = number(json.at("pgv"));  // not in files of version 0.1
    if (json.contains("arias")) r.arias = number(json.at("arias"));
    json.at("equilibrium_reached").get_to(r.equilibrium_reached);
    r.still = json.value("still", false);
    if (const auto wait = json.find("waits_for"); wait != json.end() && !wait->is_null())
      r.waits_for = {number(wait->at("until_s")), wait->at("what").get<std::string>()};
    r.worst_residual_ratio = number(json.at("worst_residual_ratio"));
    if (json.contains("way")) r.way = number(json.at("way"));
    if (json.contains("way_share")) r.way_share = number(json.at("way_share"));
    r.moving = read_moving(json.at("moving"));
    json.at("blocks_by_order").get_to(r.blocks_by_order);
    if (json.contains("release")) r.release = read_release(json.at("release"));
    r.damage = read_damage(json.at("damage"));
    if (json.contains("fallen")) {  // not in files of version 0.1
      r.fallen = read_fallen(json.at("fallen"));
      r.standing = read_standing(json.at("standing"));
      r.largest_speed = number(json.at("largest_speed"));
    }
    if (json.contains("movers")) {  // likewise
      r.movers = read_movers(json.at("movers"));
      json.at("unstable_block").get_to(r.unstable_block);
    }
    r.wall_time = number(json.at("wall_time"));
    json.at("interrupted").get_to(r.interrupted);
    for (const auto& t : json.at("motion_time")) r.motion_time.push_back(number(t));
    r.motion = read_points(json.at("motion"));
    return line;
  });
}

std::string run_json(const simulation::RunRecord& run) {
  const ordered_json json{{"steps", run.steps},
                          {"wall_time", run.wall_time},
                          {"dof", run.dof},
                          {"state_hash", run.state_hash},
                          {"open_close", open_close_json(run.open_close)},
                          {"max_overlap", run.max_overlap.depth},
                          {"max_overlap_at", overlap_place_json(run.max_overlap, {})},
                          {"contact_checks", contact_checks_json(run.contact_checks, {})},
                          {"max_area_change", run.max_area_change},
                          {"energy", energy_json(run.energy)},
                          {"made_ratio", run.made.ratio},
                          {"made_time", run.made.time},
                          {"made_share", run.made.share()},
                          {"planes", planes_json(run.planes, {})},
                          {"elements", elements_json(run.elements, {})},
                          {"water", run.water ? water_json(*run.water) : ordered_json()},
                          {"interrupted", run.interrupted}};
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

simulation::RunRecord read_run_json(const std::string& text) {
  return parsed(text, [](const ordered_json& json) {
    simulation::RunRecord run;
    json.at("steps").get_to(run.steps);
    run.wall_time = number(json.at("wall_time"));
    json.at("dof").get_to(run.dof);
    json.at("state_hash").get_to(run.state_hash);
    run.open_close = read_open_close(json.at("open_close"));
    run.max_overlap.depth = number(json.at("max_overlap"));
    // Files of earlier versions do not have it.
    if (json.contains("max_overlap_at")) read_overlap_place(json.at("max_overlap_at"), run.max_overlap);
    if (json.contains("contact_checks")) run.contact_checks = read_contact_checks(json.at("contact_checks"));
    run.max_area_change = number(json.at("max_area_change"));
    run.energy = read_energy(json.at("energy"));
    if (json.contains("made_ratio")) run.made.ratio = number(json.at("made_ratio"));
    if (json.contains("made_time")) run.made.time = number(json.at("made_time"));
    if (json.contains("made_share")) {
      run.made.most = number(json.at("made_share"));
      run.made.largest = 1.0;
    }
    if (json.contains("planes")) run.planes = read_planes(json.at("planes"));
    if (json.contains("elements")) run.elements = read_elements(json.at("elements"));
    if (json.contains("water") && !json.at("water").is_null()) run.water = read_water(json.at("water"));
    json.at("interrupted").get_to(run.interrupted);
    return run;
  });
}

}  // namespace keyblock::results
