#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/error.h"
#include "core/parallel.h"
#include "interrupt.h"
#include "job/recorded_run.h"
#include "model/options.h"
#include "outcome.h"
#include "progress.h"
#include "record/computation_errors.h"
#include "record/energy_warnings.h"
#include "results/run_data.h"
#include "scenario/build.h"
#include "scenario/cut_summary.h"
#include "scenario_arguments.h"

namespace keyblock::app {
namespace {

struct RunArguments {
  ScenarioArguments scenario;
  std::string folder;
  int threads = 1;
  std::string solver;
  bool resume = false;
  bool force = false;
  bool profile = false;
  std::vector<std::string> without;  ///< names of accelerators
};

void say_where_report_is(const RunArguments& arguments) {
  std::cout << "report: " << arguments.folder << "/report.html" << std::endl;
}

void say_beforehand(const RunArguments& arguments, const job::RecordedRun& run) {
  if (arguments.threads > processors()) {
    std::cerr << "warning: --threads " << arguments.threads << ": there are " << processors()
              << " processors, and more threads take longer\n";
  }
  if (arguments.resume && !run.resumes()) {
    std::cerr << arguments.folder << ": nothing to go on from; starting at the beginning\n";
  }
}

job::RecordedRun::Options options_of(const RunArguments& arguments) {
  job::RecordedRun::Options options;
  options.folder = arguments.folder;
  options.use = arguments.resume  ? job::ResultFolder::Use::resume
                : arguments.force ? job::ResultFolder::Use::replace
                                  : job::ResultFolder::Use::fresh;
  options.run.threads = arguments.threads;
  options.run.stop = &stop_on_interrupt();
  return options;
}

std::vector<std::string> opening_names(const simulation::RunSetup& setup) {
  std::vector<std::string> names;
  for (const simulation::Excavation& opening : setup.excavations) names.push_back(opening.name);
  return names;
}

void run_scenario(RunArguments arguments) {
  if (!arguments.solver.empty()) arguments.scenario.overrides.push_back("solver.linear=" + arguments.solver);
  std::vector<std::string> warnings;
  const scenario::Scenario scenario = arguments.scenario.read();
  simulation::RunSetup setup = scenario::build_setup(scenario, arguments.scenario.realization, &warnings);
  setup.version = KEYBLOCK_VERSION;
  for (const auto& [name, member] : dynamics::accelerator_names) {
    if (std::ranges::find(arguments.without, name) != arguments.without.end())
      setup.solver.accelerators.*member = false;
  }
  print_warnings(arguments.scenario, warnings);
  ProgressObserver progress = ProgressObserver::to_standard_error(static_cast<int>(setup.stages.size()));
  job::RecordedRun run(scenario, setup, options_of(arguments), progress);
  if (run.has_ended()) {
    std::cout << arguments.folder << ": this run has ended; there is nothing to go on with\n";
    job::restore_conclusions(arguments.folder);
    say_where_report_is(arguments);
    if (const auto ended = results::ended_run(arguments.folder)) record::check_computation(*ended);
    return;
  }
  for (const std::string& note : scenario::sliver_notes(scenario, setup.system))
    std::cout << note << std::endl;
  say_beforehand(arguments, run);
  run.start();
  while (!run.runner().done()) run.advance();
  const record::RunRecord record = run.finish();
  std::cout << "\n"
            << outcome_text(record, setup.system.blocks.size(), arguments.scenario.file,
                            opening_names(setup));
  if (arguments.profile) std::cout << "\n" << profile_text(record) << "\n";
  say_where_report_is(arguments);
  if (record.interrupted) {
    throw RunError(fmt::format("interrupted; --resume goes on from what is kept in {}", arguments.folder));
  }
  record::check_computation(record);
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Cut, excavate, shake: the whole job, and its report");
  add_scenario_arguments(*command, arguments->scenario);
  command
      ->add_option("-o,--output", arguments->folder,
                   "Folder of the results: summary.json, result.h5, histories.csv, report.html")
      ->required()
      ->type_name("DIR");
  command->add_option("--threads", arguments->threads, "Threads; any number gives the same bits")
      ->check(CLI::Range(1, 1024).description(""))
      ->capture_default_str()
      ->type_name("N");
  CLI::Option* force =
      command->add_flag("--force", arguments->force, "Replace results of other input in DIR");
  command
      ->add_flag("--resume", arguments->resume,
                 "Go on where an interrupted run stopped, to the same end, bit for bit; one that has ended "
                 "stays as it is")
      ->excludes(force);
  command->add_flag("--profile", arguments->profile, "Say at the end what the time was spent on");
  command
      ->add_option("--solver", arguments->solver,
                   "automatic, block, iterative; or direct, a library's, to check them by")
      ->check(CLI::IsMember({"automatic", "block", "iterative", "direct"}).description(""))
      ->type_name("NAME");
  std::vector<std::string> accelerators;
  for (const auto& [name, member] : dynamics::accelerator_names) accelerators.emplace_back(name);
  command
      ->add_option("--without", arguments->without, "Accelerators that are switched off, to look for a fault")
      ->check(CLI::IsMember(accelerators).description(""))
      ->type_name("NAME")
      ->group("");  // for those who build the program
  command->footer(
      "Ctrl-C ends the run within the step at hand, with everything so far readable.\n\n"
      "Examples:\n"
      "  keyblock run tunnel.toml -o out/tunnel --threads 2\n"
      "  keyblock run tunnel.toml -o out/tunnel --resume\n"
      "  keyblock run tunnel.toml -o out/7 --realization 7 --set rock.order=2");
  command->callback([arguments] { run_scenario(*arguments); });
}

}  // namespace keyblock::app
