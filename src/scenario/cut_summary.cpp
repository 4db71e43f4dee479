#include "scenario/cut_summary.h"

#include <fmt/format.h>

#include <iterator>

#include "core/checked_json.h"
#include "rockmass/intensity.h"
#include "rockmass/section.h"

namespace keyblock::scenario {
namespace {

using nlohmann::ordered_json;

ordered_json joint_sets(const Scenario& scenario, const BlockModel& model) {
  ordered_json sets = ordered_json::array();
  if (!scenario.domain || !scenario.section_azimuth) return sets;
  const Box window = scenario.domain->box();
  for (std::size_t k = 0; k < scenario.joint_sets.size(); ++k) {
    const rockmass::JointSet& set = scenario.joint_sets[k].set;
    const rockmass::TraceSource source{rockmass::TraceSource::Kind::joint_set, static_cast<int>(k)};
    std::vector<rockmass::Trace> own;
    std::copy_if(model.traces.begin(), model.traces.end(), std::back_inserter(own),
                 [&](const rockmass::Trace& trace) { return trace.source == source; });
    const rockmass::Intensity intensity = rockmass::measure_intensity(own, window);
    const double azimuth = *scenario.section_azimuth;
    sets.push_back({{"name", set.name},
                    {"apparent_dip_deg", rockmass::apparent_dip(set.dip, set.dip_direction, azimuth)},
                    {"spacing_factor", rockmass::trace_spacing_factor(set.dip, set.dip_direction, azimuth)},
                    {"traces", intensity.traces},
                    {"trace_length_m", intensity.length},
                    {"p21_per_m", intensity.p21},
                    {"p20_per_m2", intensity.p20},
                    {"p10_across_per_m", intensity.p10_across},
                    {"p10_down_per_m", intensity.p10_down}});
  }
  return sets;
}

ordered_json cutting_json(const cutting::CutStatistics& cut) {
  return {{"traces", cut.traces},
          {"trace_length_m", cut.trace_length},
          {"removed_length_m", cut.removed_length},
          {"removed_pieces", cut.removed_pieces},
          {"merged_vertices", cut.merged_vertices},
          {"sliver_area_m2", cut.sliver_area}};
}

}  // namespace

std::optional<std::string> sliver_note(const cutting::BlockSystem& system, std::size_t explicit_blocks) {
  constexpr double worth_saying = 0.01;
  const cutting::CutStatistics& cut = system.statistics;
  const auto merged = static_cast<std::size_t>(cut.merged_slivers);
  const std::size_t blocks = system.blocks.size() - explicit_blocks + merged;
  if (static_cast<double>(merged) <= worth_saying * static_cast<double>(blocks)) return std::nullopt;
  return fmt::format(
      "{} of {} blocks are slivers and part of their neighbours, {:.3g} m2 of {:.6g} m2 in all; [cutting] "
      "has the limits",
      merged, blocks, cut.sliver_area, cut.domain_area);
}

std::string cut_summary(const Scenario& scenario, int realization, const BlockModel& model,
                        const std::string& version) {
  double left = 0.0, excavated = 0.0;
  std::size_t vertices = 0;
  for (const cutting::CutBlock& block : model.system.blocks) {
    (block.excavations.empty() ? left : excavated) += area(block.polygon);
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) vertices += block.polygon.ring(r).size();
  }
  const cutting::CutStatistics& cut = model.system.statistics;
  const ordered_json json{{"title", scenario.title},
                          {"version", version},
                          {"seed", scenario.seed},
                          {"realization", realization},
                          {"blocks", model.system.blocks.size()},
                          {"vertices", vertices},
                          {"joints", cut.joints_used},
                          {"area", {{"blocks", left}, {"excavated", excavated}, {"domain", cut.domain_area}}},
                          {"merged_slivers", cut.merged_slivers},
                          {"cutting", cutting_json(cut)},
                          {"joint_sets", joint_sets(scenario, model)}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace keyblock::scenario
