#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "core/atomic_file.h"
#include "cutting/geojson.h"
#include "cutting/picture.h"
#include "result_folder.h"
#include "scenario/build.h"
#include "scenario_arguments.h"

namespace keyblock::app {
namespace {

struct CutArguments {
  ScenarioArguments scenario;
  std::string folder;
};

/// Fields as in the summary of a run, as far as they are known without one; every excavation counts as opened.
std::string summary(const scenario::Scenario& scenario, int realization, const cutting::BlockSystem& system) {
  double left = 0.0, excavated = 0.0;
  std::size_t vertices = 0;
  for (const cutting::CutBlock& block : system.blocks) {
    (block.excavations.empty() ? left : excavated) += area(block.polygon);
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) vertices += block.polygon.ring(r).size();
  }
  const cutting::CutStatistics& cut = system.statistics;
  using nlohmann::ordered_json;
  const ordered_json json{{"title", scenario.title},
                          {"version", KEYBLOCK_VERSION},
                          {"seed", scenario.seed},
                          {"realization", realization},
                          {"blocks", system.blocks.size()},
                          {"vertices", vertices},
                          {"joints", cut.joints_used},
                          {"area", {{"blocks", left}, {"excavated", excavated}, {"domain", cut.domain_area}}},
                          {"merged_slivers", cut.merged_slivers},
                          {"cutting",
                           {{"traces", cut.traces},
                            {"trace_length_m", cut.trace_length},
                            {"removed_length_m", cut.removed_length},
                            {"removed_pieces", cut.removed_pieces},
                            {"merged_vertices", cut.merged_vertices},
                            {"sliver_area_m2", cut.sliver_area}}}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string picture(const scenario::Scenario& scenario, const scenario::BlockModel& model) {
  cutting::PictureNames names;
  for (const auto& spec : scenario.joint_sets) names.joint_sets.push_back(spec.set.name);
  for (const auto& spec : scenario.trace_maps) names.trace_maps.push_back(spec.name);
  for (const auto& spec : scenario.excavations) names.excavations.push_back(spec.name);
  return cutting::draw_svg(model.system, model.traces, model.outlines, names);
}

void cut_scenario(const CutArguments& arguments) {
  const scenario::Scenario scenario = arguments.scenario.read();
  const int realization = arguments.scenario.realization;
  const scenario::BlockModel model = scenario::build_blocks(scenario, realization);
  const std::filesystem::path folder = arguments.folder;
  make_folder(folder);
  check_holds_no_run(folder);
  write_file_atomically(folder / "blocks.geojson", cutting::to_geojson(model.system));
  write_file_atomically(folder / "blocks.svg", picture(scenario, model));
  write_file_atomically(folder / "summary.json", summary(scenario, realization, model.system));
  const cutting::CutStatistics& cut = model.system.statistics;
  std::cout << fmt::format(
      "{} blocks from {} of {} traces; {:.1f} m of {:.1f} m end in rock or bound no block; {} slivers "
      "merged\n"
      "picture: {}\n",
      model.system.blocks.size(), cut.joints_used, cut.traces, cut.removed_length, cut.trace_length,
      cut.merged_slivers, (folder / "blocks.svg").string());
}

}  // namespace

void add_cut(CLI::App& app) {
  auto arguments = std::make_shared<CutArguments>();
  CLI::App* command = app.add_subcommand("cut", "Joints and blocks only, with a picture");
  add_scenario_arguments(*command, arguments->scenario);
  command->add_option("-o,--output", arguments->folder, "Folder for summary.json, blocks.geojson, blocks.svg")
      ->required()
      ->type_name("DIR");
  command->footer("Example:\n  keyblock cut tunnel.toml -o out/cut --realization 3");
  command->callback([arguments] { cut_scenario(*arguments); });
}

}  // namespace keyblock::app
