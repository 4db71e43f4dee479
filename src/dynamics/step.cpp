#include "dynamics/step.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/index.h"

namespace keyblock::dynamics {

namespace {

std::vector<double> penalties(const Model& model) {
  std::vector<double> stiffness;
  for (const Block& block : model.blocks) stiffness.push_back(model.solver.penalty * block.material.young);
  return stiffness;
}

/// m, √ of the area of each block.
std::vector<double> sizes_of(const std::vector<Block>& blocks) {
  std::vector<double> sizes;
  sizes.reserve(blocks.size());
  for (const Block& block : blocks) sizes.push_back(std::sqrt(block.area));
  return sizes;
}

std::unique_ptr<linalg::BlockSolver> make_direct_solver(const SolverOptions& options) {
  if (options.linear == LinearSolver::direct) return linalg::make_cholmod();
  return linalg::make_block_cholesky(options.accelerators.single_precision ? linalg::Precision::automatic
                                                                           : linalg::Precision::full);
}

}  // namespace

Stepper::Stepper(Model& model, ThreadTeam& team, Profile& profile, const std::atomic<bool>* stop)
    : model_(model),
      team_(team),
      profile_(profile),
      tolerances_(model.block_size),
      candidates_(tolerances_),
      detection_(tolerances_, model.laws, penalties(model)),
      open_close_(stop),
      direct_{make_direct_solver(model.solver)},
      iterative_{linalg::make_block_conjugate_residual(&team)},
      reach_(model.blocks.size(), 0.0),
      turn_(model.blocks.size(), 0.0),
      way_(model.blocks.size(), 0.0),
      is_far_(model.blocks.size(), 0),
      ahead_(model.surface.position.size()),
      way_ahead_(model.blocks.size(), 0.0),
      increment_(model.coefficients, 0.0),
      speed_(model.blocks.size(), 0.0),
      spin_(model.blocks.size(), 0.0),
      rule_(model.blocks.size()),
      in_impact_(model.blocks.size(), 0),
      prescribed_(model.motions.empty() ? 0 : model.blocks.size()),
      static_ways_(model.blocks.size(), 0.0),
      intrusions_(sizes_of(model.blocks)) {
  if (!model.solver.accelerators.steady_pairs) detection_.leave_out_steady_pairs();
  double mass = 0.0;
  for (const Block& block : model.blocks) {
    if (block.unknown < 0) continue;
    unknown_sizes_.push_back(2 * block.size);
    largest_radius_ = std::max(largest_radius_, block.radius);
    mass += block.mass();
  }
  // A thousandth of what lifts a mean block by its size.
  const double weight = norm(model.gravity) * mass / static_cast<double>(unknown_sizes_.size());
  if (weight > 0.0) turn_work_ = 1e-3 * weight * model.block_size;
}

void Stepper::place(State& state) {
  contact::Surface& surface = model_.surface;
  team_.for_range(model_.blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Block& block = model_.blocks[b];
      const std::size_t first = at(surface.block_begin[b]);
      double moved = 0.0, against_first = 0.0;
      Vec2 of_first;
      for_vertex_values(surface, b, block.size, &state.position[block.first], [&](std::size_t v, Vec2 x) {
        const Vec2 u = x - surface.position[v];
        if (v == first) of_first = u;
        const double squared = squared_norm(u);
        if (!(squared <= moved)) moved = squared;  // nor if it is not a number
        against_first = std::max(against_first, squared_norm(u - of_first));
        surface.position[v] = x;
      });
      state.moved[b] = std::sqrt(moved);
      way_[b] += std::sqrt(against_first);
    }
  });
}

