#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <future>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "census_output.h"
#include "commands.h"
#include "core/error.h"
#include "core/file_set.h"
#include "core/parallel.h"
#include "cutting/geojson.h"
#include "cutting/picture.h"
#include "interrupt.h"
#include "job/result_folder.h"
#include "json_output.h"
#include "scenario/build.h"
#include "scenario/cut_summary.h"
#include "scenario/inputs.h"
#include "scenario/key_blocks.h"
#include "scenario/own_joints.h"
#include "scenario_arguments.h"
#include "study/census_study.h"

namespace keyblock::app {
namespace {

struct CutArguments {
  ScenarioArguments scenario;
  std::string folder;
  bool as_json = false;
  bool census = false;
  double factor = scenario::usual_wanted_factor;
  int realizations = 0;  ///< 0: that of the scenario alone
};

/// The key blocks of the rock that was cut, and of other realizations.
struct KeyBlocks {
  study::RealizationCensus own;
  std::optional<study::CensusStudy> all;
  std::string json, csv, text;
};

KeyBlocks key_blocks(const CutArguments& arguments, const scenario::Scenario& scenario,
                     const scenario::BlockModel& model) {
  const int realization = arguments.scenario.realization;
  KeyBlocks found;
  found.own = study::named_census(scenario, realization, model,
                                  scenario::take_census(scenario, model, arguments.factor));
  nlohmann::ordered_json json =
      scenario::census_json(scenario, realization, model, found.own.census, arguments.factor);
  found.text = std::string(scenario::census_assumptions) + "\n" + census_table(found.own, arguments.factor);
  if (arguments.realizations > 0) {
    found.all = study::take_censuses(scenario, arguments.realizations, arguments.factor, processors(),
                                     &stop_on_interrupt());
    json["over_realizations"] = study::censuses_json(*found.all);
    found.text += "\n" + censuses_table(*found.all);
  }
  found.csv = study::census_csv(found.all ? found.all->realizations : std::vector{found.own});
  found.json = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  return found;
}

std::string picture(const scenario::Scenario& scenario, const scenario::BlockModel& model,
                    const std::vector<cutting::BlockPaint>& paint) {
  cutting::PictureNames names;
  names.joint_sets = scenario::names_of(scenario::own_joint_sets(scenario));
  names.trace_maps = scenario::names_of(scenario::own_trace_maps(scenario));
  for (const auto& spec : scenario.excavations) names.excavations.push_back(spec.name);
  return cutting::draw_svg(model.system, model.traces, model.outlines, names, paint);
}

void tell_cut(const scenario::Scenario& scenario, const scenario::BlockModel& model,
              const std::string& census) {
  const cutting::CutStatistics& cut = model.system.statistics;
  std::cout << fmt::format(
      "{} blocks from {} of {} traces; {:.1f} m of {:.1f} m end in rock or bound no block; {} slivers "
      "merged\n",
      model.system.blocks.size(), cut.joints_used, cut.traces, cut.removed_length, cut.trace_length,
      cut.merged_slivers);
  for (const std::string& note : scenario::sliver_notes(scenario, model.system)) std::cout << note << '\n';
  std::cout << census;
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
  std::optional<KeyBlocks> found;
  if (arguments.census) {
    found = key_blocks(arguments, scenario, model);
    for (std::string& note : scenario::census_notes(scenario)) warnings.push_back(std::move(note));
  }
  print_warnings(arguments.scenario, warnings);
  // Hundreds of megabytes for many blocks: both files are put together and written at the same time.
  AtomicFile& geojson = out.add("blocks.geojson");
  // Without a thread, as where memory is short, one after the other.
  std::future<void> outlines = std::async([&] {
    geojson.write(cutting::to_geojson(model.system));
    geojson.close();
  });
  const std::filesystem::path svg =
      out.write("blocks.svg", picture(scenario, model,
                                      found ? census_paint(found->own.census, arguments.factor)
                                            : std::vector<cutting::BlockPaint>{}));
  outlines.get();
  const std::string summary = scenario::cut_summary(scenario, realization, model, KEYBLOCK_VERSION);
  out.write("summary.json", summary);
  if (found) {
    out.write("census.json", found->json);
    out.write("census.csv", found->csv);
  }
  out.commit();
  if (arguments.as_json) {
    print_json_text(found ? found->json : summary);
  } else {
    tell_cut(scenario, model, found ? found->text : "");
    std::cout << "picture: " << svg.string() << '\n';
  }
  if (const std::size_t failed = found && found->all ? found->all->failed() : 0; failed > 0)
    throw RunError(fmt::format("{} of {} realizations could not be cut; census.json says why", failed,
                               found->all->realizations.size()));
}

}  // namespace

void add_cut(CLI::App& app) {
  auto arguments = std::make_shared<CutArguments>();
  CLI::App* command = app.add_subcommand("cut", "Joints and blocks only, with a picture");
  add_scenario_arguments(*command, arguments->scenario);
  command->add_option("-o,--output", arguments->folder, "Folder for summary.json, blocks.geojson, blocks.svg")
      ->required()
      ->type_name("DIR");
  command->add_flag("--json", arguments->as_json,
                    "Print summary.json, with --census census.json, in the place of sentences");
  CLI::Option* census = command->add_flag(
      "--census", arguments->census,
      "Key blocks: which blocks fall or slide into the openings, with factors of safety; writes census.json "
      "and census.csv");
  command->add_option("--factor", arguments->factor, "Factor of safety that the forces of the census are for")
      ->check(CLI::Range(1.0, 1000.0).description(""))
      ->needs(census)
      ->capture_default_str()
      ->type_name("F");
  command
      ->add_option("--realizations", arguments->realizations,
                   "The census of each of realizations 0 … N-1 too, with means and their intervals")
      ->check(CLI::Range(1, 100000).description(""))
      ->needs(census)
      ->type_name("N");
  command->footer(
      "Examples:\n"
      "  keyblock cut tunnel.toml -o out/cut --realization 3\n"
      "  keyblock cut tunnel.toml -o out/census --census --realizations 200");
  command->callback([arguments] { cut_scenario(*arguments); });
}

}  // namespace keyblock::app
