// The factor of a step in the steps that follow: whether it is tried, and whether it did.
#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "core/index.h"
#include "dynamics/open_close.h"

namespace keyblock::dynamics {

namespace {

constexpr int longest_wait = 32;  // steps without a kept factor after failures

/// Vertex and edge.
std::pair<int, int> key_of(const contact::Contact& contact) {
  return {contact.vertex, contact.edge};
}

}  // namespace

/// Notes what the matrix of this step is for; it has no springs yet.
void OpenClose::begin_factor(const StepProblem& problem, linalg::BlockSolver& solver) {
  factor_.normal_stiffness.resize(contacts_.size());
  factor_.shear_stiffness.resize(contacts_.size());
  factor_.places.resize(contacts_.size());
  factor_.held.assign(problem.inertias().size(), 0);
  free_.clear();
  kept_ = false;
  factor_.solver = nullptr;
  if (!solver.serves_later_steps()) return;
  factor_.solver = &solver;
  note_contacts();
  factor_.inertia.assign(problem.inertias().begin(), problem.inertias().end());
}

/// What is known of the matrix at hand, by contact, is of the contacts of this step.
void OpenClose::note_contacts() {
  factor_.contacts.resize(contacts_.size());
  std::ranges::transform(contacts_, factor_.contacts.begin(), key_of);
  factor_.version = contacts_version_;
}

/// Whether the factor at hand was made for the inertia of this step.
bool OpenClose::fits_factor(const StepProblem& problem, const linalg::BlockSolver& solver) const {
  return factor_.solver == &solver && problem.has_weights() &&
         std::ranges::equal(factor_.inertia, problem.inertias());
}

/// What is known of the matrix at hand by contact goes over to the contacts of this step: those that came have no spring in it, those that
/// went had none. False when one had, or is corrected.
bool OpenClose::carry_contacts() {
  constexpr std::size_t gone = SIZE_MAX, most_gone = 64;  // in a row
  if (contacts_version_ != 0 && factor_.version == contacts_version_) return true;
  const std::vector<std::pair<int, int>>& before = factor_.contacts;
  std::vector<std::size_t> now(before.size(), gone);
  std::size_t next = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t last = std::min(next + most_gone, before.size());
    for (std::size_t k = next; k < last; ++k) {
      if (before[k] != key_of(contacts_[c])) continue;
      now[k] = c;
      next = k + 1;
      break;
    }
  }
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k] == gone && factor_.has_spring(k)) return false;
  }
  if (std::ranges::any_of(corrected_, [&](Corrected spring) { return now[spring.contact] == gone; }))
    return false;
  for (Corrected& spring : corrected_) spring.contact = now[spring.contact];
  const auto carry = [&](auto& of_contact) {
    std::remove_reference_t<decltype(of_contact)> carried(contacts_.size());
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (now[k] != gone) carried[now[k]] = of_contact[k];
    }
    of_contact = std::move(carried);
  };
  carry(factored_);
  carry(factor_.normal_stiffness);
  carry(factor_.shear_stiffness);
  carry(factor_.places);
  note_contacts();
  return true;
}

/// Keeps the factor of an earlier step where it may do.
void OpenClose::try_factor(const StepProblem& problem, linalg::BlockSolver& solver) {
  kept_ = tried_ = wait_ == 0 && fits_factor(problem, solver) && carry_contacts();
  wait_ = std::max(0, wait_ - 1);
  corrected_before_ = kept_ ? corrections_.size() : 0;
  free_.clear();
  if (!kept_) return;
  // Pieces on which the same springs act have the same matrix.
  team_->for_range(springs_->size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      if (factored_[c].same_springs(springs_->piece[c])) factored_[c] = springs_->piece[c];
    }
  });
  find_free_blocks(problem);
  assembled_ = solver.halves() == nullptr;
}

/// After the step: whether its factor is worth trying in the next one.
void OpenClose::judge_factor(const OpenCloseResult& result) {
  // The next step is expected to correct as many more springs as this one did.
  const bool few = 2 * corrections_.size() <= most_kept + corrected_before_;
  if (!result.converged || result.refinements >= most_refinements || !few) factor_.solver = nullptr;
  if (!tried_) return;
  wait_ = kept_ ? 0 : next_wait_;
  next_wait_ = kept_ ? 1 : std::min(2 * next_wait_, longest_wait);
}

/// Blocks that no spring of the matrix holds, nor any that is corrected. They may turn fast, which the factor of an earlier step
/// knows nothing of, and are solved alone.
void OpenClose::find_free_blocks(const StepProblem& problem) {
  for (const Corrected spring : corrected_) hold(problem, spring.contact, 1);
  free_.clear();
  for (std::size_t b = 0; b < factor_.held.size(); ++b) {
    if (problem.moves(b) && factor_.held[at(problem.unknown(b))] == 0) free_.push_back(b);
  }
  for (const Corrected spring : corrected_) hold(problem, spring.contact, -1);
}

}  // namespace keyblock::dynamics
