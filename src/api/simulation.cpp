#include "keyblock/simulation.h"

#include <stdexcept>
#include <utility>

#include "api/scenario_source.h"
#include "api/simulation_parts.h"
#include "core/out_of_memory.h"
#include "keyblock/keyblock.h"
#include "record/computation_errors.h"
#include "results/summary.h"
#include "scenario/build.h"
#include "simulation/feasibility.h"
#include "simulation/refuse.h"

namespace keyblock {
namespace {

using simulation::refuse;

job::ResultFolder::Use use_of(const RunOptions& options) {
  if (options.resume) return job::ResultFolder::Use::resume;
  return options.replace ? job::ResultFolder::Use::replace : job::ResultFolder::Use::fresh;
}

void check(const RunOptions& options) {
  if (options.threads < 1 || options.threads > 1024)
    refuse("threads", std::to_string(options.threads), "a whole number from 1 to 1024");
  if (options.realization < 0)
    refuse("realization", std::to_string(options.realization), "a whole number, at least 0");
  if (options.resume && options.replace) refuse("resume", "resume and replace together", "one of them");
  if (options.resume && options.folder.empty()) refuse("resume", "no folder", "the folder of the run");
}

}  // namespace

simulation::RunOptions Simulation::Parts::run_options(const RunOptions& options) {
  simulation::RunOptions run;
  run.threads = options.threads;
  run.stop = &stop;
  run.after_step = [this](simulation::Runner&, const dynamics::StepReport&) {
    if (after_step) keep_failure(after_step);
  };
  return run;
}

Simulation::Parts::Parts(const Scenario& of, const RunOptions& options) : scenario(api::parsed(of)) {
  check(options);
  setup = scenario::build_setup(scenario, options.realization, &warnings);
  setup.version = version();
  setup.hooks = options.hooks;
  listener.call = [this](const Progress& now) {
    if (progress) keep_failure([&] { progress(now); });
  };
  if (options.folder.empty()) {
    with_memory_for([&] { return simulation::memory_purpose(setup); },
                    [&] { alone.emplace(setup, run_options(options), listener); });
    return;
  }
  recorded.emplace(scenario, setup,
                   job::RecordedRun::Options{options.folder, use_of(options), run_options(options)},
                   listener);
  if (recorded->has_ended())
    refuse("resume", "a run that has ended", "a run that was stopped; its results are in the folder");
  recorded->start();
}

Simulation::Simulation(const Scenario& scenario, const RunOptions& options)
    : parts_(std::make_unique<Parts>(scenario, options)) {}
Simulation::Simulation(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

bool Simulation::advance() {
  const Parts::Stepping now(*parts_);
  if (parts_->runner().done()) return false;
  if (parts_->closed) throw std::logic_error("the simulation was closed");
  if (parts_->recorded) {
    parts_->recorded->advance();
  } else {
    parts_->alone->advance();
  }
  if (parts_->failure) std::rethrow_exception(std::exchange(parts_->failure, nullptr));
  return !parts_->runner().done();
}

bool Simulation::done() const {
  return parts_->runner().done();
}

std::string Simulation::finish() {
  if (!parts_->summary.empty()) return parts_->summary;
  const Parts::Stepping now(*parts_);
  if (parts_->closed) throw std::logic_error("the simulation was closed");
  parts_->closed = true;
  const record::RunRecord record = parts_->recorded ? parts_->recorded->finish() : parts_->alone->finish();
  parts_->summary = results::summary_json(parts_->listener.model, record);
  record::check_computation(record);
  return parts_->summary;
}

void Simulation::close() {
  const Parts::Stepping now(*parts_);
  parts_->closed = true;
  if (parts_->recorded) parts_->recorded->close();
}

void Simulation::stop() noexcept {
  parts_->stop = true;
}

void Simulation::after_step(std::function<void()> call) {
  parts_->after_step = std::move(call);
}

void Simulation::on_progress(std::function<void(const Progress&)> call) {
  parts_->progress = std::move(call);
}

std::string run(const Scenario& scenario, const RunOptions& options,
                const std::function<bool(const Progress&)>& progress) {
  Simulation simulation(scenario, options);
  if (progress) {
    simulation.on_progress([&](const Progress& now) {
      if (!progress(now)) simulation.stop();
    });
  }
  while (simulation.advance()) {
  }
  return simulation.finish();
}

const char* version() {
  return KEYBLOCK_VERSION;
}

}  // namespace keyblock
