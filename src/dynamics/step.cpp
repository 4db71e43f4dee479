#include "dynamics/step.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "dynamics/energy.h"
#include "dynamics/initial_contacts.h"
#include "dynamics/position_update.h"
#include "dynamics/prescribed_motion.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

/// m, √ of the area of each block.
std::vector<double> sizes_of(const std::vector<Block>& blocks) {
  std::vector<double> sizes;
  sizes.reserve(blocks.size());
  for (const Block& block : blocks) sizes.push_back(std::sqrt(block.area));
  return sizes;
}

/// The beginning of the first attempt. Where there is a factor, only a curve through the last increments is a better beginning than none.
void guess(const IncrementHistory& history, linalg::BlockSolver& solver, const SolverOptions& options,
           double step, std::span<double> increment, ThreadTeam& team) {
  if (options.accelerators.increment_history && (solver.low_rank() == nullptr || history.is_smooth()))
    return history.extrapolate(step, increment, team);
  std::fill(increment.begin(), increment.end(), 0.0);
}

void check_finite(const OpenCloseResult& result, const Drive& drive) {
  if (result.finite) return;
  throw RunError("the forces of the step to " + std::to_string(drive.end_time) +
                 " s are not finite; a shorter time.step, order 1, or stiffer rock may help");
}

}  // namespace

Stepper::Stepper(Model& model, ThreadTeam& team, Profile& profile, const std::atomic<bool>* stop)
    : model_(model),
      team_(team),
      profile_(profile),
      motion_(model),
      rules_(model.bodies()),
      finder_(model, team),
      systems_(model, team),
      open_close_(stop),
      rotation_(model, finder_.tolerances()),
      intrusions_(sizes_of(model.blocks)),
      increment_(model.coefficients, 0.0),
      prescribed_(model.motions.empty() ? 0 : model.bodies()),
      travel_(model.blocks.size(), 0.0) {}

// ── between steps ────────────────────────────────────────────────────────────────────────────────────────────────────

void Stepper::start(State& state) {
  state.moved.assign(model_.blocks.size(), 0.0);
  if (model_.solver.integrator != TimeIntegration::shi) {
    state.acceleration.assign(model_.coefficients, 0.0);
    state.force.assign(model_.coefficients, 0.0);
    state.acceleration_known.assign(model_.bodies(), 0);
  }
  state.couplings.clear();
  for (const auto& coupling : model_.couplings) state.couplings.emplace_back(coupling->memory_size(), 0.0);
  place_surface(model_, state, motion_, team_);
  std::fill(state.moved.begin(), state.moved.end(), 0.0);
  finder_.find_at_rest(motion_, state);
  state.contact_energy +=
      begin_contacts(model_, state, finder_.tolerances(), finder_.contacts(), state.contacts.pieces);
  contact::keep_memory(finder_.contacts(), state.contacts, team_);
  contact_coupling_.begin_step(finder_.contacts(), {}, {}, {});
  systems_.make_room(model_, contact_coupling_, state);
}

void Stepper::resume(State& state) {
  // To place the surface measures anew how far blocks moved, and the next prediction needs what the last step measured.
  const std::vector<double> moved = state.moved;
  place_surface(model_, state, motion_, team_);
  state.moved = moved;
  finder_.invalidate();
  systems_.forget();
}

void Stepper::forget_history() {
  finder_.invalidate();
  open_close_.forget_factor();
  history_.forget();
}

void Stepper::remove_absent(State& state) {
  history_.forget();
  finder_.remove_absent(motion_, state);
  sum_stored_energy(state);
  systems_.forget();
  state.pattern.clear();
}

void Stepper::sum_stored_energy(State& state) const {
  state.contact_energy = 0.0;
  for (const contact::Memory& memory : state.contacts.memory) state.contact_energy += memory.stored;
  state.support_energy = support_energy(model_, state, state.time);
}

