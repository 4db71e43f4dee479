// What a solution does to the laws of its springs: bounds of friction, bonds, multipliers, contacts that turn round.
#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/open_close.h"

namespace keyblock::dynamics {

namespace {

constexpr double least_share = 0.25;          // of the way to a new bound
constexpr int undamped_updates = 8;           // of bounds, before all contacts go a smaller share …
constexpr double least_damping = 1.0 / 64.0;  // … and how small it gets
constexpr double least_multiplier_share = 1e-3;
// Of the block size: penetration that updates of multipliers may leave on their way.
constexpr double most_transient = 1e-3;

/// Two sums over the same.
struct Sums {
  Lanes first{}, second{};
  Sums& operator+=(const Sums& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

}  // namespace

/// Takes over what a change of a spring, which had the force `before`, does to its piece and to the gradient.
void OpenClose::take_force(const StepProblem& problem, std::size_t c, Force before) {
  springs_->piece[c] = springs_->piece_at(c, springs_->y[c], springs_->w[c]);
  add_force(problem, c, springs_->force(c) - before, 1.0, gradient_);
  gradient_changed();
}

/// N per thickness, per block: what friction holds it with where its contacts slide.
void OpenClose::sum_bounds(const StepProblem& problem) {
  sliding_bound_.assign(problem.blocks(), 0.0);
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (springs_->slipped[c] == 0.0) continue;
    sliding_bound_[static_cast<std::size_t>(contacts_[c].block_a)] += springs_->bound[c];
    sliding_bound_[static_cast<std::size_t>(contacts_[c].block_b)] += springs_->bound[c];
  }
}

/// Whether a contact that slid, and whose spring holds from where its velocity ends, would not stay there: it slides the other way at the
/// end of the step, or what it has to hold once the velocity is gone is more than friction can.
bool OpenClose::reverses(const StepProblem& problem, std::size_t c) const {
  const double slipped = springs_->slipped[c], shear = springs_->force(c).shear;
  if (springs_->piece[c].shear != SpringArray::Shear::held) return shear * slipped < 0.0;
  const contact::Contact& contact = contacts_[c];
  const double of_both = std::max(sliding_bound_[static_cast<std::size_t>(contact.block_a)],
                                  sliding_bound_[static_cast<std::size_t>(contact.block_b)]);
  // This contact brings its share of the mass to rest, from a velocity that `slipped` is the way of (with θ = 1 exactly).
  const double share = of_both > 0.0 ? springs_->bound[c] / of_both : 1.0,
               holds = shear - share * problem.inertia_between(contact) * slipped;
  return holds * slipped < 0.0 && std::abs(holds) > springs_->bound[c];
}

/// A spring that holds from where the velocity ends (StepProblem::ways_to_rest) would turn the friction of a contact that does not rest there
/// always too late or too early. Such contacts get springs that turn where the way of the step does, if that changes the shear forces by
/// more than `tolerance` of the bounds (L2 over all contacts). Whether they did.
bool OpenClose::let_reverse(const StepProblem& problem, double tolerance) {
  reversed_.clear();
  double change = 0.0;
  bool knows_bounds = false;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    const double slipped = springs_->slipped[c];
    if (slipped == 0.0 ||
        (springs_->piece[c].shear != SpringArray::Shear::held && springs_->force(c).shear * slipped > 0.0))
      continue;
    if (!std::exchange(knows_bounds, true)) sum_bounds(problem);
    if (!reverses(problem, c)) continue;
    const double gained =
        springs_->force_at(c, springs_->y[c], springs_->w[c] + slipped).shear - springs_->force(c).shear;
    if (gained == 0.0) {
      springs_->hold_from_start(c);
      continue;
    }
    reversed_.push_back(c);
    change += gained * gained;
  }
  if (reversed_.empty()) return false;
  double scale = 0.0;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (springs_->friction[c] >= 0.0) scale += springs_->bound[c] * springs_->bound[c];
  }
  if (change <= tolerance * tolerance * scale) return false;
  for (const std::size_t c : reversed_) {
    const Force before = springs_->force(c);
    springs_->hold_from_start(c);
    take_force(problem, c, before);
  }
  return true;
}

