#include "simulation/reporter.h"

#include <algorithm>
#include <span>

#include "simulation/energy_audit.h"
#include "simulation/frame_motion.h"
#include "simulation/run_checks.h"
#include "simulation/step_count.h"

namespace keyblock::simulation {

namespace {

constexpr double step_row_interval = 0.02;  // s between rows of step statistics and looks of the damage gauge
constexpr double overlap_interval = 1.0;    // s between measurements of the true overlap

}  // namespace

bool Reporter::is_due(long stage_step, double interval) const {
  constexpr double never = 1e15;
  const auto every = static_cast<long>(std::clamp(step_count(interval, setup_.time_step), 1.0, never));
  return stage_step % every == 0;
}

bool Reporter::is_static(const RunState& now) const {
  return setup_.stages[static_cast<std::size_t>(now.stage)].kind == record::StageKind::settle;
}

void Reporter::frame(RunState& now) {
  const Profile::Scope scope(profile_, Phase::output);
  observer_.frame(recorder_.frame(now.mechanics, now.stage));
  ++now.reported.frames;
}

void Reporter::contacts(RunState& now, const dynamics::Stepper& stepper) {
  observer_.contacts(recorder_.contacts(now.mechanics, stepper, now.stage));
  ++now.reported.contacts;
}

void Reporter::measure_overlap(RunState& now) {
  const Profile::Scope scope(profile_, Phase::output);
  const auto overlap = recorder_.overlap(now.mechanics, now.stage, now.record.max_overlap.depth);
  if (overlap) now.record.max_overlap = *overlap;
  now.record.max_area_change = std::max(now.record.max_area_change, recorder_.area_change(now.mechanics));
}

void Reporter::breaks(RunState& now, std::span<const dynamics::JointBreak> joints,
                      std::span<const int> elements) {
  if (joints.empty() && elements.empty()) return;
  const Profile::Scope scope(profile_, Phase::output);
  for (record::BreakRecord& row : recorder_.breaks(now.mechanics, joints, elements)) {
    row.stage = now.stage;
    observer_.breaks(row);
    ++now.reported.breaks;
    record::count_break(row, now.record.breaks);
  }
}

void Reporter::before_step(const RunState& now) {
  if (setup_.histories.empty() || !is_due(now.stage_step + 1, setup_.output.history_interval)) return;
  velocity_before_ = recorder_.velocities(now.mechanics, frame_motion(setup_, now));
}

void Reporter::after_step(RunState& now, const dynamics::Stepper& stepper, const dynamics::StepReport& report,
                          bool ends_stage) {
  if (!ends_stage) due_pictures(now, stepper);
  due_history(now);
  due_step_row(now, report);
}

void Reporter::due_pictures(RunState& now, const dynamics::Stepper& stepper) {
  if (is_static(now)) {
    if (now.stage_step % setup_.output.settle_frame_interval == 0) frame(now);
    return;
  }
  if (is_due(now.stage_step, setup_.output.frame_interval)) frame(now);
  if (is_due(now.stage_step, setup_.output.contact_interval)) contacts(now, stepper);
  if (is_due(now.stage_step, overlap_interval)) measure_overlap(now);
}

void Reporter::due_history(RunState& now) {
  if (setup_.histories.empty()) return;
  if (!is_static(now) && !is_due(now.stage_step, setup_.output.history_interval)) return;
  const std::span<const Vec2> before =
      is_static(now) ? std::span<const Vec2>{} : std::span<const Vec2>{velocity_before_};
  observer_.history(recorder_.history(now.mechanics, frame_motion(setup_, now), before));
  ++now.reported.histories;
}

void Reporter::due_step_row(RunState& now, const dynamics::StepReport& report) {
  if (!is_due(now.stage_step, step_row_interval)) return;
  gauge_.watch(now.mechanics);
  const record::Energy energy = energy_audit(model_, now.mechanics, now.initial_energy);
  observer_.step({now.mechanics.time, now.mechanics.step, now.stage, report.iterations, report.shortest,
                  report.penetration, report.max_displacement, report.closed_contacts, energy});
  ++now.reported.steps;
  check_energies(setup_, now, energy);
  if (!is_static(now)) watch_made(model_, energy, now.mechanics.time, now.record.made);
}

}  // namespace keyblock::simulation
