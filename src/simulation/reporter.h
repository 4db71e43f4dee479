#pragma once
#include <span>
#include <vector>

#include "core/profile.h"
#include "dynamics/step.h"
#include "record/record.h"
#include "simulation/checkpoint.h"
#include "simulation/damage.h"
#include "simulation/recorder.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Gives an observer the records of a run and counts them (RunState::reported). After a step it gives those that are due then:
///
/// | record | dynamic stages | static stages |
/// |---|---|---|
/// | frame | every OutputOptions::frame_interval | every settle_frame_interval steps |
/// | contacts | every contact_interval | |
/// | history | every history_interval | every step |
/// | step | every 0.02 s, with a look at damage | every as many steps |
///
/// It also measures true overlaps every second of a dynamic stage (RunRecord::max_overlap).
class Reporter {
 public:
  /// Throws InputError when a history point lies in no block.
  Reporter(const RunSetup& setup, const dynamics::Model& model, DamageGauge& gauge,
           record::RunObserver& observer, Profile& profile, int threads)
      : setup_(setup),
        model_(model),
        gauge_(gauge),
        observer_(observer),
        profile_(profile),
        recorder_(setup, model, gauge, threads) {}

  [[nodiscard]] const Recorder& recorder() const { return recorder_; }
  /// Brings what depends on the orders of blocks up to date.
  void orders_changed() { recorder_.orders_changed(); }

  void frame(RunState& now);
  void contacts(RunState& now, const dynamics::Stepper& stepper);
  void measure_overlap(RunState& now);
  /// What broke in a step: joints, and elements by their numbers.
  void breaks(RunState& now, std::span<const dynamics::JointBreak> joints, std::span<const int> elements);

  /// Before a dynamic step: keeps what records of the time after it need.
  void before_step(const RunState& now);
  /// What is due after a step. ends_stage: frames, contacts and overlap are left to the end of the stage. Throws RunError when the energies
  /// are no finite numbers.
  void after_step(RunState& now, const dynamics::Stepper& stepper, const dynamics::StepReport& report,
                  bool ends_stage);

 private:
  /// Whether what is given every `interval`, s, is given after this many steps of the stage.
  [[nodiscard]] bool is_due(long stage_step, double interval) const;
  [[nodiscard]] bool is_static(const RunState& now) const;
  void due_pictures(RunState& now, const dynamics::Stepper& stepper);
  void due_history(RunState& now);
  void due_step_row(RunState& now, const dynamics::StepReport& report);

  const RunSetup& setup_;
  const dynamics::Model& model_;
  DamageGauge& gauge_;
  record::RunObserver& observer_;
  Profile& profile_;
  Recorder recorder_;
  std::vector<Vec2> velocity_before_;  ///< m/s, of history points, where a history is due after the step
};

}  // namespace keyblock::simulation
