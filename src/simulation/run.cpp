#include "simulation/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>

#include "core/error.h"
#include "core/out_of_memory.h"
#include "core/parallel.h"
#include "dynamics/energy.h"
#include "dynamics/step.h"
#include "simulation/build_model.h"
#include "simulation/checkpoint.h"
#include "simulation/checkpoint_checks.h"
#include "simulation/damage.h"
#include "simulation/feasibility.h"
#include "simulation/order_control.h"
#include "simulation/recorder.h"
#include "simulation/settle.h"
#include "simulation/stage_motion.h"
#include "simulation/step_count.h"

namespace keyblock::simulation {

namespace {

using Clock = std::chrono::steady_clock;

constexpr long checkpoint_steps = 2000;     // between places in a stage for a checkpoint
constexpr double shortest_repeat = 0.01;    // of the time of a run so far, that a checkpoint in a stage saves
constexpr double step_row_interval = 0.02;  // s between rows of step statistics and looks of the damage gauge
constexpr double overlap_interval = 1.0;    // s between measurements of the true overlap
constexpr long most_unconverged = 100;      // steps in a row

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Runner {
 public:
  Runner(const RunSetup& setup, const RunOptions& options, RunObserver& observer)
      : setup_(setup),
        options_(options),
        observer_(observer),
        team_(options.threads),
        model_(build_model(setup)),
        gauge_(setup, model_),
        recorder_(setup, model_, gauge_, team_.size()),
        orders_(setup),
        stepper_(std::in_place, model_, team_, profile_, options.stop) {}

  RunRecord run();

 private:
  void begin();
  void resume();
  void orders_changed();
  void excavate(const Stage& stage);
  void run_stage();
  bool finishes(const std::function<void()>& step);
  void settle(StageRecord& record);
  void shake(StageRecord& record);
  void after_step(const dynamics::StepReport& report, long steps_left, double worst_ratio, double fraction);
  void record_frame();
  void record_contacts();
  void check_overlap();
  void check_finite(const Energy& energy) const;
  void check_solved(const StageRecord& record) const;
  void check_converging() const;
  [[noreturn]] void give_up(const std::string& reason) const;
  void checkpoint();
  [[nodiscard]] Energy energy() const;
  [[nodiscard]] double total_energy() const;
  [[nodiscard]] const Stage& stage() const { return setup_.stages[static_cast<std::size_t>(now_.stage)]; }
  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }
  [[nodiscard]] long every(double interval) const {
    constexpr double never = 1e15;
    return static_cast<long>(std::clamp(step_count(interval, setup_.time_step), 1.0, never));
  }

