#include "solve/followed_bounds.h"

#include <algorithm>
#include <cmath>

#include "contact/law.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

void FollowedBounds::choose(std::vector<Change>& changes) {
  std::erase_if(changes, [&](const Change& change) {
    return std::ranges::find(contacts_, change.contact) != contacts_.end();
  });
  std::ranges::sort(changes, [](const Change& a, const Change& b) {
    return a.squared != b.squared ? a.squared > b.squared : a.contact < b.contact;
  });
  double rest = 0.0;
  for (const Change& change : changes) rest += change.squared;
  const double enough = step_numbers::not_followed * step_numbers::not_followed * rest;
  for (const Change& change : changes) {
    if (rest <= enough || contacts_.size() == step_numbers::most_followed) break;
    contacts_.push_back(change.contact);
    rest -= change.squared;
  }
}

/// By how much bounds are wrong. Returns how much that is of them all (L2), of what changes shear forces.
double FollowedBounds::find_missing(const StepSystem& system, std::span<const Springs> springs,
                                    std::span<const Corrections::Law> laws, const Corrections& corrections) {
  const std::span<const double> stretch = corrections.stretches();
  double error = 0.0, scale = 0.0;
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const auto [normal, shear] = springs[k];
    const SpringArray::Law& law = laws[shear].spring;
    const double wanted = system.springs().strength(contacts_[k], laws[normal].spring.force(stretch[normal]));
    const double change =
        contact::shear_spring(law.stiffness, wanted).force(stretch[shear]) - law.force(stretch[shear]);
    missing_[k] = wanted - law.high;
    error += change * change;
    scale += wanted * wanted;
  }
  return scale > 0.0 ? std::sqrt(error / scale) : 0.0;
}

/// Each bound goes the share of its way that its last step shows to be right, and all of them `damping` of that.
void FollowedBounds::take_steps(std::span<const Springs> springs, std::span<Corrections::Law> laws,
                                double damping) {
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const double share = damping * steps_[k].share(missing_[k]);
    steps_[k] = {missing_[k], share * missing_[k]};
    SpringArray::Law& law = laws[springs[k].shear].spring;
    law = contact::shear_spring(law.stiffness, law.high + share * missing_[k]);
  }
}

bool FollowedBounds::settle(const StepSystem& system, std::span<const Springs> springs,
                            std::span<Corrections::Law> laws, Corrections& corrections) {
  const double enough = step_numbers::followed_share * system.options.bound_accuracy;
  missing_.assign(springs.size(), 0.0);
  steps_.assign(springs.size(), {});
  double before = HUGE_VAL, damping = 1.0;
  for (int round = 0; round < step_numbers::most_followed_rounds; ++round) {
    const double error = find_missing(system, springs, laws, corrections);
    if (error <= enough) break;
    if (round >= step_numbers::undamped_updates && error > 0.5 * before)
      damping = std::max(0.5 * damping, step_numbers::least_damping);
    before = error;
    take_steps(springs, laws, damping);
    if (!corrections.solve(laws)) return false;
  }
  return true;
}

}  // namespace keyblock::dynamics
