#include "results/summary.h"

#include <algorithm>
#include <set>

#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "cutting/cut_fields.h"
#include "record/computation_errors.h"
#include "record/energy_warnings.h"
#include "record/strengths_json.h"
#include "results/breaks.h"
#include "results/elements_json.h"
#include "results/json_parts.h"
#include "results/stage_json.h"

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;

// The frame around a domain is a block of the model, fixed and with no edge but the domain's.
bool is_frame(const record::ModelRecord& model, const record::ModelRecord::Block& block) {
  bool along_domain = block.fixed;
  for (int k = block.ring_start.front(); k < block.ring_start.back() && along_domain; ++k) {
    along_domain = model.edge_label[static_cast<std::size_t>(k)].kind == cutting::EdgeKind::domain;
  }
  return along_domain;
}

struct Count {
  std::size_t blocks = 0;
  int vertices = 0;
};

Count count(const record::ModelRecord& model) {
  Count count;
  for (const auto& block : model.blocks) {
    if (is_frame(model, block)) continue;
    ++count.blocks;
    count.vertices += block.ring_start.back() - block.ring_start.front();
  }
  return count;
}

// Equilibrium is a question only where the stage seeks it.
void judge(const record::StageRecord& r, ordered_json& equilibrium) {
  if (r.stage.kind != record::StageKind::settle) {
    equilibrium.erase("unstable_block");
    equilibrium.erase("moving");
    for (auto& value : equilibrium) value = nullptr;
    equilibrium["verdict"] = equilibrium["moving_blocks"] = nullptr;
    return;
  }
  add_verdict(r, equilibrium);
  equilibrium["moving_blocks"] = r.moving.size();
  equilibrium["unstable_blocks"] = r.unstable_block < 0 ? 0 : 1;
  if (r.unstable_block < 0) equilibrium["unstable_block"] = nullptr;
}

ordered_json blocks_by_order(const record::StageRecord& r) {
  ordered_json json = ordered_json::object();
  for (std::size_t n = 0; n < r.blocks_by_order.size(); ++n) {
    if (r.blocks_by_order[n] > 0) json[std::to_string(n)] = r.blocks_by_order[n];
  }
  return json;
}

ordered_json stage(const record::StageRecord& r, const record::ModelRecord& model) {
  ordered_json json = stage_fields_json(r, record::RecordFile::summary);
  judge(r, json["equilibrium"]);
  json["blocks_by_order"] = blocks_by_order(r);
  json["release"] = release_json(r.release, model.excavation_names);
  return json;
}

ordered_json damping(const record::ModelRecord& model) {
  ordered_json json = ordered_json::array();
  for (const record::DampingRow& row : model.damping)
    json.push_back({{"frequency_hz", row.frequency},
                    {"rock", row.rock},
                    {"rule", row.rule},
                    {"total", row.total()},
                    {"waves", row.waves()}});
  return json;
}

/// null where there is none.
ordered_json rock_layers(const std::vector<record::LayerRecord>& layers, double origin) {
  ordered_json rock = ordered_json::array();
  for (const record::LayerRecord& layer : layers) {
    rock.push_back({{"top_m", nullptr},
                    {"density", layer.density},
                    {"vs_m_s", layer.speeds.x},
                    {"vp_m_s", layer.speeds.y}});
    if (rock.size() > 1) rock.back()["top_m"] = layer.top + origin;
  }
  return rock;
}