  const RunSetup& setup_;
  const RunOptions& options_;
  RunObserver& observer_;
  ThreadTeam team_;
  Profile profile_;
  dynamics::Model model_;
  DamageGauge gauge_;
  Recorder recorder_;
  OrderControl orders_;
  std::optional<dynamics::Stepper> stepper_;
  RunState now_;
  std::optional<Settler> settler_;
  Clock::time_point run_start_ = Clock::now(), stage_start_, last_progress_;
  double wall_before_ = 0.0;
  long stage_iterations_ = 0, first_step_of_stage_ = 0;
  bool is_within_step_ = false;  ///< the run was stopped there: contacts are not those of the state
};

double Runner::total_energy() const {
  return dynamics::kinetic_energy(model_, now_.mechanics) + dynamics::strain_energy(model_, now_.mechanics) +
         dynamics::gravity_energy(model_, now_.mechanics) + dynamics::spring_energy(now_.mechanics);
}

Energy Runner::energy() const {
  const dynamics::EnergyLedger& ledger = now_.mechanics.ledger;
  Energy e;
  e.kinetic = dynamics::kinetic_energy(model_, now_.mechanics);
  e.strain = dynamics::strain_energy(model_, now_.mechanics);
  e.contact = dynamics::spring_energy(now_.mechanics);
  e.friction = ledger.friction;
  e.damping = ledger.damping;
  e.numerical = ledger.numerical;
  e.input = ledger.input;
  e.gravity = dynamics::gravity_energy(model_, now_.mechanics) - now_.initial_energy;
  const double residual =
      e.kinetic + e.strain + e.gravity + e.contact + e.friction + e.damping + e.numerical - e.input;
  double largest = 0.0;
  for (const double term :
       {e.kinetic, e.strain, e.gravity, e.contact, e.friction, e.damping, e.numerical, e.input}) {
    largest = std::max(largest, std::abs(term));
  }
  e.residual_ratio = residual == 0.0 ? 0.0 : std::abs(residual) / largest;  // no number where a term is none
  return e;
}

void Runner::begin() {
  now_.mechanics = initial_state(setup_, model_);
  stepper_->start(now_.mechanics);
  now_.present = model_.surface.present;
  // All potentials count from the start, as gravity does.
  now_.initial_energy = total_energy();
  if (setup_.excavations.empty()) gauge_.start(now_.mechanics, stepper_->find_contacts(now_.mechanics));
}

void Runner::resume() {
  const auto check = [&](const std::string& mistake) {
    if (!mistake.empty()) refuse_checkpoint(options_.directory, mistake, "a checkpoint of this run");
  };
  now_ = read_checkpoint(options_.directory, setup_);
  check(mistake_in_orders(now_.orders, setup_, model_));
  orders_.memory() = now_.orders;
  orders_.restore(model_);
  check(mistake_in_state(now_, setup_, model_));
  model_.surface.present = now_.present;
  orders_changed();
  gauge_.restore(std::move(now_.damage));
  wall_before_ = now_.wall_time;
}

void Runner::orders_changed() {
  stepper_.emplace(model_, team_, profile_, options_.stop);
  stepper_->resume(now_.mechanics);
  recorder_.orders_changed();
}

void Runner::excavate(const Stage& stage) {
  if (stage.excavate.empty()) return;
  const double before = total_energy();
  gauge_.open(stage.excavate, now_.mechanics);
  for (std::size_t b = 0; b < setup_.system.blocks.size(); ++b) {
    const auto& inside = setup_.system.blocks[b].excavations;
    const bool removed = std::any_of(inside.begin(), inside.end(), [&](int e) {
      return std::find(stage.excavate.begin(), stage.excavate.end(), e) != stage.excavate.end();
    });
    if (removed) model_.surface.present[b] = 0;
  }
  if (!gauge_.started()) gauge_.start(now_.mechanics, stepper_->find_contacts(now_.mechanics));
  now_.present = model_.surface.present;
  stepper_->remove_absent(now_.mechanics);
  now_.mechanics.ledger.input += total_energy() - before;
}

void Runner::record_frame() {
  const Profile::Scope scope(profile_, Phase::output);
  observer_.frame(recorder_.frame(now_.mechanics, now_.stage));
  ++now_.reported.frames;
}

void Runner::record_contacts() {
  observer_.contacts(recorder_.contacts(now_.mechanics, *stepper_, now_.stage));
  ++now_.reported.contacts;
}

void Runner::check_overlap() {
  const Profile::Scope scope(profile_, Phase::output);
  const auto overlap = recorder_.overlap(now_.mechanics, now_.stage, now_.record.max_overlap.depth);
  if (overlap) now_.record.max_overlap = *overlap;
  now_.record.max_area_change = std::max(now_.record.max_area_change, recorder_.area_change(now_.mechanics));
}

void Runner::give_up(const std::string& reason) const {
  std::string text = reason + "; the results up to there are kept";
  for (const std::string& warning : setup_.warnings) text += "; odd input: " + warning;
  throw RunError(text);
}

void Runner::check_finite(const Energy& energy) const {
  if (std::isfinite(energy.residual_ratio)) return;
  give_up(fmt::format("the energies after step {} of stage '{}' are no finite numbers", now_.stage_step,
                      stage().name));
}

/// Single steps that do not converge leave a result that can be judged by what is out of balance; a stage without any that
/// does has none.
void Runner::check_solved(const StageRecord& record) const {
  check_finite(energy());
  const long before = now_.mechanics.step - record.steps;
  if (record.steps == 0 || now_.record.open_close.last_converged_step > before) return;
  give_up(fmt::format("no step of stage '{}' converged, of {} from step {} of the run on", record.stage.name,
                      record.steps, before + 1));
}

/// Nor does a run that goes on without any; each of its steps takes many times as long as others.
void Runner::check_converging() const {
  if (now_.mechanics.step - now_.record.open_close.last_converged_step < most_unconverged) return;
  give_up(fmt::format("{} steps in a row did not converge, the last of them step {} of stage '{}'",
                      most_unconverged, now_.stage_step, stage().name));
}

// A place for a checkpoint is one whether it is used or not. In long runs not all are: with each, observers write out what they
// have, which may take room (results::ResultWriter).
void Runner::checkpoint() {
  stepper_->forget_history();
  const double elapsed = wall_before_ + seconds_since(run_start_);
  const bool within_stage = now_.stage_step > 0;
  if (within_stage && elapsed - now_.wall_time < shortest_repeat * elapsed) return;
  if (options_.directory.empty()) return;
  if (settler_) now_.settler = settler_->memory();
  now_.damage = gauge_.memory();
  now_.orders = orders_.memory();
  now_.wall_time = elapsed;
  now_.reported.stages = now_.stage;
  now_.reported.within_stage = within_stage;
  observer_.checkpoint();
  write_checkpoint(options_.directory, setup_, now_);
}

/// What follows every step, static or dynamic: statistics, records that are due, progress.
void Runner::after_step(const dynamics::StepReport& report, long steps_left, double worst_ratio,
                        double fraction) {
  const Profile::Scope scope(profile_, Phase::output);
  ++now_.stage_step;
  now_.iterations += report.iterations;
  stage_iterations_ += report.iterations;
  OpenCloseStatistics& statistics = now_.record.open_close;
  statistics.max_iterations = std::max(statistics.max_iterations, report.iterations);
  statistics.retried_steps += report.substeps > 1;
  statistics.unconverged_steps += !report.converged;
  if (report.converged) statistics.last_converged_step = now_.mechanics.step;
  check_converging();
  for (const double x : now_.mechanics.position) {
    if (!std::isfinite(x)) {
      give_up(fmt::format("step {} of stage '{}' left no finite state", now_.stage_step, stage().name));
    }
  }
  const bool is_static = stage().kind == StageKind::settle;
  const long step = now_.stage_step;
  const auto due = [&](double interval) { return step % every(interval) == 0; };
  if (steps_left > 0) {
    if (is_static ? step % setup_.output.settle_frame_interval == 0 : due(setup_.output.frame_interval))
      record_frame();
    if (!is_static && due(setup_.output.contact_interval)) record_contacts();
    if (!is_static && due(overlap_interval)) check_overlap();
  }
  if (!setup_.histories.empty() && (is_static || due(setup_.output.history_interval))) {
    observer_.history(recorder_.history(now_.mechanics));
    ++now_.reported.histories;
  }
  if (due(step_row_interval)) {
    gauge_.watch(now_.mechanics);
    const Energy energies = energy();
    observer_.step({now_.mechanics.time, now_.mechanics.step, now_.stage, report.iterations, report.shortest,
                    report.penetration, report.max_displacement, report.closed_contacts, energies});
    ++now_.reported.steps;
    check_finite(energies);
  }
  // The end of a stage has a checkpoint of its own: from one within it, a run that is resumed would have no step left to take.
  if (steps_left > 0 && step % checkpoint_steps == 0) checkpoint();
  if (seconds_since(last_progress_) < options_.progress_interval && steps_left > 0) return;
  last_progress_ = Clock::now();
  Progress progress;
  progress.stage = now_.stage;
  progress.stage_count = static_cast<int>(setup_.stages.size());
  progress.stage_name = stage().name;
  progress.kind = stage().kind;
  progress.step = step;
  progress.fraction = fraction;
  progress.time = is_static ? 0.0 : static_cast<double>(step) * setup_.time_step;
  const double elapsed = std::max(1e-9, seconds_since(stage_start_));
  const auto done = static_cast<double>(step - first_step_of_stage_);
  progress.steps_per_second = done / elapsed;
  progress.seconds_left = is_static ? -1.0 : static_cast<double>(steps_left) / progress.steps_per_second;
  progress.mean_iterations = static_cast<double>(stage_iterations_) / done;
  progress.worst_residual_ratio = worst_ratio;
  observer_.progress(progress);
}

/// Whether a step came to its end: one that does not is given up, as the run is to stop.
bool Runner::finishes(const std::function<void()>& step) {
  try {
    step();
  } catch (const dynamics::Interrupted&) {
    is_within_step_ = true;
  }
  return !is_within_step_;
}

void Runner::settle(StageRecord& record) {
  const int limit = record.stage.max_steps.value_or(default_settle_steps);
  settler_.emplace(model_, setup_.time_step, record.stage.tolerance);
  if (now_.stage_step > 0) settler_->restore(now_.settler);
  // What a change of orders takes out of the rock or puts into it is numerical.
  const auto change_orders = [&](bool (OrderControl::*change)(dynamics::Model&, dynamics::State&)) {
    const double before = total_energy();
    if (!orders_.active() || !(orders_.*change)(model_, now_.mechanics)) return false;
    orders_changed();
    stepper_->measure_stored_energy(now_.mechanics);
    now_.mechanics.ledger.numerical += before - total_energy();
    return true;
  };
  if (now_.stage_step == 0) {
    // Static steps have no velocity.
    now_.mechanics.ledger.numerical += dynamics::kinetic_energy(model_, now_.mechanics);
    std::fill(now_.mechanics.velocity.begin(), now_.mechanics.velocity.end(), 0.0);
    change_orders(&OrderControl::begin);
  }
  bool done = false;
  while (!done && now_.stage_step < limit && !stopped()) {
    dynamics::StepReport report;
    if (!finishes([&] { done = settler_->step(*stepper_, now_.mechanics, report); })) break;
    if (done && change_orders(&OrderControl::adapt)) {
      settler_->begin_again();
      done = false;
    }
    after_step(report, done ? 0 : limit - now_.stage_step - 1, settler_->worst_ratio(), settler_->progress());
  }
  record.equilibrium_reached = done;
  record.worst_residual_ratio = settler_->worst_ratio();
  record.way = settler_->astray();
  record.way_share = record.way / model_.block_size;
  record.moving = settler_->moving(*stepper_);
  settler_.reset();
}

void Runner::shake(StageRecord& record) {
  const Stage& stage = record.stage;
  std::optional<StageMotion> motion;
  if (stage.kind == StageKind::shake) {
    motion.emplace(setup_.motions.at(static_cast<std::size_t>(stage.motion)), stage.scale, record.start_time);
  }
  const auto steps = static_cast<long>(step_count(record.planned_duration.value_or(0.0), setup_.time_step));
  while (now_.stage_step < steps && !stopped()) {
    dynamics::StepReport report;
    const auto step = [&] {
      report = stepper_->advance(now_.mechanics, setup_.time_step, motion ? &*motion : nullptr);
    };
    if (!finishes(step)) break;
    const long left = steps - now_.stage_step - 1;
    after_step(report, left, 0.0, static_cast<double>(now_.stage_step + 1) / static_cast<double>(steps));
  }
  record.interrupted = now_.stage_step < steps;
  // Time from the number of steps, so that stages start at the same time whatever has been added up.
  record.duration = static_cast<double>(now_.stage_step) * setup_.time_step;
  if (!record.interrupted) now_.mechanics.time = record.start_time + record.duration;
}

void Runner::run_stage() {
  StageRecord record;
  record.stage = stage();
  // Not to be found again from the time and the number of steps: the motion is read at times that count from here.
  if (now_.stage_step == 0) now_.stage_start = now_.mechanics.time;
  record.start_time = now_.stage_start;
  stage_start_ = last_progress_ = Clock::now();
  first_step_of_stage_ = now_.stage_step;
  stage_iterations_ = 0;
  record.steps = now_.stage_step;
  plan_motion(setup_, record);
  if (now_.stage_step == 0) {
    excavate(record.stage);
    observer_.stage_begin(now_.stage, record);
    record_frame();
  } else {
    observer_.stage_begin(now_.stage, record);
  }
  record.stage.kind == StageKind::settle ? settle(record) : shake(record);
  record.interrupted = record.interrupted || stopped();
  record.steps = now_.stage_step;
  record.wall_time = seconds_since(stage_start_);
  check_overlap();
  record_frame();
  if (!is_within_step_) record_contacts();
  gauge_.describe(now_.mechanics, record);
  record.blocks_by_order = blocks_by_order(model_);
  observer_.stage_end(now_.stage, record);
  if (record.interrupted) {
    now_.record.stages.push_back(
        record);  // of this run alone; the checkpoint, written before, has it as unfinished
    return;
  }
  now_.record.stages.push_back(record);
  check_solved(record);
  ++now_.stage;
  now_.stage_step = 0;
  checkpoint();
}

RunRecord Runner::run() {
  options_.resume ? resume() : begin();
  observer_.begin(recorder_.model());
  if (options_.resume) observer_.resume(now_.reported);
  const auto finish = [&] {
    RunRecord& record = now_.record;
    record.steps = now_.mechanics.step;
    record.wall_time = wall_before_ + seconds_since(run_start_);
    record.dof = static_cast<int>(model_.unknowns);
    record.state_hash = state_hash(now_.mechanics);
    record.open_close.mean_iterations =
        record.steps > 0 ? static_cast<double>(now_.iterations) / static_cast<double>(record.steps) : 0.0;
    record.energy = energy();
    record.interrupted = record.interrupted || stopped();
    record.profile = profile_;
    observer_.end(record);
  };
  try {
    while (now_.stage < static_cast<int>(setup_.stages.size()) && !stopped())
      with_memory_for([&] { return memory_purpose(setup_); }, [&] { run_stage(); });
  } catch (const RunError&) {
    now_.record.interrupted = true;
    try {
      finish();
    } catch (const std::exception&) {  // the first failure is the one to be told about
    }
    throw;
  }
  finish();
  return now_.record;
}

}  // namespace

RunRecord run(const RunSetup& setup, const RunOptions& options, RunObserver& observer) {
  if (const auto reason = yields_without_limit(setup)) throw RunError(*reason);
  return with_memory_for([&] { return memory_purpose(setup); },
                         [&] { return Runner(setup, options, observer).run(); });
}

}  // namespace keyblock::simulation
