#include "simulation/runner.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/out_of_memory.h"
#include "dynamics/energy.h"
#include "simulation/build_boundary.h"
#include "simulation/build_model.h"
#include "simulation/build_water.h"
#include "simulation/checkpoint_checks.h"
#include "simulation/energy_audit.h"
#include "simulation/excavate.h"
#include "simulation/feasibility.h"
#include "simulation/install.h"
#include "simulation/joint_laws.h"
#include "simulation/planned_changes.h"
#include "simulation/run_checks.h"
#include "simulation/step_count.h"

namespace keyblock::simulation {

namespace {

constexpr long checkpoint_steps = 2000;   // between places in a stage for a checkpoint
constexpr double still_share = 0.05;      // of DamageLimits::slip: how far points may go where all is still
constexpr double shortest_repeat = 0.01;  // of the time of a run so far, that a checkpoint in a stage saves

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const RunSetup& feasible(const RunSetup& setup) {
  if (const auto reason = yields_without_limit(setup)) throw RunError(*reason);
  return setup;
}

void count(RunState& now, const dynamics::StepReport& report) {
  ++now.stage_step;
  now.iterations += report.iterations;
  record::OpenCloseStatistics& statistics = now.record.open_close;
  statistics.max_iterations = std::max(statistics.max_iterations, report.iterations);
  statistics.retried_steps += report.substeps > 1;
  statistics.unconverged_steps += !report.converged;
  if (report.converged) statistics.last_converged_step = now.mechanics.step;
}

void keep_larger(record::OverlapRecord& known, const dynamics::VertexPlace& found, const RunState& now,
                 const RunSetup& setup) {
  if (found.distance > known.depth)
    known = {found.distance, found.block_a,      found.block_b,
             found.where,    now.mechanics.time, setup.stages[at(now.stage)].name};
}

void keep_audit(const dynamics::ContactAudit& audit, const RunSetup& setup, RunState& now) {
  record::ContactChecks& vertices = now.record.contact_checks;
  vertices.across_gaps += audit.across_gaps;
  keep_larger(vertices.farthest, audit.farthest, now, setup);
  keep_larger(vertices.deepest, audit.deepest, now, setup);
  keep_larger(vertices.unexplained, audit.unexplained, now, setup);
}

/// m/s², of the ground: forces of inertia are against it.
Vec2 seismic_acceleration(const record::Stage& stage, const dynamics::Model& model) {
  return -norm(model.gravity) * Vec2{stage.k_h, stage.k_v};
}

bool is_set(const std::atomic<bool>* flag) {
  return flag != nullptr && flag->load();
}

}  // namespace

Runner::Runner(const RunSetup& setup, RunOptions options, record::RunObserver& observer)
    : setup_(feasible(setup)),
      options_(std::move(options)),
      observer_(observer),
      team_(options_.threads),
      model_(build_model(setup)),
      gauge_(setup, model_),
      reporter_(setup, model_, gauge_, observer, profile_, team_.size()),
      progress_(setup, options_.progress_interval, observer),
      orders_(setup),
      opening_(setup, model_),
      stepper_(std::in_place, model_, team_, profile_, options_.stop) {
  options_.resume ? resume() : begin();
  observer_.begin(reporter_.recorder().model());
  if (options_.resume) observer_.resume(now_.reported);
}

void Runner::begin() {
  now_.mechanics = initial_state(setup_, model_);
  opening_.start(now_.mechanics);
  stepper_->start(now_.mechanics);
  now_.present = model_.surface.present;
  // All potentials count from the start, as gravity does.
  now_.initial_energy = stored_energy(model_, now_.mechanics);
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
  restore(now_.control, setup_, model_);
  model_.laws = laws_in_stage(setup_, now_.control, planned_stage());
  orders_changed();
  gauge_.restore(std::move(now_.damage));
  opening_.memory() = now_.opening;
  wall_before_ = now_.wall_time;
}

const record::Stage& Runner::planned_stage() const {
  return setup_.stages[std::min(at(now_.stage), setup_.stages.size() - 1)];
}

bool Runner::done() const {
  if (ended_) return true;
  if (stage_) return false;
  return now_.record.interrupted || now_.stage >= std::ssize(setup_.stages) || is_set(options_.stop);
}

Advance Runner::advance() {
  Advance result;
  if (done()) return result;
  end_if_it_fails([&] {
    if (!stage_) begin_stage();
    if (!stage_is_over()) result.took_step = take_step(result.report);
    if (!stage_is_over()) return;
    end_stage();
    result.ended_stage = true;
  });
  return result;
}

record::RunRecord Runner::finish() {
  if (ended_) return now_.record;
  if (stage_) {
    stage_->record.interrupted = true;
    end_if_it_fails([&] { end_stage(); });
  }
  end();
  return now_.record;
}

template <typename Work>
void Runner::end_if_it_fails(const Work& work) {
  try {
    with_memory_for([&] { return memory_purpose(setup_); }, work);
  } catch (const RunError&) {
    now_.record.interrupted = true;
    try {
      end();
    } catch (const std::exception&) {  // the first failure is the one to be told about
    }
    throw;
  }
}

void Runner::end() {
  ended_ = true;
  stage_.reset();
  record::RunRecord& record = now_.record;
  record.steps = now_.mechanics.step;
  record.wall_time = wall_before_ + seconds_since(begin_);
  record.dof = static_cast<int>(model_.unknowns);
  record.state_hash = state_hash(now_.mechanics);
  record.open_close.mean_iterations =
      record.steps > 0 ? static_cast<double>(now_.iterations) / static_cast<double>(record.steps) : 0.0;
  record.energy = energy();
  record.planes = planes_beside(setup_, model_, now_.mechanics);
  record.water = water_record(model_, now_.mechanics);
  record.elements = element_records(model_, now_.mechanics, now_.peaks, setup_.stages);
  record.interrupted = record.interrupted || is_set(options_.stop) || now_.stage < std::ssize(setup_.stages);
  record.profile = profile_;
  observer_.end(record);
}

record::Energy Runner::energy() const {
  return energy_audit(model_, now_.mechanics, now_.initial_energy);
}

void Runner::orders_changed() {
  put_loads(now_.control, setup_, model_);
  stepper_.emplace(model_, team_, profile_, options_.stop);
  stepper_->resume(now_.mechanics);
  if (stage_) model_.static_ground = seismic_acceleration(stage_->record.stage, model_);
  reporter_.orders_changed();
}

// What a change of orders takes out of the rock or puts into it is numerical.
bool Runner::change_orders(bool (OrderControl::*change)(dynamics::Model&, dynamics::State&)) {
  const double before = stored_energy(model_, now_.mechanics);
  if (!orders_.active() || !(orders_.*change)(model_, now_.mechanics)) return false;
  orders_changed();
  stepper_->measure_stored_energy(now_.mechanics);
  now_.mechanics.ledger.numerical += before - stored_energy(model_, now_.mechanics);
  return true;
}

void Runner::begin_stage() {
  const bool is_new = now_.stage_step == 0;
  // Not to be found again from the time and the number of steps: the motion is read at times that count from here.
  if (is_new) now_.stage_start = now_.mechanics.time;
  progress_.begin_stage(now_.stage_step);
  record::StageRecord& record = stage_.emplace().record;
  record.stage = setup_.stages[static_cast<std::size_t>(now_.stage)];
  record.start_time = now_.stage_start;
  record.steps = now_.stage_step;
  plan_motion(setup_, record);
  gauge_.name_moving({});
  record.waits_for = wait_of(setup_, record);
  if (is_new) {
    excavate(setup_, record.stage, model_, now_.mechanics, *stepper_, gauge_, opening_);
    install(setup_, record.stage, model_, now_.mechanics);
    opening_.begin_stage(now_.stage, now_.mechanics);
    gauge_.begin_stage(now_.mechanics);
  }
  model_.joints_wear = record::wears_joints(setup_.stages, at(now_.stage));
  if (auto laws = laws_in_stage(setup_, now_.control, record.stage); laws != model_.laws)
    stepper_->set_laws(std::move(laws));
  model_.water = water_in(setup_, at(now_.stage));
  model_.water_drains = record.stage.kind != record::StageKind::settle;  // static steps take no time
  now_.present = model_.surface.present;
  observer_.stage_begin(now_.stage, record);
  if (is_new) reporter_.frame(now_);
  if (record.stage.kind == record::StageKind::settle) {
    begin_settling();
    return;
  }
  if (is_new) now_.record.made.highest = now_.mechanics.ledger.numerical;
  if (record.stage.until_still) begin_waiting(is_new);
  stage_->most_steps = static_cast<long>(step_count(record.planned_duration.value_or(0.0), setup_.time_step));
  if (record.stage.kind == record::StageKind::shake) {
    stage_->motion.emplace(setup_.motions.at(static_cast<std::size_t>(record.stage.motion)),
                           record.stage.scale, record.start_time, now_.control.motion_scale);
  }
}

/// For the time when nothing moves any more.
void Runner::begin_waiting(bool is_new) {
  const record::Stage& stage = stage_->record.stage;
  const std::optional<record::StageWait>& wait = stage_->record.waits_for;
  stage_->stillness.emplace(stage.still_distance.value_or(still_share * setup_.damage.slip), stage.still_time,
                            wait ? wait->until : 0.0);
  if (!is_new) stage_->stillness->restore(now_.still);
}

void Runner::begin_settling() {
  const record::Stage& stage = stage_->record.stage;
  stage_->most_steps = stage.max_steps.value_or(record::default_settle_steps);
  stage_->settler.emplace(model_, setup_.time_step, stage.tolerance);
  model_.static_ground = seismic_acceleration(stage, model_);
  if (now_.stage_step > 0) {
    stage_->settler->restore(now_.settler);
    return;
  }
  // Static steps have no velocity.
  now_.mechanics.ledger.numerical += dynamics::kinetic_energy(model_, now_.mechanics);
  std::fill(now_.mechanics.velocity.begin(), now_.mechanics.velocity.end(), 0.0);
  change_orders(&OrderControl::begin);
}

bool Runner::stage_is_over() const {
  return stage_->is_in_equilibrium || stage_->is_still || now_.stage_step >= stage_->most_steps ||
         is_within_step_ || is_set(options_.stop);
}

/// Whether the step came to its end: one that does not is given up, as the run is to stop.
bool Runner::take_step(dynamics::StepReport& report) {
  StageOutlook outlook;
  try {
    outlook = stage_->settler ? static_step(report) : dynamic_step(report);
  } catch (const dynamics::Interrupted&) {
    is_within_step_ = true;
    return false;
  }
  after_step(report, outlook);
  return true;
}

StageOutlook Runner::static_step(dynamics::StepReport& report) {
  Settler& settler = *stage_->settler;
  bool balances = settler.step(*stepper_, now_.mechanics, report);
  if (balances && change_orders(&OrderControl::adapt)) {
    settler.begin_again();
    balances = false;
  }
  if (balances && opening_.go_on(stage_->record.stage, now_.mechanics, *stepper_)) {
    settler.begin_again();
    balances = false;
  }
  stage_->is_in_equilibrium = balances;
  return {balances ? 0 : stage_->most_steps - now_.stage_step - 1, settler.progress(), settler.worst_ratio()};
}

StageOutlook Runner::dynamic_step(dynamics::StepReport& report) {
  reporter_.before_step(now_);
  report = stepper_->advance(now_.mechanics, setup_.time_step, stage_->motion ? &*stage_->motion : nullptr);
  const auto taken = static_cast<double>(now_.stage_step + 1);
  stage_->is_still =
      stage_->stillness && stage_->stillness->is_still(model_.surface, taken * setup_.time_step);
  return {stage_->is_still ? 0 : stage_->most_steps - now_.stage_step - 1,
          taken / static_cast<double>(stage_->most_steps), 0.0};
}

void Runner::after_step(const dynamics::StepReport& report, const StageOutlook& outlook) {
  const Profile::Scope scope(profile_, Phase::output);
  const bool ends_stage = outlook.steps_left == 0;
  count(now_, report);
  keep_audit(report.audit, setup_, now_);
  const std::vector<int> ruptured = keep_peaks(model_, now_.mechanics, now_.stage, now_.peaks);
  opening_.drop_moved(gauge_, now_.mechanics);
  check_converging(setup_, now_);
  check_state(setup_, now_);
  reporter_.breaks(now_, report.breaks, ruptured);
  reporter_.after_step(now_, *stepper_, report, ends_stage);
  if (options_.after_step) options_.after_step(*this, report);
  // The end of a stage has a checkpoint of its own: from one within it, a run that is resumed would have no step left to take.
  if (!ends_stage && now_.stage_step % checkpoint_steps == 0) checkpoint();
  progress_.after_step(now_, report.iterations, outlook);
}

void Runner::end_stage() {
  record::StageRecord& record = stage_->record;
  if (stage_->settler) {
    const Settler& settler = *stage_->settler;
    record.equilibrium_reached = stage_->is_in_equilibrium;
    record.worst_residual_ratio = settler.worst_ratio();
    record.way = settler.astray();
    record.way_share = record.way / model_.block_size;
    record.moving = settler.moving(*stepper_);
    gauge_.name_moving(record.moving);
  } else {
    record.still = stage_->is_still && now_.stage_step < stage_->most_steps;
    record.interrupted = record.interrupted || (!record.still && now_.stage_step < stage_->most_steps);
    // Time from the number of steps, so that stages start at the same time whatever has been added up.
    record.duration = static_cast<double>(now_.stage_step) * setup_.time_step;
    if (!record.interrupted) now_.mechanics.time = record.start_time + record.duration;
    watch_made(model_, energy(), now_.mechanics.time, now_.record.made);
  }
  record.interrupted = record.interrupted || is_set(options_.stop);
  record.steps = now_.stage_step;
  record.wall_time = progress_.seconds();
  reporter_.measure_overlap(now_);
  reporter_.frame(now_);
  if (!is_within_step_) reporter_.contacts(now_, *stepper_);
  if (record.equilibrium_reached && !is_within_step_)
    record.unstable_block = find_unstable_block(stage_->settler->which_move());
  gauge_.describe(now_.mechanics, record);
  measure_elements(model_, now_.mechanics, now_.peaks, record.damage);
  record.release = opening_.end_stage(now_.mechanics);
  record.blocks_by_order = blocks_by_order(model_);
  observer_.stage_end(now_.stage, record);
  // An interrupted stage is in the record of this run alone; the checkpoint, written before, has it as unfinished.
  now_.record.stages.push_back(std::move(record));
  stage_.reset();
  const record::StageRecord& ended = now_.record.stages.back();
  if (ended.interrupted) {
    now_.record.interrupted = true;
    return;
  }
  check_energies(setup_, now_, energy());
  check_solved(setup_, now_, ended);
  ++now_.stage;
  now_.stage_step = 0;
  checkpoint();
}

// A place for a checkpoint is one whether it is used or not. In long runs not all are: with each, observers write out what they
// have, which may take room (results::ResultWriter).
void Runner::checkpoint() {
  stepper_->forget_history();
  const double elapsed = wall_before_ + seconds_since(begin_);
  const bool within_stage = now_.stage_step > 0;
  if (within_stage && elapsed - now_.wall_time < shortest_repeat * elapsed) return;
  if (options_.directory.empty()) return;
  if (stage_ && stage_->settler) now_.settler = stage_->settler->memory();
  if (stage_ && stage_->stillness) now_.still = stage_->stillness->memory();
  now_.damage = gauge_.memory();
  now_.orders = orders_.memory();
  now_.opening = opening_.memory();
  now_.wall_time = elapsed;
  now_.reported.stages = now_.stage;
  now_.reported.within_stage = within_stage;
  observer_.checkpoint();
  write_checkpoint(options_.directory, setup_, now_);
}

}  // namespace keyblock::simulation
