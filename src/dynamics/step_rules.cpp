// Which rule of time integration each block takes in a step.
#include <algorithm>

#include "core/index.h"
#include "dynamics/step.h"

namespace keyblock::dynamics {

/// The rule of the scenario; Shi's as long as it needs an acceleration that is not known: in the first step, after an impact.
void Stepper::choose_rules(const State& state, const Drive& drive) {
  const SolverOptions& options = model_.solver;
  const Integrator shi = Integrator::shi(options.theta);
  Integrator chosen = shi;
  if (options.integrator == TimeIntegration::average_acceleration)
    chosen = Integrator::average_acceleration();
  if (options.integrator == TimeIntegration::generalized_alpha)
    chosen = Integrator::generalized_alpha(options.spectral_radius);
  const bool dynamic = !drive.is_static && !state.acceleration_known.empty();
  for (std::size_t b = 0; b < rule_.size(); ++b)
    rule_[b] = dynamic && state.acceleration_known[b] != 0 ? chosen : shi;
  std::fill(in_impact_.begin(), in_impact_.end(), std::uint8_t{0});
}

/// m/s, speed of approach from which on blocks strike each other: that of a fall by 0.005 of the block size. Without gravity it is a
/// hundredth of the fastest block's speed, where that is more than noise.
double Stepper::impact_speed(const Drive& drive) const {
  const double g = norm(model_.gravity);
  if (g > 0.0) return 0.1 * std::sqrt(g * model_.block_size);
  constexpr double share = 0.01, noise = 1e-6;  // noise: of the block size, way in a step
  return std::max(share * *std::max_element(speed_.begin(), speed_.end()),
                  noise * model_.block_size / drive.step);
}

/// Impacts that the step does not resolve: the blocks come to rest against each other within it, D ≈ 0, and the rule
/// v ← (1+θ)D/Δt − θv would send them back with θ times the speed they came with. Lowers θ of blocks that are pressed upon
/// while they approach faster than the speed of an impact; true when there is a new one.
bool Stepper::meet_impacts(const State& state, const Drive& drive) {
  const SolverOptions& options = model_.solver;
  const double elastic = options.integrator == TimeIntegration::shi ? options.theta : 1.0;
  if (drive.is_static || options.restitution >= elastic) return false;
  // Multipliers are stiffer than any spring: what is left of a velocity into a contact would ring for ever.
  const bool rigid = options.contact == ContactMethod::augmented_lagrangian;
  const double least =
      rigid ? std::min(impact_speed(drive), 1e-4 * norm(model_.gravity) * drive.step) : impact_speed(drive);
  // A point of an edge, and a little beyond its ends, is not much faster than its vertices: half an edge beyond, three times as fast at
  // most against another.
  if (prescribed_.empty() && !problem_.has_distant() &&
      3.0 * *std::max_element(speed_.begin(), speed_.end()) <= 0.999 * least)
    return false;
  const auto may_be_fast = [&](std::size_t k) {
    const StepProblem::Row& row = problem_.rows()[k];
    const double beyond = std::max({0.0, -row.position, row.position - 1.0});
    return !prescribed_.empty() ||
           speed_[at(contacts_[k].block_a)] + (1.0 + 2.0 * beyond) * speed_[at(contacts_[k].block_b)] >
               0.999 * least;
  };
  std::vector<std::size_t> fast;
  find_all(team_, contacts_.size(), contacts_worth_threads, may_be_fast, fast);
  bool any = false;
  for (const std::size_t c : fast) {
    const StepProblem::Row& row = problem_.rows()[c];
    if (problem_.springs().force(c).normal <= 0.0) continue;
    const Vec2 speed =
        problem_.relative(row, state.velocity) + drive.prescribed_between(contacts_[c]) / drive.step;
    if (-dot(row.normal, speed) <= least) continue;
    if (!rigid &&
        contacts_[c].normal_stiffness * drive.step * drive.step <= problem_.reduced_mass(contacts_[c]))
      continue;
    for (const int b : {contacts_[c].block_a, contacts_[c].block_b}) {
      if (!model_.moves(at(b)) || in_impact_[at(b)] != 0) continue;
      in_impact_[at(b)] = 1;
      rule_[at(b)] = Integrator::shi(options.restitution);
      any = true;
    }
  }
  return any;
}

}  // namespace keyblock::dynamics
