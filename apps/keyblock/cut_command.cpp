#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <future>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/file_set.h"
#include "cutting/geojson.h"
#include "cutting/picture.h"
#include "job/result_folder.h"
#include "json_output.h"
#include "scenario/build.h"
#include "scenario/cut_summary.h"
#include "scenario/inputs.h"
#include "scenario_arguments.h"

namespace keyblock::app {
namespace {

struct CutArguments {
  ScenarioArguments scenario;
  std::string folder;
  bool as_json = false;
};

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
  const std::filesystem::path folder = arguments.folder;
  job::check_holds_no_run(folder);
  FileSet out(folder);
  const scenario::BlockModel model = scenario::build_blocks(scenario, realization);
  std::vector<std::string> warnings = scenario::rock_mass_warnings(scenario);
  scenario::add_block_warnings(scenario, model, warnings);
  scenario::add_overlap_warnings(scenario, model.system, warnings);
  print_warnings(arguments.scenario, warnings);
  // Hundreds of megabytes for many blocks: both files are put together and written at the same time.
  AtomicFile& geojson = out.add("blocks.geojson");
  // Without a thread, as where memory is short, one after the other.
  std::future<void> outlines = std::async([&] {
    geojson.write(cutting::to_geojson(model.system));
    geojson.close();
  });
  const std::filesystem::path svg = out.write("blocks.svg", picture(scenario, model));
  outlines.get();
  const std::string summary = scenario::cut_summary(scenario, realization, model, KEYBLOCK_VERSION);
  out.write("summary.json", summary);
  out.commit();
  if (arguments.as_json) return print_json_text(summary);
  const cutting::CutStatistics& cut = model.system.statistics;
  std::cout << fmt::format(
      "{} blocks from {} of {} traces; {:.1f} m of {:.1f} m end in rock or bound no block; {} slivers "
      "merged\n",
      model.system.blocks.size(), cut.joints_used, cut.traces, cut.removed_length, cut.trace_length,
      cut.merged_slivers);
  for (const std::string& note : scenario::sliver_notes(scenario, model.system)) std::cout << note << '\n';
  std::cout << "picture: " << svg.string() << '\n';
}

}  // namespace

void add_cut(CLI::App& app) {
  auto arguments = std::make_shared<CutArguments>();
  CLI::App* command = app.add_subcommand("cut", "Joints and blocks only, with a picture");
  add_scenario_arguments(*command, arguments->scenario);
  command->add_option("-o,--output", arguments->folder, "Folder for summary.json, blocks.geojson, blocks.svg")
      ->required()
      ->type_name("DIR");
  command->add_flag("--json", arguments->as_json, "Print summary.json in the place of a sentence");
  command->footer("Example:\n  keyblock cut tunnel.toml -o out/cut --realization 3");
  command->callback([arguments] { cut_scenario(*arguments); });
}

}  // namespace keyblock::app