void Stepper::measure_stored_energy(State& state) {
  finder_.find_at_rest(motion_, state);
  for (contact::Contact& c : finder_.contacts()) {
    const bool pulls = c.fused || (c.memory.bonded && c.tension > 0.0);
    c.memory.stored = contact::Spring({.normal_stiffness = c.normal_stiffness,
                                       .shear_stiffness = c.shear_stiffness,
                                       .depth = c.depth,
                                       .shear = c.memory.shear,
                                       .tensile = pulls})
                          .stored_at_start();
  }
  contact::keep_memory(finder_.contacts(), state.contacts, team_);
  sum_stored_energy(state);
}

std::size_t Stepper::force_count() const {
  return std::min(finder_.contacts().size(), problem_.springs().size());
}

std::vector<ContactForce> Stepper::forces() const {
  std::vector<ContactForce> all(force_count());
  forces(0, all);
  return all;
}

void Stepper::forces(std::size_t first, std::span<ContactForce> to) const {
  if (first + to.size() > force_count()) throw std::out_of_range("forces of contacts that there are not");
  const SpringArray& springs = problem_.springs();
  for (std::size_t i = 0; i < to.size(); ++i) {
    const std::size_t k = first + i;
    const contact::Contact& c = finder_.contacts()[k];
    const Row& row = problem_.rows()[k];
    const double normal = springs.y0[k] - springs.y[k] + dot(row.normal, row.moved);  // n·r
    ContactForce& force = to[i] = {};
    force.gap = c.gap + c.memory.offset + normal;
    force.normal = springs.bearing(k);
    if (springs.is_open(k)) continue;
    force.shear = springs.force(k).shear;
    const bool holds = std::abs(springs.ks[k] * springs.w[k]) <= springs.bound[k];
    force.state = holds ? contact::State::locked : contact::State::sliding;
  }
}

void Stepper::set_laws(std::vector<contact::JointLaw> laws) {
  if (laws.size() != model_.laws.size())
    throw std::invalid_argument("as many laws of joints as before are needed");
  model_.laws = std::move(laws);
  finder_.set_laws(model_.laws);
  forget_history();
}

// ── the stages of a step ─────────────────────────────────────────────────────────────────────────────────────────────

void Stepper::predict(const State& state, Drive& drive) {
  rules_.choose(model_, state, drive.is_static);
  prescribe(model_, state, drive.end_time, prescribed_);
  drive.rule = rules_.rule();
  if (model_.solver.keeps_restitution) drive.in_impact = rules_.struck();
  drive.prescribed = prescribed_;
  motion_.predict(model_, state, drive, team_);
  earlier_attempt_.forget();
  rotation_.forget();
}

/// Which candidates are contacts; build() describes them.
void Stepper::find(State& state, const Drive& drive) {
  const Profile::Scope scope(profile_, Phase::detection);
  const bool changed = finder_.find_which(motion_, drive.is_static, state);
  if (changed || !systems_.knows_pairs()) systems_.find_pairs(model_, state);
  // Its branches are by number of contact, and those are others now.
  if (changed) earlier_attempt_.forget();
}

/// Contacts that are not known yet are described on the way, while a cache has them.
void Stepper::build(State& state, const Drive& drive, bool knows_contacts) {
  const Profile::Scope scope(profile_, Phase::terms);
  const auto describe = [&](const contact::Detection::OfSome& then) { finder_.describe(state, then); };
  contact_coupling_.begin_step(finder_.contacts(), systems_.pairs(),
                               knows_contacts ? ContactCoupling::ForContacts{} : describe,
                               [&]() -> const contact::JointFaces& { return finder_.find_faces(); });
  problem_.build(model_, state, drive, contact_coupling_, team_);
  if (problem_.facts().lacks_room) {
    systems_.make_room(model_, contact_coupling_, state);
    problem_.find_pairs(state.pattern);
  }
  if (model_.solver.accelerators.earlier_attempt)
    earlier_attempt_.give(finder_.contacts(), problem_.springs());
}

