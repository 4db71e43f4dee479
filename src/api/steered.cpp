#include "api/steered.h"

#include <utility>

#include "api/simulation_parts.h"

namespace keyblock::api {

struct SimulationAccess {
  static std::shared_ptr<Simulation> make(const record::ModelRecord& model) {
    auto parts = std::make_unique<Simulation::Parts>();
    parts->stepping = true;  // by somebody else, all the time
    parts->listener.model = model;
    parts->warnings = model.warnings;
    return std::shared_ptr<Simulation>(new Simulation(std::move(parts)));
  }
  static void put(Simulation& simulation, simulation::Runner* runner) {
    simulation.parts_->borrowed = runner;
  }
  static bool was_stopped(const Simulation& simulation) { return simulation.parts_->stop; }
};

namespace {

class ModelKeeper final : public record::RunObserver {
 public:
  explicit ModelKeeper(record::ModelRecord& model) : model_(model) {}
  void begin(const record::ModelRecord& model) override { model_ = model; }

 private:
  record::ModelRecord& model_;
};

}  // namespace

Steered::~Steered() {
  if (simulation_) SimulationAccess::put(*simulation_, nullptr);
}

std::unique_ptr<record::RunObserver> Steered::observer() {
  return std::make_unique<ModelKeeper>(model_);
}

Simulation& Steered::of(simulation::Runner& runner) {
  if (!simulation_) simulation_ = SimulationAccess::make(model_);
  SimulationAccess::put(*simulation_, &runner);
  return *simulation_;
}

bool Steered::was_stopped() const {
  return simulation_ && SimulationAccess::was_stopped(*simulation_);
}

}  // namespace keyblock::api
