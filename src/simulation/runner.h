#pragma once
#include <chrono>
#include <optional>

#include "core/parallel.h"
#include "core/profile.h"
#include "dynamics/step.h"
#include "record/record.h"
#include "simulation/checkpoint.h"
#include "simulation/control.h"
#include "simulation/damage.h"
#include "simulation/order_control.h"
#include "simulation/progress_meter.h"
#include "simulation/reporter.h"
#include "simulation/run_options.h"
#include "simulation/setup.h"
#include "simulation/stage_at_hand.h"
#include "simulation/stage_outlook.h"
#include "simulation/staged_opening.h"

namespace keyblock::simulation {

/// What a call of Runner::advance did.
struct Advance {
  bool took_step = false;       ///< false: nothing was left of the stage, or `stop` was set
  bool ended_stage = false;     ///< the stage was recorded, and a checkpoint written
  dynamics::StepReport report;  ///< of the step, if one was taken
};

/// A run of all stages of a setup, step by step. `run()` is the loop over it:
///
///     Runner runner(setup, options, observer);
///     while (!runner.done()) runner.advance();
///     const RunRecord record = runner.finish();
///
/// Between two steps, and in RunOptions::after_step, the state, the model and the contacts can be read. The setup and the observer must
/// outlive the runner. One thread calls it; the runner has its own team for the work of a step.
class Runner {
 public:
  /// Builds the model, or reads the checkpoint, and tells the observer so (begin, resume). Throws InputError for a model that cannot be
  /// built and for a checkpoint of another run; RunError where rock or joints yield without limit.
  Runner(const RunSetup& setup, RunOptions options, record::RunObserver& observer);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  ~Runner() = default;

  /// One step of the plan. The first step of a stage also begins it: excavation, first frame. The last one also ends it: records,
  /// checkpoint. Does nothing when the run is done. Throws RunError when the run cannot go on; the observer has then received end(), and
  /// the run is done.
  Advance advance();
  /// All stages have ended, `stop` is set and its stage recorded, or the run has failed or was finished.
  [[nodiscard]] bool done() const;
  /// Ends the run where it is: a stage that has begun is recorded as interrupted, and the observer receives end(). Calls after the first
  /// give the same record. A later run with RunOptions::resume goes on from the last checkpoint.
  record::RunRecord finish();

  [[nodiscard]] const dynamics::State& state() const { return now_.mechanics; }
  [[nodiscard]] const dynamics::Model& model() const { return model_; }
  /// Contacts with their forces, as the last step left them. There are none before the first step of this runner, and after a change of the
  /// orders of blocks.
  [[nodiscard]] std::size_t contact_count() const { return stepper_->force_count(); }
  /// The contacts of the last step, some at a time.
  void each_contact(const record::TakeContacts& take, record::ContactParts parts = {}) const {
    reporter_.recorder().each_contact(*stepper_, take, parts);
  }
  [[nodiscard]] record::Energy energy() const;
  /// Measures of damage so far, without a look of the run's own; none before the first excavation.
  [[nodiscard]] std::optional<record::Damage> damage() const;
  [[nodiscard]] std::vector<record::BlockStatus> status() const;
  /// m/s², of the ground at the time of the state; zero outside of shaking stages.
  [[nodiscard]] Vec2 ground_acceleration() const;
  /// Changes the running model: between two steps, or in RunOptions::after_step.
  [[nodiscard]] Control control() {
    return {setup_, planned_stage(), model_, now_.mechanics, *stepper_, now_.control};
  }
  /// Index of the stage at hand, or of the one that comes next.
  [[nodiscard]] int stage() const { return now_.stage; }

 private:
  /// The stage at hand, or the one that comes next; the last one when the run is done.
  [[nodiscard]] const record::Stage& planned_stage() const;
  void begin();
  void resume();
  void orders_changed();
  bool change_orders(bool (OrderControl::*change)(dynamics::Model&, dynamics::State&));
  void begin_stage();
  void begin_settling();
  void begin_waiting(bool is_new);
  bool take_step(dynamics::StepReport& report);
  StageOutlook static_step(dynamics::StepReport& report);
  StageOutlook dynamic_step(dynamics::StepReport& report);
  void after_step(const dynamics::StepReport& report, const StageOutlook& outlook);
  [[nodiscard]] bool stage_is_over() const;
  void end_stage();
  /// Of an equilibrium that is not stable, the block that goes farthest; −1: it is stable.
  [[nodiscard]] int find_unstable_block(const std::vector<bool>& which_move);
  void checkpoint();
  void end();
  template <typename Work>
  void end_if_it_fails(const Work& work);

  const RunSetup& setup_;
  RunOptions options_;
  record::RunObserver& observer_;
  ThreadTeam team_;
  Profile profile_;
  dynamics::Model model_;
  DamageGauge gauge_;
  Reporter reporter_;
  ProgressMeter progress_;
  OrderControl orders_;
  StagedOpening opening_;
  std::optional<dynamics::Stepper> stepper_;
  RunState now_;
  std::optional<StageAtHand> stage_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double wall_before_ = 0.0;     ///< s of wall time, of the runs that this one goes on from
  bool is_within_step_ = false;  ///< the run was stopped there: contacts are not those of the state
  bool ended_ = false;           ///< the observer has received end()
};

}  // namespace keyblock::simulation
