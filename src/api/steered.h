#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "keyblock/simulation.h"
#include "record/record.h"
#include "simulation/runner.h"

namespace keyblock::api {

/// A Simulation of a run that somebody else takes step by step.
class Steered {
 public:
  Steered() = default;
  Steered(const Steered&) = delete;
  Steered& operator=(const Steered&) = delete;
  /// The simulation may outlive the run: it can then do nothing more.
  ~Steered();

  /// Is told of the model.
  [[nodiscard]] std::unique_ptr<record::RunObserver> observer();
  /// The simulation, of which `runner` has just taken a step.
  Simulation& of(simulation::Runner& runner);
  [[nodiscard]] bool was_stopped() const;

 private:
  record::ModelRecord model_;
  std::shared_ptr<Simulation> simulation_;
};

}  // namespace keyblock::api
