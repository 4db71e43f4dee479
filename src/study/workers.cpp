#include "study/workers.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <list>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "study/folder.h"
#include "study/process.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int poll_milliseconds = 200;
constexpr auto report_interval = std::chrono::milliseconds(100);
constexpr std::size_t log_lines = 3;     // of a failed run that are told
constexpr double settle_weight = 300.0;  // steps that a settling stage is taken for

std::string last_lines(const fs::path& log) {
  std::ifstream in(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) lines.push_back(line);
    if (lines.size() > log_lines) lines.erase(lines.begin());
  }
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " | ") + line;
  return text;
}

class Workers {
 public:
  Workers(const fs::path& directory, const Plan& plan, StudyFiles& files, const WorkerOptions& options)
      : directory_(directory), plan_(plan), files_(files), options_(options) {
    // A run that failed before counts as missing until it has been tried again; that may make more realizations necessary.
    forget_failures(directory, plan, files);
    for (std::size_t k = 0; k < plan.runs.size(); ++k) {
      if (!files.asked(plan.runs[k])) continue;
      if (files.states[k].kind == RunState::Kind::done) {
        ++outcome_.before;
      } else {
        pending_.push_back(k);
        files.states[k] = {};
      }
    }
    // Values that were added to the plan stand behind those it had.
    std::stable_sort(pending_.begin(), pending_.end(), [&](std::size_t a, std::size_t b) {
      return plan.runs[a].realization < plan.runs[b].realization;
    });
  }

  WorkerOutcome run() {
    report("", "");
    while (true) {
      const bool stopping = options_.stop != nullptr && options_.stop->load();
      if (stopping && !interrupted_) interrupt();
      if (!stopping) start_runs();
      if (running_.empty()) break;
      wait();
      finish_runs();
      if (Clock::now() - last_report_ >= report_interval) report("", "");
    }
    outcome_.interrupted = interrupted_;
    return std::move(outcome_);
  }

 private:
  struct Running {
    std::size_t index;
    ChildProcess process;
    double fraction = 0.0;
  };

  void start_runs() {
    while (static_cast<int>(running_.size()) < options_.workers && next_ < pending_.size()) {
      const std::size_t k = pending_[next_];
      if (!files_.asked(plan_.runs[k])) {  // enough by now
        ++next_;
        continue;
      }
      const fs::path folder = make_run_folder(directory_, plan_.runs[k].key);
      std::vector<std::string> command = options_.command;
      for (const std::string& word :
           {directory_.string(), std::to_string(k), std::string("--progress-descriptor"), std::string("{}")})
        command.push_back(word);
      running_.push_back({k, ChildProcess(command, folder / "log.txt")});
      ++next_;
    }
  }

  void interrupt() {
    interrupted_ = true;
    for (const Running& run : running_) run.process.interrupt();
  }

  // Until a run tells something or ends (its pipe is then closed), or for a while.
  void wait() {
    std::vector<pollfd> pipes;
    for (const Running& run : running_) pipes.push_back({run.process.pipe(), POLLIN, 0});
    ::poll(pipes.data(), pipes.size(), poll_milliseconds);
    for (Running& run : running_) {
      double fraction = 0.0;
      while (::read(run.process.pipe(), &fraction, sizeof(fraction)) == sizeof(fraction))
        run.fraction = fraction;
    }
  }

  // What comes next runs before it is told.
  void finish_runs() {
    std::vector<std::pair<std::string, std::string>> ended;
    for (auto run = running_.begin(); run != running_.end();) {
      const std::optional<std::string> end = run->process.poll();
      if (!end) {
        ++run;
        continue;
      }
      const std::size_t k = run->index;
      run = running_.erase(run);
      if (const auto failure = finish(k, *end)) ended.emplace_back(plan_.runs[k].key, *failure);
    }
    if (ended.empty()) return;
    if (options_.stop == nullptr || !options_.stop->load()) start_runs();
    for (const auto& [key, failure] : ended) report(key, failure);
  }