void Stepper::start(State& state) {
  state.moved.assign(model_.blocks.size(), 0.0);
  if (model_.solver.integrator != TimeIntegration::shi) {
    state.acceleration.assign(model_.coefficients, 0.0);
    state.force.assign(model_.coefficients, 0.0);
    state.acceleration_known.assign(model_.blocks.size(), 0);
  }
  place(state);
  std::fill(state.moved.begin(), state.moved.end(), 0.0);
  detect_at_rest(state);
  for (contact::Contact& c : contacts_) {
    contact::Memory& memory = c.memory;
    if (std::abs(c.gap) > tolerances_.in_place || c.length <= tolerances_.rounding) continue;
    const contact::JointLaw& law = model_.laws[at(model_.surface.joint[at(c.edge)])];
    memory.bonded = law.may_bond();
    if (memory.bonded) {
      memory.bond_length = c.length;
      memory.offset = -c.gap;  // a gap that is there does not pull
    }
    if (!model_.in_situ) continue;
    // The joint carries the stress of the rock from the start: traction on block a is −σ n.
    const int end = model_.surface.next[at(c.edge)];
    const Vec2 where =
        lerp(model_.surface.position[at(c.edge)], model_.surface.position[at(end)], c.position);
    const block::Stress s = block::in_situ_at(model_.in_situ, where);
    const Vec2 traction{s.xx * c.normal.x + s.xy * c.normal.y, s.xy * c.normal.x + s.yy * c.normal.y};
    const double normal = std::max(0.0, -dot(traction, c.normal) * c.length);
    const double bound =
        law.fused ? HUGE_VAL
                  : contact::shear_strength(law.friction_coefficient, normal, law.cohesion * c.length);
    const double shear = std::clamp(dot(traction, c.tangent()) * c.length, -bound, bound);
    memory.normal_force = memory.bounding_force = normal;
    memory.offset = -c.gap - normal / c.normal_stiffness;
    memory.shear = shear / c.shear_stiffness;
    memory.state = normal > 0.0 ? contact::State::locked : contact::State::open;
    if (model_.solver.contact == ContactMethod::augmented_lagrangian) continue;
    memory.stored = 0.5 * (normal * normal / c.normal_stiffness + shear * shear / c.shear_stiffness);
    state.contact_energy += memory.stored;
  }
  contact::keep_memory(contacts_, state.contacts, team_);
  make_room(state);
}

void Stepper::resume(State& state) {
  const std::vector<double> moved = state.moved;
  place(state);
  state.moved = moved;
  candidates_.invalidate();
  forget_pattern();
}

std::vector<contact::Contact> Stepper::find_contacts(const State& state) {
  contact::Candidates candidates(tolerances_);
  const std::vector<double> still(model_.blocks.size(), 0.0);
  contact::CandidateList list = state.contacts;
  candidates.update(model_.surface, still, list, team_);
  std::vector<contact::Contact> contacts;
  detection_.find(model_.surface, {still, still, candidates.away(), way_}, list, team_, contacts);
  return contacts;
}

void Stepper::remove_absent(State& state) {
  candidates_.invalidate();
  history_.forget();
  std::fill(reach_.begin(), reach_.end(), 0.0);
  candidates_.update(model_.surface, reach_, state.contacts, team_);
  sum_stored_energy(state);
  forget_pattern();
  state.pattern.clear();
}

/// Bound on how far each block moves and turns in the step: twice what its velocity makes of it, four times what the body force does.
void Stepper::predict_reach(const State& state, const Drive& drive) {
  const double acceleration = norm(model_.gravity - drive.ground_acceleration) * drive.step * drive.step;
  for_blocks([&](std::size_t b) {
    const Block& block = model_.blocks[b];
    if (drive.is_static) {
      reach_[b] = 2.0 * state.moved[b];
      turn_[b] = reach_[b] / block.radius;
      return;
    }
    const std::size_t first = at(model_.surface.block_begin[b]);
    double fastest = 0.0, against_first = 0.0;
    for_vertex_values(model_.surface, b, block.size, &state.velocity[block.first],
                      [&](std::size_t v, Vec2 velocity) {
                        ahead_[v] = drive.step * velocity;
                        fastest = std::max(fastest, squared_norm(velocity));
                        against_first = std::max(against_first, squared_norm(ahead_[v] - ahead_[first]));
                      });
    speed_[b] = std::sqrt(fastest);
    way_ahead_[b] = std::sqrt(against_first);
    reach_[b] = 2.0 * speed_[b] * drive.step + 2.0 * acceleration;
    const double spin = block.pose.mean_spin(&state.velocity[block.first], &state.position[block.first]);
    turn_[b] = std::min(2.0 * std::abs(spin) * drive.step, reach_[b] / block.radius);
  });
  for (const PrescribedMotion& motion : model_.motions) {
    const std::size_t b = at(motion.block);
    const Vec2 moved = drive.prescribed[b];
    reach_[b] = norm(moved);
    for (std::size_t v = at(model_.surface.block_begin[b]); v < at(model_.surface.block_begin[b + 1]); ++v)
      ahead_[v] = moved;
  }
}