linalg::BlockSolver& Stepper::choose_solver(const State& state, bool is_static, bool must_be_direct) {
  const Profile::Scope scope(profile_, Phase::assembly);
  const LinearSystems::Chosen chosen = systems_.choose(model_, state, is_static, must_be_direct);
  if (chosen.is_new) open_close_.forget_factor();
  return chosen.solver;
}

Attempt Stepper::solution(const State& state, const Drive& drive) const {
  return {model_,
          state,
          drive,
          problem_,
          finder_.contacts(),
          increment_,
          open_close_.displacement(),
          open_close_.relative(),
          team_};
}

Verdict Stepper::check(const Attempt& attempt, const OpenCloseResult& result, bool may_meet_impacts) {
  rotation_.measure_spin(attempt);
  if (!result.converged) return Verdict::not_converged;
  const Verdict rotation = attempt.drive.is_trial ? Verdict::accepted : rotation_.check(attempt);
  if (rotation == Verdict::rotated_too_far) return rotation;
  // Both are looked for, as both say what the next attempt is made with.
  const bool moved = motion_.is_exceeded(attempt, rotation_.spin(), finder_.tolerances()),
             impact = result.given_up || (may_meet_impacts && rules_.meet_impacts(attempt, motion_.speed()));
  if (moved) return Verdict::moved_too_far;
  return impact ? Verdict::impact : rotation;
}

Verdict Stepper::solve(State& state, Drive& drive, const SolverOptions& options, Attempts& attempts,
                       StepReport& report) {
  drive.rotation = rotation_.known();
  drive.impact_speed = rules_.impact_speed();
  build(state, drive, attempts.same_contacts);
  linalg::BlockSolver& solver = choose_solver(state, drive.is_static, attempts.must_be_direct);
  if (!problem_.terms().has_weights()) {
    std::fill(increment_.begin(), increment_.end(), 0.0);
  } else if (attempts.is_first()) {
    guess(history_, solver, options, drive.step, increment_, team_);
  }
  const bool may_meet_impacts = attempts.count < step_numbers::most_attempts;
  const auto meets_impacts = [&] {
    return may_meet_impacts && rules_.meet_impacts(solution(state, drive), motion_.speed());
  };
  // Before friction is found: with the rule of a step without impact its impulse is up to twice what it comes to be, and where that
  // would take blocks is no place to look for contacts.
  const OpenCloseResult result = open_close_.solve(
      {problem_, finder_.of_step(), solver, options, team_, profile_}, increment_, meets_impacts);
  report.iterations += result.iterations;
  quiet_ = result.changes == 0;
  attempts.bond_broken = result.bond_broken;
  check_finite(result, drive);
  if (result.linear_failed && !attempts.must_be_direct) return Verdict::solver_failed;
  return check(solution(state, drive), result, may_meet_impacts);
}

/// Whether a solution was found that the step can be taken with.
bool Stepper::attempt(State& state, Drive& drive, const SolverOptions& options, StepReport& report) {
  predict(state, drive);
  for (Attempts attempts;;) {
    if (!attempts.same_contacts) find(state, drive);
    const Verdict verdict = solve(state, drive, options, attempts, report);
    switch (verdict) {
      case Verdict::accepted:
        return true;
      case Verdict::not_converged:
      case Verdict::rotated_too_far:
        return false;
      case Verdict::solver_failed:
        attempts.must_be_direct = true;
        continue;
      case Verdict::rotated:
        if (++attempts.rotations > step_numbers::most_rotations) return false;
        rotation_.take_over();
        attempts.same_contacts = true;
        break;
      case Verdict::moved_too_far:
      case Verdict::impact:
        // The last attempt is taken as it is, with the rotation correction that it was made with.
        if (++attempts.count > step_numbers::most_attempts) return true;
        rotation_.forget();
        // Bonds that broke are for the next attempt to find again.
        attempts.same_contacts = verdict == Verdict::impact && !attempts.bond_broken;
        break;
    }
    earlier_attempt_.keep(finder_.contacts(), problem_.springs());
  }
}

