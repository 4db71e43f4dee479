#pragma once
#include <vector>

#include "dynamics/step.h"
#include "record/record.h"
#include "simulation/damage.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Opens excavations in parts, and holds walls by support pressure: what of State::walls changes from stage to stage. The forces of rock
/// that is excavated are released in Stage::release_steps equal parts, each when the one before has come to equilibrium. What blocks that
/// have left the wall feel ends for good: those that have moved by more than the distance of a fall, and, as a part has come to
/// equilibrium, those that no contact presses any more.
class StagedOpening {
 public:
  StagedOpening(const RunSetup& setup, const dynamics::Model& model) : setup_(setup), model_(model) {}

  /// Of the run, before its first step.
  void start(dynamics::State& state) const;
  /// Before the rock of a stage is taken out, what it does to the rest.
  void keep_forces(const record::Stage& stage, dynamics::State& state, dynamics::Stepper& stepper) const;
  /// Afterwards: the first part is released, and pressures are those of the stage.
  void begin_stage(int stage, dynamics::State& state);
  /// At equilibrium: drops the loads of blocks that nothing presses or, without such, releases the next part. False where nothing is left to
  /// do.
  bool go_on(const record::Stage& stage, dynamics::State& state, const dynamics::Stepper& stepper);
  /// After a step.
  void drop_moved(const DamageGauge& gauge, dynamics::State& state) const;
  /// The curve of the stage.
  std::vector<record::ReleasePoint> end_stage(const dynamics::State& state);

  struct Memory {
    int part = 0;                ///< of the stage at hand, 1 … release_steps
    std::vector<double> before;  ///< per excavation: WallState::released as the stage began
    std::vector<std::vector<Vec2>>
        start;  ///< of each that is opened in parts: ends of the faces of its wall then
    std::vector<record::ReleasePoint> points;  ///< of the stage at hand
  };
  /// All that is remembered, for checkpoints.
  [[nodiscard]] Memory& memory() { return memory_; }

 private:
  [[nodiscard]] bool is_used(const dynamics::State& state) const { return !state.walls.left.empty(); }
  [[nodiscard]] int parts(const record::Stage& stage) const;
  void release(const record::Stage& stage, dynamics::State& state) const;
  void record(int excavation, const dynamics::State& state);
  void record_all(const dynamics::State& state);
  /// Whether there was one that felt its loads until now.
  bool drop_free(dynamics::State& state, const dynamics::Stepper& stepper) const;

  const RunSetup& setup_;
  const dynamics::Model& model_;
  Memory memory_;
};

}  // namespace keyblock::simulation
