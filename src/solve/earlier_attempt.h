#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "contact/detection.h"
#include "coupling/spring_array.h"

namespace keyblock::dynamics {

/// Accelerator: the springs at the end of an attempt at a step that has to be taken again, with other rules of integration, a longer reach or
/// other gaps. Their branches and friction bounds are nearer to those of the next attempt than what contacts remember of the last step.
class EarlierAttempt {
 public:
  void forget() { candidates_.clear(); }

  void keep(std::span<const contact::Contact> contacts, const SpringArray& springs) {
    candidates_.clear();
    for (const contact::Contact& c : contacts) candidates_.push_back(c.candidate);
    branch_ = springs.branch;
    bound_ = springs.bound;
    slipped_ = springs.slipped;
    bounds_updated_ = springs.bounds_updated;
  }

  /// Bonds are begun anew: that they broke is for the next attempt to find.
  void give(std::span<const contact::Contact> contacts, SpringArray& springs) const {
    if (candidates_.empty()) return;
    std::size_t k = 0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      while (k < candidates_.size() && candidates_[k] < contacts[c].candidate) ++k;
      if (k == candidates_.size()) break;
      if (candidates_[k] != contacts[c].candidate || contacts[c].memory.bonded) continue;
      springs.set_branch(c, branch_[k]);
      springs.set_bound(c, bound_[k]);
      if (slipped_[k] == 0.0) springs.hold_from_start(c);
    }
    springs.bounds_updated = bounds_updated_;
  }

 private:
  std::vector<int> candidates_;  ///< of its contacts; empty: there was no earlier attempt
  std::vector<SpringArray::Branch> branch_;
  std::vector<double> bound_, slipped_;
  bool bounds_updated_ = false;
};

}  // namespace keyblock::dynamics