void Stepper::accept(State& state, const Drive& drive, StepReport& report) {
  const Attempt solved = solution(state, drive);
  {
    const Profile::Scope scope(profile_, Phase::energy);
    accounts_.account_for_blocks(solved, rotation_.spin(), state);
  }
  const Profile::Scope scope(profile_, Phase::update);
  const CouplingTotals totals = account_for_couplings(solved, rotation_.spin(), state);
  report.penetration = std::max(report.penetration, totals.penetration);
  report.closed_contacts = totals.closed;
  if (!drive.is_static) {
    state.last_step = drive.step;
    history_.add(increment_, drive.step, quiet_, team_);
  } else {
    history_.forget();
  }
  find_breaks(solved, report.breaks);
  const double loads_before = work_of_loads(model_, drive.end_time, state.position);
  move_blocks(solved, rotation_.spin(), rules_, state);
  // Where blocks turn, loads go other ways than the step was solved with: what they do over the difference is input, and lost at once.
  const double turned = work_of_loads(model_, drive.end_time, state.position) - loads_before -
                        work_of_loads(model_, drive.end_time, solved.increment);
  state.ledger.input += turned;
  state.ledger.numerical += turned;
  move_prescribed(model_, drive, state);
  place_surface(model_, state, motion_, team_);
  // What turning did to springs that the step was linear in, now that blocks are where they come to be.
  const double gained = rotation_.keep_shear(solved, state.contacts.memory);
  state.contact_energy += gained;
  state.ledger.numerical -= gained + renew_support_energy(model_, drive.end_time, state);
  report.max_displacement = std::max(report.max_displacement, largest_move(model_, state, drive.end_time));
  report.audit.add(audit_contacts({model_.surface, state.contacts, motion_.reach(), open_close_.relative(),
                                   finder_.tolerances().end_zone}));
}

// ── steps ────────────────────────────────────────────────────────────────────────────────────────────────────────────

void Stepper::substep(State& state, double t0, double t1, const GroundAcceleration* ground, int halvings,
                      StepReport& report) {
  Drive drive;
  drive.step = t1 - t0;
  drive.end_time = t1;
  // What the last step owes is an impulse: a shorter step pays it by a larger force.
  drive.owed_share = state.last_step / drive.step;
  drive.wears_joints = model_.joints_wear;
  const bool shi = model_.solver.integrator == TimeIntegration::shi;
  if (ground != nullptr) {
    // The rule of Shi holds its acceleration through the step: the mean brings the velocity of the record to its end.
    drive.ground_acceleration = shi ? ground->mean(t0, t1) : ground->at(t1);
    drive.ground_before = ground->at(t0);
  }
  SolverOptions options = model_.solver;
  if (stiffness_damping(model_) > drive.step) options.max_iterations *= step_numbers::damped_patience;
  const bool converged =
      attempt(state, drive, options, report) && !comes_inside(solution(state, drive), rotation_, intrusions_);
  if (converged || halvings >= model_.solver.max_halvings) {
    report.converged = report.converged && converged;
    report.halvings = std::max(report.halvings, halvings);
    accept(state, drive, report);
    return;
  }
  report.substeps += 1;
  const double middle = 0.5 * (t0 + t1);
  substep(state, t0, middle, ground, halvings + 1, report);
  substep(state, middle, t1, ground, halvings + 1, report);
}

StepReport Stepper::advance(State& state, double dt, const GroundAcceleration* ground) {
  StepReport report;
  substep(state, state.time, state.time + dt, ground, 0, report);
  report.shortest = std::ldexp(dt, -report.halvings);
  state.time += dt;
  ++state.step;
  return report;
}

}  // namespace keyblock::dynamics
