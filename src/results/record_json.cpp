#include "results/record_json.h"

#include <optional>
#include <utility>

#include "core/checked_json.h"
#include "core/error.h"
#include "cutting/cut_fields.h"
#include "record/run_fields.h"
#include "record/strengths_json.h"
#include "results/breaks.h"
#include "results/elements_json.h"
#include "results/field_json.h"
#include "results/joint_table.h"
#include "results/json_parts.h"
#include "results/stage_json.h"

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;

std::optional<double> optional_number(const ordered_json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

// Of a field that files of version 0.1 do not have.
std::optional<double> later_number(const ordered_json& json, const char* name) {
  return json.contains(name) ? optional_number(json.at(name)) : std::nullopt;
}

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

std::string model_json(const record::ModelRecord& model) {
  ordered_json outlines = ordered_json::array();
  for (const auto& outline : model.excavation_outlines) outlines.push_back(points_json(outline));
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
                    {"cutting", cutting::cutting_json<ordered_json>(model.cutting, true)},
                    {"warnings", model.warnings},
                    {"closure_is_lower_bound", model.closure_is_lower_bound},
                    {"ground", ground_json(model.ground)},
                    {"hooks", model.hooks}};
  if (!model.strengths.empty()) json["strengths"] = record::strengths_json<ordered_json>(model.strengths);
  add_element_names(model, json);
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void read_model_json(const std::string& text, record::ModelRecord& model) {
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
    visit_cutting(model.cutting, [&](const cutting::CutField& field, auto& value) {
      read_field(json.at("cutting"), field, value);
    });
    // Files of earlier versions have none of these.
    if (json.contains("warnings")) json.at("warnings").get_to(model.warnings);
    if (json.contains("closure_is_lower_bound"))
      json.at("closure_is_lower_bound").get_to(model.closure_is_lower_bound);
    if (json.contains("ground")) model.ground = read_ground(json.at("ground"));
    if (json.contains("strengths")) model.strengths = read_strengths(json.at("strengths"));
    if (json.contains("hooks")) json.at("hooks").get_to(model.hooks);
    return 0;
  });
}

std::string stage_json(int index, const record::StageRecord& stage, bool ended) {
  ordered_json json{{"index", index}, {"ended", ended}};
  json.update(stage_fields_json(stage, record::RecordFile::result));
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

StageLine read_stage_json(const std::string& text) {
  return parsed(text, [](const ordered_json& json) {
    StageLine line;
    json.at("index").get_to(line.index);
    json.at("ended").get_to(line.ended);
    read_stage_fields(json, line.stage);
    return line;
  });
}

ordered_json run_fields_json(const record::RunRecord& run, record::RecordFile file) {
  ordered_json json;
  record::visit_run(run, [&](const record::RunField& field, const auto& value) {
    if (field.file <= file) json[field.name] = json_of(value);
  });
  return json;
}

std::string run_json(const record::RunRecord& run) {
  ordered_json json = run_fields_json(run, record::RecordFile::result);
  json["max_overlap_at"] = overlap_place_json(run.max_overlap, {});
  json["contact_checks"] = contact_checks_json(run.contact_checks, {});
  json["made_share"] = run.made.share();
  json["planes"] = planes_json(run.planes, {});
  json["elements"] = elements_json(run.elements, {});
  json["breaks"] = breaks_json(run.breaks);
  json["water"] = run.water ? water_json(*run.water) : ordered_json();
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

record::RunRecord read_run_json(const std::string& text) {
  return parsed(text, [](const ordered_json& json) {
    record::RunRecord run;
    record::visit_run(run,
                      [&](const record::RunField& field, auto& value) { read_field(json, field, value); });
    // Files of earlier versions do not have these.
    if (json.contains("max_overlap_at")) read_overlap_place(json.at("max_overlap_at"), run.max_overlap);
    if (json.contains("contact_checks")) run.contact_checks = read_contact_checks(json.at("contact_checks"));
    if (json.contains("made_share")) {
      run.made.most = number(json.at("made_share"));
      run.made.largest = 1.0;
    }
    if (json.contains("planes")) run.planes = read_planes(json.at("planes"));
    if (json.contains("elements")) run.elements = read_elements(json.at("elements"));
    if (json.contains("breaks")) run.breaks = read_breaks(json.at("breaks"));
    if (json.contains("water") && !json.at("water").is_null()) run.water = read_water(json.at("water"));
    return run;
  });
}

}  // namespace keyblock::results
