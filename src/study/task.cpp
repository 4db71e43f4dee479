#include "study/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/atomic_file.h"
#include "core/error.h"
#include "record/computation_errors.h"
#include "record/fan_out.h"
#include "report/report.h"
#include "results/result_writer.h"
#include "results/summary.h"
#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario/parse.h"
#include "simulation/run.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/measure_observer.h"
#include "study/memory_recorder.h"
#include "study/outputs.h"
#include "study/run_json.h"
#include "study/until.h"
#include "study/variant.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;
using scenario::Keep;

constexpr double never = 1e9;  // s between records that nobody keeps

void check_file(const Plan& plan, const fs::path& path) {
  for (const InputFile& file : plan.files) {
    if (file.name != input_name(plan.scenario, path)) continue;
    if (hash_text(read_file(path)) == file.hash) return;
    Diagnostic diagnostic;
    diagnostic.where.file = path.string();
    diagnostic.found = "a file that has changed since the study was planned";
    diagnostic.expected = "the file as it was";
    throw InputError(std::move(diagnostic));
  }
}

scenario::Scenario scenario_of(const Plan& plan, const PlannedRun& run) {
  std::vector<std::string> overrides = plan.overrides;
  for (const std::string& text : overrides_of(plan, run)) overrides.push_back(text);
  scenario::Scenario scenario =
      scenario::parse_scenario_text(plan.text, plan.scenario, overrides, scenario::StudyTable::leave_out);
  for (const fs::path& path : scenario::input_paths(scenario)) check_file(plan, path);
  scenario.strata = plan.strata;
  apply_variant(scenario, run.variant, variant_terms(plan));
  if (!run.variant.empty()) scenario.text += fmt::format("# variant {}\n", run.variant);
  return scenario;
}

class Task {
 public:
  Task(const fs::path& directory, const Plan& plan, const PlannedRun& run)
      : plan_(plan), folder_(run_folder(directory, run.key)), result_(empty_result(run)) {}

  TaskOutcome run(const simulation::RunSetup& setup, const TaskOptions& options) {
    std::vector<ShakingRecord> records;
    for (std::size_t k = 0; k < setup.motions.size(); ++k)
      records.push_back(
          {setup.motions[k].name(), k < horizontal_.size() ? horizontal_[k] : loading::HorizontalMeasures{}});
    MeasureObserver measures(result_, plan_.grid, setup.system.blocks.size(), setup.damage.loosened_distance,
                             std::move(records));
    std::unique_ptr<results::ResultWriter> writer;
    std::unique_ptr<MemoryRecorder> memory;
    std::vector<record::RunObserver*> observers{&measures};
    if (plan_.keep == Keep::all) {
      writer = std::make_unique<results::ResultWriter>(folder_);
      observers.push_back(writer.get());
    }
    if (plan_.keep != Keep::measures) {
      memory = std::make_unique<MemoryRecorder>();
      observers.push_back(memory.get());
    }
    std::vector<std::unique_ptr<record::RunObserver>> others;
    if (options.observers) others = options.observers(setup);
    for (const auto& other : others) observers.push_back(other.get());
    record::FanOut fan(observers);
    simulation::RunOptions run_options;
    run_options.stop = options.stop;
    run_options.after_step = options.after_step;
    const record::RunRecord record = simulation::run(setup, run_options, fan);
    writer.reset();
    if (record.interrupted) return TaskOutcome::interrupted;
    if (memory) {
      report::write_report(memory->data(), folder_);
      if (!writer) results::write_summary(folder_, measures.model(), record);
    }
    write_file_atomically(folder_ / "thumbnail.svg",
                          thumbnail_svg(measures.model(), measures.last_frame(), measures.mechanism()));
    record::check_computation(record);
    write_file_atomically(folder_ / "run.json", run_json(result_, run_input(plan_)));
    return TaskOutcome::done;
  }

  RunResult& result() { return result_; }
  void set_horizontal(std::vector<loading::HorizontalMeasures> measures) {
    horizontal_ = std::move(measures);
  }

 private:
  const Plan& plan_;
  fs::path folder_;
  RunResult result_;
  std::vector<loading::HorizontalMeasures> horizontal_;  ///< of the motions
};

bool enough_without(const fs::path& directory, const Plan& plan, int realization) {
  if (!plan.until || realization < plan.until->minimum) return false;
  const StudyFiles files = read_study_files(directory, plan, realization);
  return files.enough && *files.enough <= realization;
}

}  // namespace

namespace {

simulation::RunSetup setup_of(const Plan& plan, const PlannedRun& run, const scenario::Scenario& scenario) {
  simulation::RunSetup setup = scenario::build_setup(scenario, run.realization);
  setup.version = plan.version;
  if (plan.keep == Keep::measures) {
    setup.output.frame_interval = setup.output.contact_interval = never;
    setup.histories.clear();
  }
  return setup;
}

}  // namespace

simulation::RunSetup run_setup(const Plan& plan, const PlannedRun& run) {
  return setup_of(plan, run, scenario_of(plan, run));
}

TaskOutcome run_task(const fs::path& directory, const Plan& plan, std::size_t index,
                     const TaskOptions& options) {
  const PlannedRun& run = plan.runs.at(index);
  if (!run.wanted) return TaskOutcome::not_asked;
  const fs::path folder = make_run_folder(directory, run.key);
  const FileLock lock(folder / "lock");
  if (!lock.held()) throw RunError(fmt::format("{}: {} is at this run", run.key, lock.holder()));
  if (read_run_state(directory, plan, run).kind == RunState::Kind::done) return TaskOutcome::was_done;
  if (enough_without(directory, plan, run.realization)) return TaskOutcome::not_asked;
  clean_run_folder(folder);
  Task task(directory, plan, run);
  const auto failed = [&](const std::exception& reason) {
    task.result().error = reason.what();
    write_failure(directory, plan, task.result());
  };
  try {
    const scenario::Scenario scenario = scenario_of(plan, run);
    task.set_horizontal(scenario::horizontal_measures(scenario));
    simulation::RunSetup setup = setup_of(plan, run, scenario);
    setup.hooks = options.hooks;
    const TaskOutcome outcome = task.run(setup, options);
    if (outcome == TaskOutcome::interrupted) {
      clean_run_folder(folder);
    } else {
      std::error_code ignored;
      fs::remove(folder / "lock", ignored);
    }
    return outcome;
  } catch (const std::exception& reason) {
    try {
      failed(reason);
    } catch (const RunError&) {  // a full disk: the first failure is the one to be told about
    }
    throw;
  }
}

}  // namespace keyblock::study
