#include "scenario/cut_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include "core/checked_json.h"
#include "cutting/cut_fields.h"
#include "cutting/edge_name.h"
#include "record/strengths_json.h"
#include "rockmass/intensity.h"
#include "rockmass/section.h"
#include "scenario/joint_table.h"
#include "scenario/own_joints.h"

namespace keyblock::scenario {
namespace {

using nlohmann::ordered_json;

/// m of rock bridges on the lines of a joint set.
double bridged_length(const cutting::BlockSystem& system, int set) {
  const auto share = std::ranges::find(
      system.joints, cutting::EdgeLabel{cutting::EdgeKind::joint_set, static_cast<std::int16_t>(set)},
      &cutting::JointShare::joint);
  return share != system.joints.end() ? share->bridged : 0.0;
}

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
                    {"bridge_length_m", bridged_length(model.system, static_cast<int>(k))},
                    {"p21_per_m", intensity.p21},
                    {"p20_per_m2", intensity.p20},
                    {"p10_across_per_m", intensity.p10_across},
                    {"p10_down_per_m", intensity.p10_down}});
  }
  return sets;
}

std::string joint_name(const Scenario& scenario, cutting::EdgeLabel label) {
  std::vector<std::string> excavations;
  for (const ExcavationSpec& spec : scenario.excavations) excavations.push_back(spec.name);
  return cutting::edge_name(label, names_of(own_joint_sets(scenario)), names_of(own_trace_maps(scenario)),
                            excavations);
}

ordered_json teeth_json(const Scenario& scenario, const cutting::BlockSystem& system) {
  ordered_json teeth = ordered_json::array();
  for (const cutting::JointTooth& tooth : system.teeth) {
    const Vec2 place = system.origin + tooth.place;
    teeth.push_back({{"joint", joint_name(scenario, tooth.joint)},
                     {"x", place.x},
                     {"y", place.y},
                     {"height_m", tooth.height}});
  }
  return teeth;
}

std::optional<std::string> note_of_many(const cutting::BlockSystem& system, std::size_t explicit_blocks) {
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

std::string counted_slivers(int count) {
  return fmt::format("{} sliver{}", count, count == 1 ? "" : "s");
}

/// Joints with how often each comes, and one place of each: "'weak' (2, one at (11.00, -14.00), 4.1 mm high)".
template <class Place>
std::string places_by_joint(const Scenario& scenario, const cutting::BlockSystem& system,
                            const std::vector<Place>& places, double Place::*size,
                            std::string (*size_text)(double)) {
  std::map<std::string, std::vector<const Place*>> by_joint;
  for (const Place& place : places) by_joint[joint_name(scenario, place.joint)].push_back(&place);
  std::vector<std::string> texts;
  for (const auto& [name, here] : by_joint) {
    const Place& largest = **std::max_element(
        here.begin(), here.end(), [&](const Place* a, const Place* b) { return a->*size < b->*size; });
    const Vec2 at = system.origin + largest.place;
    texts.push_back(fmt::format("'{}' {}at ({:.2f}, {:.2f}), {}", name,
                                here.size() == 1 ? "" : fmt::format("{} times, most ", here.size()), at.x,
                                at.y, size_text(largest.*size)));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::optional<std::string> note_of_teeth(const Scenario& scenario, const cutting::BlockSystem& system) {
  const cutting::CutStatistics& cut = system.statistics;
  if (system.teeth.empty()) return std::nullopt;
  return fmt::format(
      "{} merged, {} of them across a joint that runs through, which is held there by a tooth of rock: {}",
      counted_slivers(cut.merged_slivers), cut.merged_across_joints,
      places_by_joint(scenario, system, system.teeth, &cutting::JointTooth::height,
                      [](double height) { return fmt::format("{:.2g} mm high", 1e3 * height); }));
}

std::optional<std::string> note_of_slivers_left(const Scenario& scenario,
                                                const cutting::BlockSystem& system) {
  if (system.slivers_left.empty()) return std::nullopt;
  return fmt::format(
      "{} left, as [cutting] asks for; their corners can hold the joints beside them: {}",
      counted_slivers(static_cast<int>(system.slivers_left.size())),
      places_by_joint(scenario, system, system.slivers_left, &cutting::SmallBlock::area,
                      [](double area) { return fmt::format("{:.2g} cm2 large", 1e4 * area); }));
}

}  // namespace

std::vector<std::string> sliver_notes(const Scenario& scenario, const cutting::BlockSystem& system) {
  std::vector<std::string> notes;
  for (const auto& note : {note_of_many(system, scenario.blocks.size()), note_of_teeth(scenario, system),
                           note_of_slivers_left(scenario, system)}) {
    if (note) notes.push_back(*note);
  }
  return notes;
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
  const ordered_json json{
      {"title", scenario.title},
      {"version", version},
      {"seed", scenario.seed},
      {"realization", realization},
      {"blocks", model.system.blocks.size()},
      {"vertices", vertices},
      {"joints", cut.joints_used},
      {"area", {{"blocks", left}, {"excavated", excavated}, {"domain", cut.domain_area}}},
      {"merged_slivers", cut.merged_slivers},
      {"cutting", cutting::cutting_json<ordered_json>(cut, false)},
      {"teeth", teeth_json(scenario, model.system)},
      {"joint_sets", joint_sets(scenario, model)},
      {"joint_strengths", record::strengths_json<ordered_json>(joint_table(scenario, model).drawn)}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace keyblock::scenario
