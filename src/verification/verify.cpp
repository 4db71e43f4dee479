#include "verification/verify.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "core/error.h"
#include "scenario/parse.h"

namespace keyblock::verification {
namespace {

/// A case while its simulations run. Outcomes are dropped as soon as its rows are made.
struct Work {
  CaseResult result;
  std::vector<SolvedRun> runs;
  std::size_t left = 0;  ///< simulations
};

struct Job {
  std::size_t work = 0, run = 0, simulation = 0;
};

bool is_wanted(const RunSpec& run, const Simulation& simulation, const std::set<int>& orders) {
  if (orders.empty()) return true;
  if (!run.builtin.empty()) return false;
  const int order = simulation.order
                        ? *simulation.order
                        : scenario::parse_scenario(run.scenario, simulation.overrides).rock.order.value_or(1);
  return orders.contains(order);
}

class Verifier {
 public:
  Verifier(const std::vector<CaseFile>& cases, const VerifyOptions& options, const VerifyProgress& progress)
      : options_(options), progress_(progress) {
    for (const CaseFile& file : cases) plan(file);
  }

  std::vector<CaseResult> run() {
    std::vector<std::thread> threads;
    const auto count =
        std::min<std::size_t>(static_cast<std::size_t>(std::max(1, options_.workers)), jobs_.size());
    for (std::size_t k = 1; k < count; ++k) threads.emplace_back([this] { work(); });
    work();
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    std::vector<CaseResult> results;
    for (Work& work : work_) results.push_back(std::move(work.result));
    return results;
  }

 private:
  void plan(const CaseFile& file) {
    Work work;
    work.result.file = &file;
    for (const RunSpec& spec : file.runs) {
      if ((file.is_long || spec.is_long) && !options_.all) continue;
      SolvedRun run;
      run.spec = &spec;
      for (Simulation& simulation : simulations(spec)) {
        if (is_wanted(spec, simulation, options_.orders)) run.simulations.push_back(std::move(simulation));
      }
      if (run.simulations.empty()) continue;
      run.outcomes.resize(run.simulations.size());
      for (std::size_t k = 0; k < run.simulations.size(); ++k) {
        jobs_.push_back({work_.size(), work.runs.size(), k});
      }
      work.left += run.simulations.size();
      work.runs.push_back(std::move(run));
    }
    work_.push_back(std::move(work));
  }

  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  void work() {
    for (;;) {
      const std::size_t next = next_++;
      if (next >= jobs_.size() || failed_.load()) return;
      try {
        if (stopped()) throw RunError("interrupted");
        do_job(jobs_[next]);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        failed_ = true;
      }
    }
  }

  void do_job(const Job& job) {
    Work& work = work_[job.work];
    SolvedRun& run = work.runs[job.run];
    Outcome outcome = simulate(*run.spec, run.simulations[job.simulation], options_.version, options_.stop);
    if (stopped()) throw RunError("interrupted");
    const std::lock_guard lock(mutex_);
    work.result.wall_time += outcome.wall_time;
    run.outcomes[job.simulation] = std::move(outcome);
    ++done_;
    if (progress_) progress_(done_, jobs_.size(), *work.result.file, *run.spec);
    if (--work.left > 0) return;
    work.result.rows = make_rows(work.runs);
    work.runs.clear();
  }

  const VerifyOptions& options_;
  const VerifyProgress& progress_;
  std::vector<Work> work_;
  std::vector<Job> jobs_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

int CaseResult::failed() const {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.pass; }));
}

std::vector<CaseResult> verify(const std::vector<CaseFile>& cases, const VerifyOptions& options,
                               const VerifyProgress& progress) {
  return Verifier(cases, options, progress).run();
}

}  // namespace keyblock::verification
