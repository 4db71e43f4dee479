#pragma once
#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "job/recorded_run.h"
#include "keyblock/simulation.h"
#include "scenario/scenario.h"
#include "simulation/runner.h"

namespace keyblock {

/// What a Simulation holds.
struct Simulation::Parts {
  Parts() = default;
  /// Passes progress on and keeps what summary.json is made of.
  class Listener final : public record::RunObserver {
   public:
    void begin(const record::ModelRecord& record) override { model = record; }
    void progress(const record::Progress& now) override {
      if (!call) return;
      call({now.stage, now.stage_count, now.stage_name, now.fraction, now.time, now.step, now.seconds_left});
    }

    record::ModelRecord model;
    std::function<void(const Progress&)> call;
  };

  Parts(const Scenario& of, const RunOptions& options);

  [[nodiscard]] simulation::Runner& runner() {
    if (recorded) return recorded->runner();
    if (alone) return *alone;
    if (borrowed == nullptr) throw std::logic_error("the run has ended");
    return *borrowed;
  }
  simulation::RunOptions run_options(const RunOptions& options);
  /// An exception of a caller's function stops the run, which ends in good order; advance() throws it then.
  template <typename Call>
  void keep_failure(const Call& call) {
    try {
      call();
    } catch (...) {
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  }

  /// While it lives, a step is taken: what would begin another one is refused.
  class Stepping {
   public:
    explicit Stepping(Parts& of) : of_(of) {
      if (of_.stepping) throw std::logic_error("the simulation is within a step");
      of_.stepping = true;
    }
    ~Stepping() { of_.stepping = false; }
    Stepping(const Stepping&) = delete;
    Stepping& operator=(const Stepping&) = delete;

   private:
    Parts& of_;
  };

  bool stepping = false;
  bool closed = false;  ///< it goes on no more
  scenario::Scenario scenario;
  std::vector<std::string> warnings;
  simulation::RunSetup setup;
  Listener listener;
  std::atomic<bool> stop = false;
  std::function<void()> after_step;
  std::function<void(const Progress&)> progress;
  std::exception_ptr failure;
  std::optional<job::RecordedRun> recorded;  ///< of a run with a folder
  std::optional<simulation::Runner> alone;   ///< of a run without one
  simulation::Runner* borrowed = nullptr;    ///< of a run that somebody else steps
  std::string summary;                       ///< once it is finished
};

}  // namespace keyblock