  /// Why it failed, empty where it did not; nothing where there is nothing to tell.
  std::optional<std::string> finish(std::size_t k, const std::string& end) {
    const PlannedRun& run = plan_.runs[k];
    RunState& state = files_.states[k];
    state = read_run_state(directory_, plan_, run);
    if (state.kind != RunState::Kind::done) read_running();
    update_enough(plan_, files_);
    if (!files_.asked(run) && state.kind != RunState::Kind::done) return std::nullopt;
    if (state.kind == RunState::Kind::done) {
      ++outcome_.done;
    } else if (interrupted_) {
      return std::nullopt;  // begins anew the next time
    } else {
      note_failure(k, end);
      outcome_.failed.push_back(run.key + ": " + state.problem);
      update_enough(plan_, files_);
    }
    return state.kind == RunState::Kind::done ? "" : state.problem;
  }

  // A run that ended without a result may have found enough realizations in the folder: with that of another, which has written it
  // but has not been seen to end.
  void read_running() {
    for (const Running& other : running_)
      files_.states[other.index] = read_run_state(directory_, plan_, plan_.runs[other.index]);
  }

  // The run itself may have said why; one that was killed has not.
  void note_failure(std::size_t k, const std::string& end) {
    const PlannedRun& run = plan_.runs[k];
    RunState& state = files_.states[k];
    if (state.kind == RunState::Kind::failed && state.result.error == state.problem) return;
    const std::string said = last_lines(run_folder(directory_, run.key) / "log.txt");
    state.result = empty_result(run);
    state.result.error = (end.empty() ? "ended without a result" : end) + (said.empty() ? "" : "; " + said);
    state.problem = state.result.error;
    state.kind = RunState::Kind::failed;
    write_failure(directory_, plan_, state.result);
  }

  void report(const std::string& finished, const std::string& failure) {
    last_report_ = Clock::now();
    StudyProgress progress;
    progress.done = outcome_.before + outcome_.done;
    progress.failed = outcome_.failed.size();
    progress.running = running_.size();
    std::size_t waiting = 0;
    for (std::size_t n = next_; n < pending_.size(); ++n) waiting += files_.asked(plan_.runs[pending_[n]]);
    progress.total = progress.done + progress.failed + progress.running + waiting;
    double parts = 0.0;
    for (const Running& run : running_) parts += run.fraction;
    const auto ended = static_cast<double>(progress.done + progress.failed);
    progress.fraction = progress.total == 0 ? 1.0 : (ended + parts) / static_cast<double>(progress.total);
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    const double here = static_cast<double>(outcome_.done + outcome_.failed.size()) + parts;
    if (here > 0.0) {
      const double left = static_cast<double>(waiting + progress.running) - parts;
      progress.seconds_left = left * elapsed / here;
    }
    progress.finished = finished;
    progress.failure = failure;
    options_.report(progress);
  }

  const fs::path& directory_;
  const Plan& plan_;
  StudyFiles& files_;
  const WorkerOptions& options_;
  std::vector<std::size_t> pending_;  // indices of runs to be done
  std::size_t next_ = 0;              // of pending_
  std::list<Running> running_;
  WorkerOutcome outcome_;
  bool interrupted_ = false;
  Clock::time_point start_ = Clock::now(), last_report_;
};

}  // namespace

WorkerOutcome run_workers(const fs::path& directory, const Plan& plan, StudyFiles& files,
                          const WorkerOptions& options) {
  return Workers(directory, plan, files, options).run();
}

ProgressPipe::ProgressPipe(int descriptor, const simulation::RunSetup& setup)
    : descriptor_(descriptor), weight_before_{0.0} {
  for (const record::Stage& stage : setup.stages) {
    double steps = settle_weight;
    if (stage.kind != record::StageKind::settle) {
      const double duration =
          stage.duration.value_or(stage.motion < 0 ? 0.0 : setup.motions.at(at(stage.motion)).duration());
      steps = duration / setup.time_step;
    }
    weight_before_.push_back(weight_before_.back() + steps);
  }
}

void ProgressPipe::progress(const record::Progress& progress) {
  const auto k = at(progress.stage);
  const double weight = weight_before_[k] + progress.fraction * (weight_before_[k + 1] - weight_before_[k]);
  const double fraction = weight / weight_before_.back();
  // A parent that does not read, or is no more, does not matter.
  static_cast<void>(::write(descriptor_, &fraction, sizeof(fraction)) > 0);
}

}  // namespace keyblock::study
