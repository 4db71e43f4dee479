#include "dynamics/step_rules.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/contact_coupling.h"
#include "coupling/impact.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

namespace {

/// m/s, speed of approach from which on blocks strike each other: the speed of a fall by 0.005 of the block size. Without gravity it is a
/// hundredth of the fastest block's speed, where that is more than noise.
double speed_of_impact(const Model& model, std::span<const double> speed, double step) {
  const double g = norm(model.gravity);
  if (g > 0.0) return 0.1 * std::sqrt(g * model.block_size);
  constexpr double share = 0.01, noise = 1e-6;  // noise: of the block size, way in a step
  return std::max(share * *std::max_element(speed.begin(), speed.end()), noise * model.block_size / step);
}

/// Contacts that may approach at `least`, m/s, or faster. A point of an edge, and a little beyond its ends, is not much faster than its
/// vertices: half an edge beyond, three times as fast at most against another.
void find_fast(const Attempt& attempt, std::span<const double> speed, double least,
               std::vector<std::size_t>& fast) {
  constexpr double rounding = 0.999;
  const bool moves_fixed_blocks = !attempt.drive.prescribed.empty();
  fast.clear();
  if (!moves_fixed_blocks && !attempt.problem.facts().has_distant &&
      3.0 * *std::max_element(speed.begin(), speed.end()) <= rounding * least)
    return;
  const auto may_be_fast = [&](std::size_t k) {
    const Row& row = attempt.problem.rows()[k];
    const contact::Contact& contact = attempt.contacts[k];
    const double beyond = std::max({0.0, -row.position, row.position - 1.0});
    return moves_fixed_blocks ||
           speed[at(contact.block_a)] + (1.0 + 2.0 * beyond) * speed[at(contact.block_b)] > rounding * least;
  };
  find_all(attempt.team, attempt.contacts.size(), contacts_worth_threads, may_be_fast, fast);
}

/// Whether contact c presses, its blocks approach faster than `least`, m/s, and the step does not resolve what its spring does to them.
bool is_impact(const Attempt& attempt, std::size_t c, double least) {
  const contact::Contact& contact = attempt.contacts[c];
  const Row& row = attempt.problem.rows()[c];
  const double step = attempt.drive.step;
  if (attempt.problem.springs().force(c).normal <= 0.0) return false;
  const Vec2 speed = attempt.problem.relative(row, attempt.state.velocity) +
                     attempt.drive.prescribed_between(contact) / step;
  if (-dot(row.normal, speed) <= least) return false;
  return attempt.model.solver.keeps_restitution ||
         contact.normal_stiffness * step * step > reduced_mass(attempt.problem.points(), contact);
}

double approach(const Attempt& attempt, std::size_t c) {
  return speed_of_approach(attempt.state, attempt.drive, attempt.problem.points(), attempt.contacts[c],
                           attempt.problem.rows()[c]);
}

/// θ with which the blocks of a contact that approach at this speed, m/s, part as the restitution says.
double theta_of_impact(const Attempt& attempt, std::size_t c, double speed) {
  const double e = attempt.model.solver.restitution,
               met = std::max(0.0, -attempt.contacts[c].depth) / (speed * attempt.drive.step);
  return met >= 0.5 * (1.0 - e) ? 1.0 : (e + met) / (1.0 - met);
}

}  // namespace

void StepRules::choose(const Model& model, const State& state, bool is_static) {
  const Integrator shi = Integrator::shi(model.solver.theta), chosen = Integrator::of(model.solver);
  const bool dynamic = !is_static && !state.acceleration_known.empty();
  for (std::size_t b = 0; b < rule_.size(); ++b)
    rule_[b] = dynamic && state.acceleration_known[b] != 0 ? chosen : shi;
  std::fill(in_impact_.begin(), in_impact_.end(), std::uint8_t{0});
  std::fill(struck_.begin(), struck_.end(), std::uint8_t{0});
}

void StepRules::slow(const Model& model, int block, double theta, bool strikes) {
  const std::size_t b = at(block);
  if (!model.moves(b)) return;
  if (strikes && struck_[b] == 0) {
    struck_[b] = 1;
    found_ = true;
  }
  if (in_impact_[b] != 0 && rule_[b].inertia() <= 1.0 + theta) return;
  in_impact_[b] = 1;
  rule_[b] = Integrator::shi(theta);
  found_ = true;
}

/// Blocks that strike each other part by one rule.
void StepRules::share_smallest(const Attempt& attempt) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const std::size_t c : fast_) {
      const std::size_t a = at(attempt.contacts[c].block_a), b = at(attempt.contacts[c].block_b);
      if (struck_[a] == 0 || struck_[b] == 0 || approach(attempt, c) <= impact_speed_) continue;
      const double of_a = rule_[a].inertia(), of_b = rule_[b].inertia();
      if (of_a == of_b) continue;
      rule_[of_a > of_b ? a : b] = rule_[of_a > of_b ? b : a];
      changed = true;
    }
  }
}

bool StepRules::meet_impacts(const Attempt& attempt, std::span<const double> speed) {
  const SolverOptions& options = attempt.model.solver;
  const double elastic = options.integrator == TimeIntegration::shi ? options.theta : 1.0;
  const bool keeps = options.keeps_restitution;
  if (attempt.drive.is_static || (options.restitution >= elastic && !keeps)) return false;
  impact_speed_ = speed_of_impact(attempt.model, speed, attempt.drive.step);
  find_fast(attempt, speed, impact_speed_, fast_);
  found_ = false;
  for (const std::size_t c : fast_) {
    if (!is_impact(attempt, c, impact_speed_)) continue;
    const double with = approach(attempt, c);
    const bool strikes =
        keeps && with > impact_speed_ && !has_met_before(attempt.contacts[c], with, attempt.drive);
    const double theta = strikes ? theta_of_impact(attempt, c, with) : options.restitution;
    slow(attempt.model, attempt.contacts[c].block_a, theta, strikes);
    slow(attempt.model, attempt.contacts[c].block_b, theta, strikes);
  }
  if (found_ && keeps) share_smallest(attempt);
  return found_;
}

}  // namespace keyblock::dynamics