/// Contacts of blocks that stay where they are.
void Stepper::detect_at_rest(State& state) {
  std::fill(reach_.begin(), reach_.end(), 0.0);
  std::fill(turn_.begin(), turn_.end(), 0.0);
  candidates_.update(model_.surface, reach_, state.contacts, team_);
  detection_.find(model_.surface, {reach_, turn_, candidates_.away(), way_}, state.contacts, team_,
                  contacts_);
  ++contacts_version_;
}

/// Which candidates are contacts in the step; build_problem() describes them. Whether the candidates are others.
bool Stepper::detect(State& state, bool is_static) {
  const Profile::Scope scope(profile_, Phase::detection);
  const bool changed = candidates_.update(model_.surface, reach_, state.contacts, team_);
  contact::Detection::Motion motion{reach_, turn_, candidates_.away(), way_};
  if (!is_static) {
    motion.ahead = ahead_;
    motion.way_ahead = way_ahead_;
    motion.ahead_at_first = ahead_at_first_;
  }
  const std::size_t before = contacts_.size();
  contacts_.resize(detection_.find_which(model_.surface, motion, state.contacts, team_));
  if (contacts_.size() != before) ++contacts_version_;
  if (changed || !knows_pairs_) find_pairs(state);
  return changed;
}

/// Contacts that are not known yet are described on the way, while a cache has them.
void Stepper::build_problem(State& state, const Drive& drive, bool knows_contacts) {
  const Profile::Scope scope(profile_, Phase::terms);
  const auto describe = [&](const contact::Detection::OfSome& then) {
    if (!detection_.describe(model_.surface, state.contacts, team_, contacts_, then)) ++contacts_version_;
  };
  problem_.build(model_, state, drive, model_.surface, contacts_, pair_of_candidate_, team_,
                 knows_contacts ? StepProblem::ForContacts{} : describe);
  if (problem_.lacks_room()) {
    make_room(state);
    problem_.set_pairs(contacts_, pair_of_candidate_);
  }
  if (model_.solver.accelerators.earlier_attempt) earlier_attempt_.give(contacts_, problem_.springs());
}