bool OpenClose::update_bounds(StepProblem& problem, double tolerance) {
  const auto [errors, scales] = sum_of<Sums>(
      *team_, (springs_->size() + lane_count - 1) / lane_count, contacts_worth_threads / lane_count,
      [&](std::size_t group) {
        const std::size_t c = group * lane_count;
        const auto at_c = [&](const std::vector<double>& numbers) { return load(&numbers[c]); };
        const Lanes zero{}, y = at_c(springs_->y), mu = at_c(springs_->friction);
        const Lanes normal = where(y > at_c(springs_->floor), at_c(springs_->kn) * y, zero);
        // Only what the new bound does to the shear force counts: a contact that holds under both bounds is settled.
        const Lanes wanted = contact::shear_strength(mu, normal, at_c(springs_->constant)),
                    elastic = at_c(springs_->ks) * at_c(springs_->w), bound_now = at_c(springs_->bound),
                    change = largest(least(elastic, wanted), -wanted) -
                             largest(least(elastic, bound_now), -bound_now);
        const auto counts = (mu >= zero) & first_lanes(springs_->size() - c);
        return Sums{where(counts, change * change, zero), where(counts, wanted * wanted, zero)};
      });
  const double error = sum(errors), scale = sum(scales);
  const double ratio = scale > 0.0 ? std::sqrt(error / scale) : 0.0;
  if (ratio <= tolerance) return false;
  const auto bound = [&](std::size_t c) {
    return contact::shear_strength(springs_->friction[c], springs_->force(c).normal, springs_->constant[c]);
  };
  // Two contacts of a wedge may hand a bound to and fro for ever: a contact goes the share of the way that the last update
  // shows to be right for it (secant).
  const bool first = bound_steps_.empty();
  bound_steps_.resize(springs_->size());
  // More of them may do so in a ring, where a mechanism begins to move, and the share of each is wrong then. If many updates of
  // a static step have not settled it, all go half as far whenever the error does not fall by a half.
  if (problem.is_static() && ++bound_updates_ > undamped_updates && ratio > 0.5 * bound_error_)
    bound_damping_ = std::max(0.5 * bound_damping_, least_damping);
  bound_error_ = ratio;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (springs_->friction[c] < 0.0) continue;
    const double missing = bound(c) - springs_->bound[c];
    const double gained = bound_steps_[c].missing - missing;
    double share = 1.0;
    if (!first && bound_steps_[c].taken * gained > 0.0)
      share = std::clamp(bound_steps_[c].taken / gained, least_share, 1.0);
    share *= bound_damping_;
    bound_steps_[c] = {missing, share * missing};
    const Force before = springs_->force(c);
    springs_->bound[c] += share * missing;
    take_force(problem, c, before);
  }
  return true;
}

/// n·r and t·r of a closed contact, except for what multipliers have added: how deep it lies in, m, and how far it has drifted from where
/// it holds, m.
Vec2 OpenClose::violation(const StepProblem& problem, const contact::Contact& contact, std::size_t c) const {
  const StepProblem::Row& row = problem.rows()[c];
  const double normal = springs_->y0[c] - springs_->y[c] + dot(row.normal, row.moved),
               slip = springs_->w[c] - springs_->w0[c] + dot(row.tangent(), row.moved);
  const double penetration = -(contact.gap + normal) - std::max(0.0, contact.memory.offset);
  return {penetration, springs_->piece[c].shear == Shear::held ? contact.memory.drift + slip : 0.0};
}

/// Adds the shifts, times a share, to the forces that belong to no displacement.
void OpenClose::shift_forces(const StepProblem& problem, double share) {
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (shift_[c] == Vec2{}) continue;
    const Force before = springs_->force(c);
    springs_->shift(c, share * shift_[c].x, share * shift_[c].y);
    take_force(problem, c, before);
  }
}

