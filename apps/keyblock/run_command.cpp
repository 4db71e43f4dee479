#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/error.h"
#include "core/folder.h"
#include "core/out_of_memory.h"
#include "core/parallel.h"
#include "interrupt.h"
#include "model/options.h"
#include "outcome.h"
#include "progress.h"
#include "report/report.h"
#include "result_folder.h"
#include "results/csv.h"
#include "results/result_writer.h"
#include "results/run_data.h"
#include "scenario/build.h"
#include "scenario/cut_summary.h"
#include "scenario/inputs.h"
#include "scenario_arguments.h"
#include "simulation/fan_out.h"
#include "simulation/run.h"

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

/// Everything but what the run says at its end: the page from what the result file holds.
void write_report(const std::filesystem::path& folder) {
  with_memory_for([] { return std::string("the report; `keyblock report` writes it later"); },
                  [&] { report::write_report(results::read_run(folder), folder); });
}

/// What a run that has ended wrote from its results, and what is there no more, or empty.
void restore_conclusions(const std::filesystem::path& folder) {
  const auto is_gone = [&](const char* name) {
    return !file_exists(folder / name) || std::filesystem::is_empty(folder / name);
  };
  const bool report = is_gone("report.html"), histories = is_gone("histories.csv");
  if (!report && !histories) return;
  const results::RunData data = results::read_run(folder);
  if (report) report::write_report(data, folder);
  if (histories && !data.model.history_names.empty())
    results::write_histories_csv(folder, data.model.history_names, data.histories);
}

void say_where_report_is(const RunArguments& arguments) {
  std::cout << "report: " << arguments.folder << "/report.html" << std::endl;
}

std::vector<std::filesystem::path> inputs_of(const scenario::Scenario& scenario) {
  std::vector<std::filesystem::path> inputs = scenario::input_paths(scenario);
  inputs.emplace_back(scenario.file);
  return inputs;
}

simulation::RunRecord run_and_record(const simulation::RunSetup& setup, const RunArguments& arguments,
                                     ResultFolder& guard) {
  const std::filesystem::path folder = arguments.folder;
  if (arguments.threads > processors()) {
    std::cerr << "warning: --threads " << arguments.threads << ": there are " << processors()
              << " processors, and more threads take longer\n";
  }
  if (arguments.resume && !guard.resumes()) {
    std::cerr << arguments.folder << ": nothing to go on from; starting at the beginning\n";
  }
  results::ResultWriter writer(folder);
  writer.before_publishing([&] { guard.enter(); });
  ProgressObserver progress = ProgressObserver::to_standard_error(static_cast<int>(setup.stages.size()));
  simulation::FanOut observers({&writer, &progress});
  simulation::RunOptions options;
  options.threads = arguments.threads;
  options.directory = folder;
  options.resume = guard.resumes();
  options.stop = &stop_on_interrupt();
  return simulation::run(setup, options, observers);
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
  ResultFolder guard(arguments.folder, inputs_of(scenario), setup,
                     arguments.resume  ? ResultFolder::Use::resume
                     : arguments.force ? ResultFolder::Use::replace
                                       : ResultFolder::Use::fresh);
  if (guard.has_ended()) {
    std::cout << arguments.folder << ": this run has ended; there is nothing to go on with\n";
    restore_conclusions(arguments.folder);
    say_where_report_is(arguments);
    return;
  }
  if (const auto note = scenario::sliver_note(setup.system, scenario.blocks.size()))
    std::cout << *note << std::endl;
  simulation::RunRecord record;
  try {
    record = run_and_record(setup, arguments, guard);
  } catch (const RunError&) {
    try {
      if (guard.holds_this_run()) write_report(arguments.folder);
    } catch (const std::exception& error) {  // the first failure is the one to be told about
      std::cerr << "keyblock: no report: " << error.what() << "\n";
    }
    throw;
  }
  write_report(arguments.folder);
  std::cout << "\n" << outcome_text(record, setup.system.blocks.size());
  if (arguments.profile) std::cout << "\n" << profile_text(record) << "\n";
  say_where_report_is(arguments);
  if (record.interrupted) {
    throw RunError(fmt::format("interrupted; --resume goes on from what is kept in {}", arguments.folder));
  }
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