ordered_json boundary(const record::ModelRecord& model, const record::RunRecord& run) {
  if (!model.boundary) return nullptr;
  const record::BoundaryRecord& b = *model.boundary;
  ordered_json columns = ordered_json::array(), half_space = nullptr;
  for (const record::ColumnRecord& c : model.columns)
    columns.push_back({{"x", c.x + model.origin.x},
                       {"base_m", c.base + model.origin.y},
                       {"ground_m", c.ground + model.origin.y},
                       {"longest_element_m", c.longest_element}});
  if (b.compliant) half_space = {{"impedance_s", b.dashpots.x}, {"impedance_p", b.dashpots.y}};
  return {{"base", b.compliant ? "compliant" : "rigid"},
          {"sides", name_of(b.sides)},
          {"top", b.overburden ? "overburden" : "free"},
          {"half_space", half_space},
          {"rock", rock_layers(b.layers, model.origin.y)},
          {"rock_on_the_right",
           b.right_layers.empty() ? ordered_json() : rock_layers(b.right_layers, model.origin.y)},
          {"rock_source", b.source},
          {"columns", columns},
          {"planes", planes_json(run.planes, model.origin)}};
}

ordered_json profile(const record::RunRecord& run) {
  ordered_json json = ordered_json::object();
  for (std::size_t k = 0; k < phase_count; ++k) {
    const Profile::Entry& entry = run.profile[static_cast<Phase>(k)];
    json[phase_names[k].key] = {{"seconds", entry.seconds}, {"count", entry.count}};
  }
  return json;
}

}  // namespace

Areas areas(const record::ModelRecord& model, const record::RunRecord& run) {
  std::set<int> opened;
  for (const auto& stage : run.stages)
    opened.insert(stage.stage.excavate.begin(), stage.stage.excavate.end());
  Areas areas;
  areas.domain = model.cutting.domain_area;
  for (const auto& block : model.blocks) {
    if (is_frame(model, block)) continue;
    const bool out = std::any_of(block.excavations.begin(), block.excavations.end(),
                                 [&](int e) { return opened.contains(e); });
    (out ? areas.excavated : areas.blocks) += block.area;
  }
  return areas;
}

std::string summary_json(const record::ModelRecord& model, const record::RunRecord& run) {
  ordered_json stages = ordered_json::array();
  for (const auto& record : run.stages) stages.push_back(stage(record, model));
  const auto [blocks, vertices] = count(model);
  const Areas area = areas(model, run);
  ordered_json json{
      {"title", model.title},
      {"version", model.version},
      {"seed", model.seed},
      {"realization", model.realization},
      {"warnings", model.warnings},
      {"closure_is_lower_bound", model.closure_is_lower_bound},
      {"blocks", blocks},
      {"vertices", vertices},
      {"joints", model.cutting.joints_used},
      {"area", {{"blocks", area.blocks}, {"excavated", area.excavated}, {"domain", area.domain}}},
      {"merged_slivers", model.cutting.merged_slivers},
      {"cutting", cutting::cutting_json<ordered_json>(model.cutting, false)},
      {"step_size", model.step_size},
      {"ms_per_step", run.steps > 0 ? 1e3 * run.wall_time / static_cast<double>(run.steps) : 0.0},
      {"threads", model.threads},
      {"profile", profile(run)}};
  json.update(run_fields_json(run, record::RecordFile::summary));
  json.update({{"max_overlap_at", overlap_place_json(run.max_overlap, model.origin)},
               {"contact_checks", contact_checks_json(run.contact_checks, model.origin)},
               {"errors", record::computation_errors(run)},
               {"boundary", boundary(model, run)},
               {"elements", elements_json(run.elements, model.origin)},
               {"breaks", breaks_json(run.breaks, &model)},
               {"water", run.water ? water_json(*run.water) : ordered_json()},
               {"joint_strengths", record::strengths_json<ordered_json>(model.strengths)},
               {"damping", damping(model)},
               {"energy_warnings", record::energy_warnings(run)},
               {"stages", stages}});
  for (const auto& [name, hash] : model.hooks) json["hooks"].push_back({{"name", name}, {"hash", hash}});
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void write_summary(const std::filesystem::path& directory, const record::ModelRecord& model,
                   const record::RunRecord& run) {
  write_file_atomically(directory / "summary.json", summary_json(model, run));
}

}  // namespace keyblock::results
