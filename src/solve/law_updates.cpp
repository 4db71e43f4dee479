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

/// n·r and t·r of a closed contact, except for what multipliers have added: how deep it lies in, m, and how far it has drifted from where
/// it holds, m.
Vec2 violation(const StepSystem& system, std::size_t c) {
  const SpringArray& springs = system.springs();
  const Row& row = system.row(c);
  const contact::Contact& contact = system.contact(c);
  const double normal = springs.y0[c] - springs.y[c] + dot(row.normal, row.moved),
               slip = springs.w[c] - springs.w0[c] + dot(row.tangent(), row.moved);
  const double penetration = -(contact.gap + normal) - std::max(0.0, contact.memory.offset);
  return {penetration,
          springs.branch[c].shear == SpringArray::Shear::held ? contact.memory.drift + slip : 0.0};
}

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

}  // namespace

void LawUpdates::begin() {
  bound_steps_.clear();
  bound_updates_ = 0;
  bound_error_ = HUGE_VAL;
  bound_damping_ = 1.0;
  worst_ = HUGE_VAL;
  stalls_ = 0;
  multiplier_share_ = step_numbers::first_multiplier_share;
}

/// N per thickness, per block: what friction holds it with where its contacts slide.
void LawUpdates::sum_bounds(const StepSystem& system) {
  const SpringArray& springs = system.springs();
  sliding_bound_.assign(system.problem.model().blocks.size(), 0.0);
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
    iterate.change_spring(system, c, [&] { springs.bound[c] += share * missing; });
    last = {{missing, share * missing}, springs.bound[c]};
  }
  return true;
}

/// Adds the shifts, times a share, to the forces that belong to no displacement.
void LawUpdates::shift_forces(const StepSystem& system, Iterate& iterate, double share) {
  SpringArray& springs = system.springs();
  for (std::size_t c = 0; c < springs.size(); ++c) {
    if (shift_[c] == Vec2{}) continue;
    iterate.change_spring(system, c, [&] { springs.shift(c, share * shift_[c].x, share * shift_[c].y); });
  }
}

bool LawUpdates::augment(const StepSystem& system, Iterate& iterate, double tolerance) {
  const SpringArray& springs = system.springs();
  violation_.assign(springs.size(), {});
  double worst = 0.0;
  for (std::size_t c = 0; c < system.contacts.contacts.size(); ++c) {
    if (!springs.branch[c].closed) continue;
    violation_[c] = violation(system, c);
    worst = std::max({worst, std::abs(violation_[c].x), std::abs(violation_[c].y)});
  }
  if (worst <= tolerance) return false;
  if (std::isinf(worst_)) worst_without_ = worst;
  // What runs away, far beyond what springs without multipliers leave, was shifted by too much: it is taken back, except for what fits.
  if (worst > worst_ && worst > std::max(4.0 * worst_without_,
                                         step_numbers::most_transient * system.problem.model().block_size)) {
    const double left = std::min(0.25, worst_ / worst);
    multiplier_share_ *= left;
    shift_forces(system, iterate, left - 1.0);
    for (Vec2& shift : shift_) shift = left * shift;
    stalls_ = 0;
    return true;
  }
  // What grows is overshot: more contacts share a block, or move softer modes of it, than the share was meant for.
  const bool overshoots = worst > worst_ && multiplier_share_ > step_numbers::least_multiplier_share;
  if (overshoots) multiplier_share_ /= std::min(1.0 + worst / worst_, 4.0);
  // Where blocks have more constraints than unknowns the rest cannot be taken out: three updates in a row gain nothing.
  stalls_ = !overshoots && worst > 0.97 * worst_ ? stalls_ + 1 : 0;
  worst_ = worst;
  if (stalls_ == 3) return false;
  shift_.assign(springs.size(), {});
  for (std::size_t c = 0; c < system.contacts.contacts.size(); ++c) {
    if (!springs.branch[c].closed) continue;
    const double inertia = multiplier_share_ * inertia_between(system.problem, system.contact(c));
    // A multiplier pushes, or is none: a negative one would let the blocks penetrate until they have made up for it.
    const double multiplier =
        springs.is_tensile(c) ? HUGE_VAL : std::max(0.0, springs.y[c] - violation_[c].x);
    shift_[c] = {std::max(violation_[c].x * (1.0 + inertia / springs.kn[c]), -multiplier),
                 violation_[c].y * (1.0 + inertia / springs.ks[c])};
  }
  shift_forces(system, iterate, 1.0);
  return true;
}

bool LawUpdates::renew_bonds(const StepSystem& system, Iterate& iterate) {
  using step_numbers::settled_strength;
  SpringArray& springs = system.springs();
  return for_bonds(system, [&](std::size_t c) {
    const double strength = springs.strength(c, springs.bearing(c)), bound = springs.bound[c],
                 elastic = std::abs(springs.ks[c] * springs.w[c]);
    if (elastic <= std::min(strength, bound) || std::abs(strength - bound) <= settled_strength * bound)
      return false;
    iterate.change_spring(system, c, [&] { springs.bound[c] = strength; });
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
    const bool holds = std::abs(springs.ks[c] * springs.w[c]) <= springs.bound[c];
    if (pulled <= contact.tension && holds) return false;
    contact.memory.bonded = false;
    iterate.change_spring(system, c, [&] {
      springs.constant[c] = 0.0;
      springs.set_law(c, contact.friction_coefficient * std::max(0.0, springs.bearing(c)), false);
    });
    iterate.let_go_of_faces(system, c);
    return true;
  });
}

}  // namespace keyblock::dynamics
