#include "solve/law_updates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "coupling/contact_coupling.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

using Force = SpringArray::Force;

/// Two sums over the same.
struct Sums {
  Lanes first{}, second{};
  Sums& operator+=(const Sums& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

/// Calls changes(c) for the contacts whose bond may break. Whether it returned true for any.
template <typename Changes>
bool for_bonds(const StepSystem& system, const Changes& changes) {
  bool any = false;
  for (std::size_t c = 0; system.problem.facts().may_break && c < system.contacts.contacts.size(); ++c) {
    const contact::Contact& contact = system.contact(c);
    if (contact.memory.bonded && !contact.fused) any = changes(c) || any;
  }
  return any;
}

/// By what a bond breaks that is about to.
contact::BreakMode mode_of_break(const contact::Contact& contact, bool is_pulled) {
  using enum contact::BreakMode;
  if (is_pulled) return tension;
  const bool loses = !contact.keeps_cohesion() || contact.loss.is_any() || contact.tension > 0.0;
  return loses ? shear : none;  // of ideal plasticity slip takes nothing
}

}  // namespace

void LawUpdates::begin() {
  bound_steps_.clear();
  bound_updates_ = 0;
  bound_error_ = HUGE_VAL;
  bound_damping_ = 1.0;
  limit_updates_ = 0;
}

/// N per thickness, per block: what friction holds it with where its contacts slide.
void LawUpdates::sum_bounds(const StepSystem& system) {
  const SpringArray& springs = system.springs();
  sliding_bound_.assign(system.problem.model().bodies(), 0.0);
  for (std::size_t c = 0; c < springs.size(); ++c) {
    if (springs.slipped[c] == 0.0) continue;
    sliding_bound_[at(system.contact(c).block_a)] += springs.bound[c];
    sliding_bound_[at(system.contact(c).block_b)] += springs.bound[c];
  }
}

/// Whether a contact that slid, and whose spring holds from where its velocity ends, would not stay there: it slides the other way at the
/// end of the step, or what it has to hold once the velocity is gone is more than friction can.
bool LawUpdates::reverses(const StepSystem& system, std::size_t c) const {
  const SpringArray& springs = system.springs();
  const double slipped = springs.slipped[c], shear = springs.force(c).shear;
  if (springs.branch[c].shear != SpringArray::Shear::held) return shear * slipped < 0.0;
  const contact::Contact& contact = system.contact(c);
  const double of_both = std::max(sliding_bound_[at(contact.block_a)], sliding_bound_[at(contact.block_b)]);
  // This contact brings its share of the mass to rest, from a velocity that `slipped` is the way of (with θ = 1 exactly).
  const double share = of_both > 0.0 ? springs.bound[c] / of_both : 1.0,
               holds = shear - share * inertia_between(system.problem, contact) * slipped;
  return holds * slipped < 0.0 && std::abs(holds) > springs.bound[c];
}

bool LawUpdates::reverse_sliding(const StepSystem& system, Iterate& iterate, double tolerance) {
  SpringArray& springs = system.springs();
  reversed_.clear();
  double change = 0.0;
  bool knows_bounds = false;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    const double slipped = springs.slipped[c];
    if (slipped == 0.0 ||
        (springs.branch[c].shear != SpringArray::Shear::held && springs.force(c).shear * slipped > 0.0))
      continue;
    if (!std::exchange(knows_bounds, true)) sum_bounds(system);
    if (!reverses(system, c)) continue;
    const double gained =
        springs.force_at(c, springs.y[c], springs.w[c] + slipped).shear - springs.force(c).shear;
    if (gained == 0.0) {
      springs.hold_from_start(c);
      continue;
    }
    reversed_.push_back(c);
    change += gained * gained;
  }
  if (reversed_.empty()) return false;
  double scale = 0.0;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    if (springs.friction[c] >= 0.0) scale += springs.bound[c] * springs.bound[c];
  }
  if (change <= tolerance * tolerance * scale) return false;
  for (const std::size_t c : reversed_) {
    iterate.change_spring(system, c, [&] { springs.hold_from_start(c); });
  }
  return true;
}

