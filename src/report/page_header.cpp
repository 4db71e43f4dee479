#include <fmt/format.h>

#include <cmath>

#include "core/checked_json.h"
#include "cutting/cut_fields.h"
#include "picture/marks.h"
#include "record/computation_errors.h"
#include "record/fallen.h"
#include "report/page_data.h"
#include "report/page_template.h"
#include "results/breaks.h"
#include "results/elements_json.h"
#include "results/json_parts.h"
#include "results/stage_json.h"
#include "results/summary.h"

namespace keyblock::report {

namespace {

using nlohmann::ordered_json;

ordered_json stage_json(const record::StageRecord& record) {
  ordered_json json = results::stage_fields_json(record, record::RecordFile::page);
  results::add_verdict(record, json["equilibrium"]);
  return json;
}

/// What the ground is, and what it came to beside the model.
std::vector<std::pair<std::string, std::string>> ground_rows(const results::RunData& data) {
  auto rows = data.model.ground;
  for (const record::PlaneRecord& plane : data.run.planes)
    rows.emplace_back(
        fmt::format("“{}” beside the model, x = {:.4g} m", plane.joint, plane.x + data.model.origin.x),
        fmt::format("at {:.4g} m it slipped by up to {:.3g} mm, and {:.3g} mm are left{}",
                    plane.height + data.model.origin.y, 1e3 * plane.slip_max, 1e3 * plane.slip,
                    plane.opened ? "; it opened" : ""));
  return rows;
}

/// The command that finds the support pressure, by what had fallen at the last moment at which that is known.
std::string pressure_search(const results::RunData& data) {
  for (auto stage = data.run.stages.rbegin(); stage != data.run.stages.rend(); ++stage) {
    if (!std::isnan(stage->damage.fallen_weight))
      return record::pressure_search("SCENARIO.toml", data.model.excavation_names, stage->damage);
  }
  return {};
}

/// What may be drawn over the blocks, with the size that Mark::drawn is of.
ordered_json marks_json(const results::RunData& data) {
  const picture::Typical typical = picture::typical_sizes(data);
  ordered_json marks = ordered_json::array();
  for (const picture::Mark& mark : picture::all_marks())
    marks.push_back({{"name", mark.name},
                     {"text", mark.text},
                     {"meaning", mark.meaning},
                     {"drawn", mark.drawn},
                     {"typical", typical.of(mark.name)},
                     {"color", mark.color}});
  return {{"longest_arrow", picture::longest_arrow}, {"all", marks}};
}

ordered_json model_json(const results::RunData& data) {
  const record::ModelRecord& model = data.model;
  ordered_json outlines = ordered_json::array();
  for (const auto& outline : model.excavation_outlines) outlines.push_back(results::points_json(outline));
  ordered_json names = ordered_json::object();
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    if (!model.blocks[b].name.empty()) names[std::to_string(b)] = model.blocks[b].name;
  return {{"title", model.title},
          {"version", model.version},
          {"seed", std::to_string(model.seed)},
          {"realization", model.realization},
          {"threads", model.threads},
          {"step_size_s", model.step_size},
          {"origin", {model.origin.x, model.origin.y}},
          {"scenario", model.scenario},
          {"block_names", names},
          {"stages", model.stage_names},
          {"joint_sets", model.joint_set_names},
          {"trace_maps", model.trace_map_names},
          {"excavations", model.excavation_names},
          {"excavation_outlines", outlines},
          {"pressure_search", pressure_search(data)},
          {"histories", model.history_names},
          {"elements", results::element_names_json(model)},
          {"element_histories", results::element_histories_json(model)},
          {"opening_width_m", results::or_null(model.opening_width)},
          {"slip_limit_m", results::or_null(model.slip_limit)},
          {"opening_limit_m", results::or_null(model.opening_limit)},
          {"warnings", model.warnings},
          {"closure_is_lower_bound", model.closure_is_lower_bound},
          {"ground", results::ground_json(ground_rows(data))},
          {"cutting", cutting::cutting_json<ordered_json>(model.cutting, true)}};
}

ordered_json run_json(const results::RunData& data) {
  const record::RunRecord& run = data.run;
  ordered_json stages = ordered_json::array();
  for (const record::StageRecord& record : run.stages) stages.push_back(stage_json(record));
  ordered_json json = results::run_fields_json(run, record::RecordFile::page);
  if (data.cut_off) json["open_close"] = nullptr;
  json["max_overlap_at"] = results::overlap_place_json(run.max_overlap, data.model.origin);
  json["contact_checks"] = results::contact_checks_json(run.contact_checks, data.model.origin);
  json["errors"] = record::computation_errors(run);
  json["elements"] = results::elements_json(run.elements, data.model.origin);
  json["breaks"] = results::breaks_json(run.breaks, &data.model);
  json["stages"] = stages;
  json["cut_off"] = data.cut_off;
  return json;
}

/// The smallest number of steps from one row of a stage to the next; 0 where there are no two rows.
long steps_between_rows(const std::vector<record::StepRow>& rows) {
  long least = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const long between = rows[k].step - rows[k - 1].step;
    if (rows[k].stage == rows[k - 1].stage && (least == 0 || between < least)) least = between;
  }
  return least;
}

}  // namespace

std::string page_header(const results::RunData& run, const ArrayPack& arrays) {
  ordered_json entries = ordered_json::array();
  for (const ArrayPack::Entry& e : arrays.entries())
    entries.push_back({{"name", e.name}, {"type", e.type}, {"offset", e.offset}, {"count", e.count}});
  const results::Areas area = results::areas(run.model, run.run);
  const ordered_json header{{"model", model_json(run)},
                            {"run", run_json(run)},
                            {"area", {{"blocks_m2", area.blocks}, {"excavated_m2", area.excavated}}},
                            {"recorded_frames", run.frames.size()},
                            {"displacement_quantum", displacement_quantum(run)},
                            {"stress_quantum", stress_quantum(run)},
                            {"velocity_quantum", velocity_quantum(run)},
                            {"marks", marks_json(run)},
                            {"steps_between_rows", steps_between_rows(run.steps)},
                            // In the order of the values in add_steps, page_arrays.cpp.
                            {"step_columns",
                             {"stage", "time", "iterations", "step_size", "penetration", "max_displacement",
                              "closed_contacts", "kinetic", "strain", "gravity", "contact", "friction",
                              "damping", "radiated", "numerical", "input", "water", "residual"}},
                            {"damage_measures", results::damage_measures_json()},
                            {"arrays", entries}};
  return script_json(header.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

PageData make_page_data(const results::RunData& run) {
  const ArrayPack arrays = page_arrays(run);
  return {page_header(run, arrays), arrays.encoded()};
}

}  // namespace keyblock::report
