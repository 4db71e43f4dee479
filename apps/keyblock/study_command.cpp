#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "commands.h"
#include "core/error.h"
#include "interrupt.h"
#include "progress.h"
#include "scenario_arguments.h"
#include "study/array_index.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/plan_json.h"
#include "study/task.h"
#include "study/workers.h"
#include "study_commands.h"
#include "study_progress.h"

namespace keyblock::app {
namespace {

constexpr std::size_t most_findings = 40;  // lines

void tell(const study::CollectReport& report, const std::string& folder) {
  for (std::size_t k = 0; k < std::min(report.findings.size(), most_findings); ++k)
    std::cout << report.findings[k] << "\n";
  if (report.findings.size() > most_findings)
    std::cout << "and " << report.findings.size() - most_findings << " lines more: see the report\n";
  print_count(report.count);
  std::cout << "\nreport: " << folder << "/report.html" << std::endl;
}

struct StudyArguments {
  ScenarioArguments scenario;
  std::string folder;
  int workers = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  bool resume = false;
};

void run_study(const StudyArguments& arguments) {
  std::vector<std::string> warnings;
  study::Plan plan =
      study::make_plan(arguments.scenario.file, arguments.scenario.overrides, KEYBLOCK_VERSION, &warnings);
  print_warnings(arguments.scenario, warnings);
  const auto lock = study::lock_study(arguments.folder);
  study::enter_plan(arguments.folder, plan, arguments.resume);
  study::StudyFiles files = study::read_study_files(arguments.folder, plan);
  for (const study::RunState& state : files.states) {
    if (state.kind == study::RunState::Kind::damaged) std::cerr << state.problem << "; it is run again\n";
  }
  StudyDisplay display = StudyDisplay::to_standard_error("study");
  study::WorkerOptions options;
  options.workers = arguments.workers;
  options.command = {"/proc/self/exe", "study", "task"};
  options.stop = &stop_on_interrupt();
  options.report = [&](const study::StudyProgress& progress) { display.show(progress); };
  const study::WorkerOutcome outcome = study::run_workers(arguments.folder, plan, files, options);
  display.end();
  tell(study::gather(arguments.folder, plan, std::move(files)), arguments.folder);
  if (outcome.interrupted)
    throw RunError(fmt::format("interrupted; --resume goes on from what is kept in {}", arguments.folder));
  if (!outcome.failed.empty()) {
    throw RunError(fmt::format("{} {} failed; --resume tries {} again", outcome.failed.size(),
                               outcome.failed.size() == 1 ? "run" : "runs",
                               outcome.failed.size() == 1 ? "it" : "them"));
  }
}

struct TaskArguments {
  std::string folder;
  std::string index;
  long first = 0;
  int descriptor = -1;
};

void run_task(const TaskArguments& arguments) {
  const study::Plan plan = study::read_plan(arguments.folder);
  const std::size_t index = study::array_index(arguments.index, arguments.first, plan.runs.size());
  study::TaskOptions options;
  options.stop = &stop_on_interrupt();
  options.observers = [&](const simulation::RunSetup& setup) {
    std::vector<std::unique_ptr<record::RunObserver>> observers;
    observers.push_back(std::make_unique<ProgressObserver>(
        ProgressObserver::to_standard_error(static_cast<int>(setup.stages.size()))));
    if (arguments.descriptor >= 0)
      observers.push_back(std::make_unique<study::ProgressPipe>(arguments.descriptor, setup));
    return observers;
  };
  const std::string& key = plan.runs[index].key;
  std::cerr << fmt::format("run {} of {}: {}\n", index, plan.runs.size(), key);
  switch (study::run_task(arguments.folder, plan, index, options)) {
    case study::TaskOutcome::done:
      std::cout << key << ": done" << std::endl;
      break;
    case study::TaskOutcome::was_done:
      std::cout << key << ": done before" << std::endl;
      break;
    case study::TaskOutcome::not_asked:
      std::cout << key << ": the study does not ask for it" << std::endl;
      break;
    case study::TaskOutcome::interrupted:
      throw RunError(key + ": interrupted");
  }
}

void describe_run(CLI::App& study) {
  auto arguments = std::make_shared<StudyArguments>();
  CLI::App* command = study.add_subcommand("run", "All runs of a study on this machine, and its report");
  add_scenario_file(*command, arguments->scenario);
  add_study_folder(*command, arguments->folder);
  command->add_option("--workers", arguments->workers, "Runs at a time, each a process of one thread")
      ->check(CLI::Range(1, 4096).description(""))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag(
      "--resume", arguments->resume,
      "Go on with the study in DIR: what is missing, what failed, what [study] asks for beyond it");
  command->footer(
      "Ctrl-C keeps the runs that are done.\n\n"
      "Examples:\n"
      "  keyblock study run tunnel.toml -o out/study\n"
      "  keyblock study run tunnel.toml -o out/study --resume --workers 8");
  command->callback([arguments] { run_study(*arguments); });
}

void describe_task(CLI::App& study) {
  auto arguments = std::make_shared<TaskArguments>();
  CLI::App* command =
      study.add_subcommand("task", "One run of a planned study: what the task of a job array does");
  command->add_option("DIR", arguments->folder, "Folder of the study")->required();
  command->add_option(
      "INDEX", arguments->index,
      "Place of the run in plan.json, counted from 0; default: the index of the array task, from "
      "the environment of Slurm, SGE, PBS, LSF or Kubernetes");
  command
      ->add_option("--first", arguments->first, "The index of the first run, where they are counted from 1")
      ->check(CLI::Range(0, 1).description(""))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--progress-descriptor", arguments->descriptor)->group("");
  command->footer("Example:\n  keyblock study task out/study 17");
  command->callback([arguments] { run_task(*arguments); });
}

void describe_collect(CLI::App& study) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = study.add_subcommand(
      "collect",
      "Gather the runs that are there: runs.csv, study.json, report.html; name those that are not");
  command->add_option("DIR", *folder, "Folder of the study")->required();
  command->footer("Example:\n  keyblock study collect out/study");
  command->callback([folder] { tell(study::collect(*folder), *folder); });
}

}  // namespace

void add_study_folder(CLI::App& command, std::string& folder) {
  command
      .add_option("-o,--output", folder,
                  "Folder of the study: plan.json, runs/, runs.csv, study.json, report.html")
      ->required()
      ->type_name("DIR");
}

void add_study(CLI::App& app) {
  CLI::App* study = app.add_subcommand("study", "Monte Carlo studies: realizations x scales x ...");
  study->require_subcommand(1);
  study->footer(
      "Examples:\n"
      "  keyblock study run tunnel.toml -o out/study --workers 8\n"
      "  keyblock study submit tunnel.toml -o out/study --now\n"
      "  keyblock study status out/study\n"
      "  keyblock study collect out/study");
  describe_run(*study);
  describe_task(*study);
  describe_collect(*study);
  add_study_status(*study);
  add_study_submit(*study);
}

}  // namespace keyblock::app