bool LawUpdates::update_bounds(const StepSystem& system, Iterate& iterate, double tolerance) {
  SpringArray& springs = system.springs();
  const auto [errors, scales] =
      sum_of<Sums>(system.team, (springs.size() + lane_count - 1) / lane_count,
                   contacts_worth_threads / lane_count, [&](std::size_t group) {
                     const std::size_t c = group * lane_count;
                     const auto at_c = [&](const std::vector<double>& numbers) { return load(&numbers[c]); };
                     const Lanes zero{}, normal = springs.bearings(c), w = at_c(springs.w);
                     // Only what the new bound does to the shear force counts: a contact that holds under both bounds is settled.
                     const Lanes wanted = springs.strengths(c, normal),
                                 change = contact::shear_spring(at_c(springs.ks), wanted).force(w) -
                                          springs.shear_laws(c).force(w);
                     const auto counts = (at_c(springs.friction) >= zero) & first_lanes(springs.size() - c);
                     return Sums{where(counts, change * change, zero), where(counts, wanted * wanted, zero)};
                   });
  const double error = sum(errors), scale = sum(scales);
  const double ratio = scale > 0.0 ? std::sqrt(error / scale) : 0.0;
  if (ratio <= tolerance) return false;
  const auto bound = [&](std::size_t c) { return springs.strength(c, springs.bearing(c)); };
  const bool first = bound_steps_.empty();
  bound_steps_.resize(springs.size());
  // Contacts may hand bounds on in a ring, where a mechanism begins to move, and the share of each is wrong then. If many updates of
  // a static step have not settled it, all go half as far whenever the error does not fall by a half.
  if (system.problem.is_static() && ++bound_updates_ > step_numbers::undamped_updates &&
      ratio > 0.5 * bound_error_)
    bound_damping_ = std::max(0.5 * bound_damping_, step_numbers::least_damping);
  bound_error_ = ratio;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    if (springs.friction[c] < 0.0) continue;
    const double missing = bound(c) - springs.bound[c];
    KnownStep& last = bound_steps_[c];
    // A bound that was set otherwise since has come to where it is on a way of its own.
    const bool is_known = !first && last.bound == springs.bound[c];
    const double share = bound_damping_ * (is_known ? last.step.share(missing) : 1.0);
    iterate.change_spring(system, c, [&] { springs.set_bound(c, springs.bound[c] + share * missing); });
    last = {{missing, share * missing}, springs.bound[c]};
  }
  return true;
}

bool LawUpdates::renew_bonds(const StepSystem& system, Iterate& iterate) {
  using step_numbers::settled_strength;
  SpringArray& springs = system.springs();
  return for_bonds(system, [&](std::size_t c) {
    if (system.contact(c).is_ductile)
      return false;  // its bound is renewed as that of any contact that slides
    const double strength = springs.strength(c, springs.bearing(c)), bound = springs.bound[c],
                 elastic = std::abs(springs.ks[c] * springs.w[c]);
    if (elastic <= std::min(strength, bound) || std::abs(strength - bound) <= settled_strength * bound)
      return false;
    iterate.change_spring(system, c, [&] { springs.set_bound(c, strength); });
    return true;
  });
}

bool LawUpdates::break_bonds(const StepSystem& system, Iterate& iterate) {
  SpringArray& springs = system.springs();
  return for_bonds(system, [&](std::size_t c) {
    contact::Contact& contact = system.contacts.contacts[c];
    const double normal = springs.force(c).normal;
    // At the end of a face the stress decides, not the force that the end has of all of the face.
    const double pulled = springs.faces.has(c)
                              ? -contact.normal_stiffness * springs.y[c] / springs.faces.elastic_share(c)
                              : -normal;
    const bool keeps_cohesion = contact.keeps_cohesion();
    const bool is_pulled = pulled > contact.tension && !(keeps_cohesion && contact.tension == 0.0);
    const bool is_spared = keeps_cohesion && !system.problem.model().joints_wear;
    const bool holds =
        contact.is_ductile || is_spared || std::abs(springs.ks[c] * springs.w[c]) <= springs.bound[c];
    if (!is_pulled && holds) return false;
    contact.broke = mode_of_break(contact, is_pulled);
    // A joint with residual strength keeps some cohesion until it has opened (ContactCoupling::account).
    if (!keeps_cohesion) {
      contact.memory.bonded = false;
    } else if (is_pulled) {
      contact.tear();
    } else {
      contact.wear_out();
    }
    iterate.change_spring(system, c, [&] {
      springs.constant[c] = keeps_cohesion ? contact.cohesion : 0.0;
      springs.friction[c] = contact.friction_coefficient;
      springs.set_law(c,
                      contact::shear_strength(contact.friction_coefficient, std::max(0.0, springs.bearing(c)),
                                              springs.constant[c]),
                      false);
    });
    iterate.let_go_of_faces(system, c);
    return true;
  });
}

bool LawUpdates::change_couplings(const StepSystem& system, Iterate& iterate) {
  const StepProblem& problem = system.problem;
  if (!problem.facts().may_change_laws) return false;
  changes_.clear();
  for (std::size_t k = 0; k < problem.parts().size(); ++k) {
    const auto [coupling, first] = problem.parts()[k];
    coupling->change_laws(problem, first, problem.memory(k), changes_);
  }
  std::ranges::stable_sort(changes_, std::ranges::greater{}, &LawChange::excess);
  const auto limits = std::ranges::find_if(changes_, [](const LawChange& c) { return !(c.excess > 0.0); });
  const auto events = static_cast<std::size_t>(limits - changes_.begin());
  // What breaks unloads what is near to it, or loads it: so few at once that those near are asked again.
  std::size_t count = events == 0 ? 0 : std::max<std::size_t>(1, events / step_numbers::events_at_once);
  if (events == 0 && limit_updates_++ < step_numbers::most_limit_updates) count = changes_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const LawChange& change = changes_[i];
    iterate.change_spring(system, change.row, [&] {
      SpringArray& springs = system.springs();
      springs.set_limits(change.row, change.least, change.largest);
      if (change.friction < 0.0) return;
      springs.low[change.row] = 0.0;
      springs.friction[change.row] = change.friction;
    });
  }
  return count > 0;
}

}  // namespace keyblock::dynamics