bool Stepper::attempt(State& state, Drive& drive, const SolverOptions& options, StepReport& report) {
  choose_rules(state, drive);
  drive.rule = rule_;
  prescribe(state, drive);
  predict_reach(state, drive);
  ahead_at_first_.clear();
  constexpr int looks = 4, most_turns = 4;
  bool must_be_direct = false, same_contacts = false;
  int turns = 0;  // times the step was taken again because blocks turn
  earlier_attempt_.forget();
  turned_.clear();
  for (int look = 1;;) {
    if (!same_contacts && detect(state, drive.is_static)) earlier_attempt_.forget();
    drive.turned = turned_;
    build_problem(state, drive, same_contacts);
    linalg::BlockSolver& chosen = solver(state, drive.is_static, must_be_direct);
    if (look == 1 && turns == 0) {
      // Where there is a factor, only a curve through the last increments is a better beginning than none at all.
      if (model_.solver.accelerators.increment_history &&
          (chosen.halves() == nullptr || history_.is_smooth())) {
        history_.extrapolate(drive.step, increment_, team_);
      } else {
        std::fill(increment_.begin(), increment_.end(), 0.0);
      }
    }
    const auto meets_impacts = [&] { return look < looks && meet_impacts(state, drive); };
    const OpenCloseResult result = open_close_.solve(
        {problem_, {contacts_, contacts_version_}, chosen, options, team_, profile_}, increment_,
        options.accelerators.early_impacts ? meets_impacts : std::function<bool()>{});
    report.iterations += result.iterations;
    quiet_ = result.changes == 0;
    if (!result.finite)
      throw RunError("the forces of the step to " + std::to_string(drive.end_time) +
                     " s are not finite; a shorter time.step, order 1, or stiffer rock may help");
    if (result.linear_failed && !must_be_direct) {
      must_be_direct = true;
      continue;
    }
    measure_spin(state);
    if (!result.converged) return false;
    const Turns turned = drive.is_trial ? Turns::are_known : look_at_turns(state, drive.is_static);
    if (turned == Turns::are_too_far) return false;
    const bool moved = moved_too_far(), impact = result.given_up || meets_impacts();
    if (!moved && !impact && turned == Turns::are_known) return true;
    earlier_attempt_.keep(contacts_, problem_.springs());
    // Bonds that broke are for the next look to find again.
    same_contacts = !moved && !(impact && result.bond_broken);
    if (moved || impact) {
      // The last look is taken as it is, with the turns that its contacts know of: accept() reads them.
      if (++look > looks) return true;
      turned_.clear();
    } else {
      if (drive.is_static || ++turns > most_turns) return false;
      turned_.swap(turned_now_);
    }
  }
}

void Stepper::accept(State& state, const Drive& drive, StepReport& report) {
  account(state, drive);
  const Profile::Scope scope(profile_, Phase::update);
  remember(state, drive, report);
  if (!drive.is_static) {
    state.last_step = drive.step;
    history_.add(increment_, drive.step, quiet_, team_);
  } else {
    history_.forget();
  }
  for_blocks([&](std::size_t b) {
    const Block& block = model_.blocks[b];
    const double* d = &increment_[block.first];
    double* v = &state.velocity[block.first];
    with_known_size(block.size, [&](auto size) {
      const Integrator rule = rule_[b];
      in_lanes(2 * size, [&](int k, int count) {
        const std::size_t i = block.first + at(k);
        const Motion end = drive.is_static
                               ? Motion{}
                               : rule.end(motion(state, i, count), load_first(d + k, count), drive.step);
        store_first(v + k, end.velocity, count);
        if (state.acceleration.empty()) return;
        store_first(&state.acceleration[i], end.acceleration, count);
        store_first(&state.force[i], end.force, count);
      });
    });
    const double w = spin_[b];
    block.pose.update(w, d, &state.position[block.first], v);
    if (state.acceleration.empty()) return;
    block.pose.rotate(w, &state.acceleration[block.first]);
    block.pose.rotate(w, &state.force[block.first]);
    state.acceleration_known[b] = !drive.is_static && in_impact_[b] == 0;
  });
  move_prescribed(state, drive);
  place(state);
  account_for_turns(state, drive);
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    if (!std::isfinite(state.moved[b])) {
      throw RunError("block " + std::to_string(b) + " has no finite position after the step to " +
                     std::to_string(drive.end_time) +
                     " s, which does not converge; a shorter time.step, order 1, or solver.contact = "
                     "\"penalty\" may help");
    }
    report.max_displacement = std::max(report.max_displacement, state.moved[b]);
  }
}

void Stepper::substep(State& state, double t0, double t1, const GroundAcceleration* ground, int halvings,
                      StepReport& report) {
  Drive drive;
  drive.step = t1 - t0;
  drive.end_time = t1;
  drive.owed_share = state.last_step / drive.step;
  const bool shi = model_.solver.integrator == TimeIntegration::shi;
  if (ground != nullptr) drive.ground_acceleration = shi ? ground->mean(t0, t1) : ground->at(t1);
  const bool converged = attempt(state, drive, model_.solver, report) && !comes_inside(state);
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
