#include "keyblock/study.h"

#include <atomic>
#include <utility>

#include "api/steered.h"
#include "core/error.h"
#include "keyblock/keyblock.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/limit_search.h"
#include "study/plan.h"
#include "study/plan_json.h"
#include "study/task.h"
#include "study/workers.h"

namespace keyblock {

namespace {

study::ScenarioText text_of(const Scenario& scenario) {
  return {scenario.text(), scenario.file(),
          scenario.is_made() ? std::vector<std::string>{} : scenario.changes()};
}

study::WorkerOptions options_of(const Workers& workers, std::atomic<bool>& stop) {
  study::WorkerOptions options;
  options.workers = workers.count;
  options.command = workers.command;
  options.stop = &stop;
  options.report = [&](const study::StudyProgress& now) {
    if (workers.progress && !workers.progress(now.done + now.failed, now.total)) stop = true;
  };
  return options;
}

}  // namespace

std::vector<std::string> plan_study(const Scenario& scenario, const std::filesystem::path& folder,
                                    bool resume) {
  std::vector<std::string> warnings;
  study::Plan plan = study::make_plan(text_of(scenario), version(), &warnings);
  const auto lock = study::lock_study(folder);
  study::enter_plan(folder, plan, resume);
  study::StudyFiles files = study::read_study_files(folder, plan);
  study::forget_failures(folder, plan, files);
  return warnings;
}

StudyState study_state(const std::filesystem::path& folder) {
  const study::Plan plan = study::read_plan(folder);
  const study::StudyFiles files = study::read_study_files(folder, plan);
  StudyState state;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (!files.asked(plan.runs[k])) continue;
    ++state.runs;
    switch (files.states[k].kind) {
      case study::RunState::Kind::missing:
      case study::RunState::Kind::damaged:
        state.missing.push_back(k);
        break;
      case study::RunState::Kind::failed:
        state.failures.push_back(plan.runs[k].key + ": " + files.states[k].result.error);
        break;
      case study::RunState::Kind::done:
        break;
    }
  }
  return state;
}

namespace {

void check_run(const std::filesystem::path& folder, const study::Plan& plan, std::size_t run) {
  if (run < plan.runs.size()) return;
  Diagnostic diagnostic;
  diagnostic.where.file = folder.string();
  diagnostic.found = "run " + std::to_string(run);
  diagnostic.expected = "a run of the plan, less than " + std::to_string(plan.runs.size());
  throw InputError(std::move(diagnostic));
}

}  // namespace

void run_of_study(const std::filesystem::path& folder, std::size_t run) {
  const study::Plan plan = study::read_plan(folder);
  check_run(folder, plan, run);
  study::run_task(folder, plan, run, {});
}

void run_of_study(const std::filesystem::path& folder, std::size_t run,
                  const std::vector<std::pair<std::string, std::string>>& hooks,
                  const std::function<void(Simulation&)>& steer) {
  const study::Plan plan = study::read_plan(folder);
  check_run(folder, plan, run);
  api::Steered steered;
  study::TaskOptions options;
  options.hooks = hooks;
  options.observers = [&](const simulation::RunSetup&) {
    std::vector<std::unique_ptr<record::RunObserver>> observers;
    observers.push_back(steered.observer());
    return observers;
  };
  options.after_step = [&](simulation::Runner& runner, const dynamics::StepReport&) {
    steer(steered.of(runner));
    if (steered.was_stopped())
      throw RunError("a controller has stopped the run, which a study has no results of");
  };
  study::run_task(folder, plan, run, options);
}

void note_failed_run(const std::filesystem::path& folder, std::size_t run, const std::string& why) {
  const study::Plan plan = study::read_plan(folder);
  check_run(folder, plan, run);
  if (study::read_run_state(folder, plan, plan.runs[run]).kind == study::RunState::Kind::done) return;
  study::make_run_folder(folder, plan.runs[run].key);
  study::RunResult result = study::empty_result(plan.runs[run]);
  result.error = why;
  study::write_failure(folder, plan, result);
}

void run_study(const std::filesystem::path& folder, const Workers& workers) {
  const study::Plan plan = study::read_plan(folder);
  const auto lock = study::lock_study(folder);
  study::StudyFiles files = study::read_study_files(folder, plan);
  std::atomic<bool> stop = false;
  study::run_workers(folder, plan, files, options_of(workers, stop));
}

std::string find_limit(const Scenario& scenario, const std::filesystem::path& folder,
                       const LimitRequest& request, const Workers& workers) {
  study::LimitRequest asked;
  asked.key = request.key;
  asked.from = request.from;
  asked.to = request.to;
  asked.since = request.since;
  asked.tolerance = request.tolerance;
  asked.realizations = request.realizations;
  asked.scan = request.scan;
  study::Plan plan = study::plan_limit(text_of(scenario), version(), asked, request.until, request.above);
  const auto lock = study::lock_study(folder);
  std::atomic<bool> stop = false;
  study::LimitOptions options;
  options.resume = request.resume;
  options.workers = options_of(workers, stop);
  bool interrupted = false;
  const study::LimitResult result = study::find_limit(folder, std::move(plan), asked, options, interrupted);
  if (interrupted) throw RunError("the search was stopped; it can be resumed");
  for (const study::RealizationLimit& limit : result.realizations) {
    if (!limit.error.empty()) throw RunError("a run of the search has failed: " + limit.error);
  }
  return study::limit_json(result);
}

void collect_study(const std::filesystem::path& folder) {
  study::collect(folder);
}

}  // namespace keyblock
