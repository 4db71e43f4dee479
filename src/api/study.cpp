#include "keyblock/study.h"

#include "core/error.h"
#include "core/folder.h"
#include "core/read_file.h"
#include "keyblock/keyblock.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/plan.h"
#include "study/plan_json.h"
#include "study/task.h"

namespace keyblock {

std::vector<std::string> plan_study(const Scenario& scenario, const std::filesystem::path& folder,
                                    bool resume) {
  if (scenario.is_made() || !file_exists(scenario.file()) || read_file(scenario.file()) != scenario.text()) {
    Diagnostic diagnostic;
    diagnostic.where.file = scenario.file().string();
    diagnostic.found = "a scenario that is not in a file";
    diagnostic.expected = "one that was loaded from a file, which tasks read again";
    diagnostic.hint = "save it and load it";
    throw InputError(std::move(diagnostic));
  }
  std::vector<std::string> warnings;
  study::Plan plan = study::make_plan(scenario.file(), scenario.changes(), version(), &warnings);
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

void run_of_study(const std::filesystem::path& folder, std::size_t run) {
  const study::Plan plan = study::read_plan(folder);
  if (run >= plan.runs.size()) {
    Diagnostic diagnostic;
    diagnostic.where.file = folder.string();
    diagnostic.found = "run " + std::to_string(run);
    diagnostic.expected = "a run of the plan, less than " + std::to_string(plan.runs.size());
    throw InputError(std::move(diagnostic));
  }
  study::run_task(folder, plan, run, {});
}

void collect_study(const std::filesystem::path& folder) {
  study::collect(folder);
}

}  // namespace keyblock