/// Uzawa's iteration with a step between the stiffness of the spring and what the inertia of the blocks adds to it. False when
/// nothing penetrates and no contact that holds has drifted by more than `tolerance`, m, or when that stalls; springs are then
/// left alone.
bool OpenClose::augment(StepProblem& problem, std::span<contact::Contact> contacts, double tolerance) {
  std::vector<Vec2> off(springs_->size());
  double worst = 0.0;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!springs_->piece[c].closed) continue;
    off[c] = violation(problem, contacts[c], c);
    worst = std::max({worst, std::abs(off[c].x), std::abs(off[c].y)});
  }
  if (worst <= tolerance) return false;
  // What grows is overshot: more contacts share a block, or move softer modes of it, than the share was meant for. Where it runs
  // away, far beyond what springs without multipliers leave, most of the last shift is taken back.
  if (std::isinf(worst_)) worst_without_ = worst;
  const bool overshoots = worst > worst_ && multiplier_share_ > least_multiplier_share;
  if (overshoots) {
    const double left = 1.0 / std::min(1.0 + worst / worst_, 4.0);
    multiplier_share_ *= left;
    stalls_ = 0;
    if (worst > std::max(4.0 * worst_without_, most_transient * problem.block_size())) {
      shift_forces(problem, left - 1.0);
      for (Vec2& shift : shift_) shift = left * shift;
      return true;
    }
  }
  // Where blocks have more constraints than unknowns the rest cannot be taken out: three updates in a row gain nothing.
  stalls_ = !overshoots && worst > 0.97 * worst_ ? stalls_ + 1 : 0;
  worst_ = worst;
  if (stalls_ == 3) return false;
  shift_.assign(springs_->size(), {});
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!springs_->piece[c].closed) continue;
    const double inertia = multiplier_share_ * problem.inertia_between(contacts[c]);
    // A multiplier pushes, or is none: a negative one would let the blocks penetrate until they have made up for it.
    const double multiplier = springs_->is_tensile(c) ? HUGE_VAL : std::max(0.0, springs_->y[c] - off[c].x);
    shift_[c] = {std::max(off[c].x * (1.0 + inertia / springs_->kn[c]), -multiplier),
                 off[c].y * (1.0 + inertia / springs_->ks[c])};
  }
  shift_forces(problem, 1.0);
  return true;
}

/// Bonds whose shear force passes what they bear now, or what the step began with, where these differ, get what they bear now. Whether
/// there are any: a bound of before the load came would have them break that hold.
bool OpenClose::renew_bonds(const StepProblem& problem, std::span<const contact::Contact> contacts) {
  constexpr double settled = 1e-3;
  if (!problem.may_break()) return false;
  bool any = false;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!contacts[c].memory.bonded || contacts[c].fused) continue;
    const Force before = springs_->force(c);
    const double strength =
                     contact::shear_strength(springs_->friction[c], before.normal, springs_->constant[c]),
                 bound = springs_->bound[c], elastic = std::abs(springs_->ks[c] * springs_->w[c]);
    if (elastic <= std::min(strength, bound) || std::abs(strength - bound) <= settled * bound) continue;
    springs_->bound[c] = strength;
    take_force(problem, c, before);
    any = true;
  }
  return any;
}

bool OpenClose::break_bonds(const StepProblem& problem, std::span<contact::Contact> contacts) {
  if (!problem.may_break()) return false;
  bool any = false;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!contacts[c].memory.bonded || contacts[c].fused) continue;
    const Force before = springs_->force(c);
    const bool holds = std::abs(springs_->ks[c] * springs_->w[c]) <= springs_->bound[c];
    if (-before.normal <= contacts[c].tension && holds) continue;
    contacts[c].memory.bonded = false;
    springs_->constant[c] = 0.0;
    springs_->set_law(c, contacts[c].friction_coefficient * std::max(0.0, before.normal), false);
    take_force(problem, c, before);
    any = true;
  }
  return any;
}

}  // namespace keyblock::dynamics
