#include "solve/kept_factor.h"

#include <algorithm>
#include <cstdint>

#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

constexpr std::size_t gone_row = SIZE_MAX;

}  // namespace

bool KeptFactor::begin_step(const StepSystem& system, StepMatrix& matrix, LowRankUpdate& update) {
  is_kept_ = was_tried_ =
      wait_ == 0 && fits(system) && carry(system, matrix, update) && matrix.has_faces(system.springs().faces);
  wait_ = std::max(0, wait_ - 1);
  updated_before_ = is_kept_ ? update.size() : 0;
  matrix.forget_free_blocks();
  if (!is_kept_) return false;
  matrix.take_branches_with_the_same_springs(system);
  matrix.find_free_blocks(system, update.rows());
  return true;
}

void KeptFactor::note(const StepSystem& system) {
  is_kept_ = false;
  solver_ = nullptr;
  if (!system.options.accelerators.kept_factor || !system.solver.serves_later_steps()) return;
  solver_ = &system.solver;
  note_rows(system);
  inertia_.assign(system.problem.terms().inertias().begin(), system.problem.terms().inertias().end());
}

void KeptFactor::note_rows(const StepSystem& system) {
  system.problem.name_rows(rows_);
  version_ = system.contacts.version;
}

/// Whether the factor was made for the inertia of this step.
bool KeptFactor::fits(const StepSystem& system) const {
  return solver_ == &system.solver && system.problem.terms().has_weights() &&
         std::ranges::equal(inertia_, system.problem.terms().inertias());
}

/// What is known of the matrix by row goes over to the rows of this step: those that came have no spring in it, those that went had
/// none. False when one had, or is updated.
bool KeptFactor::carry(const StepSystem& system, StepMatrix& matrix, LowRankUpdate& update) {
  if (system.contacts.version != 0 && version_ == system.contacts.version) return true;
  std::vector<Coupling::RowKey> rows;
  system.problem.name_rows(rows);
  std::vector<std::size_t> now(rows_.size(), gone_row);
  std::size_t next = 0;
  for (std::size_t c = 0; c < rows.size(); ++c) {
    const std::size_t last = std::min(next + step_numbers::most_gone, rows_.size());
    for (std::size_t k = next; k < last; ++k) {
      if (rows_[k] != rows[c]) continue;
      now[k] = c;
      next = k + 1;
      break;
    }
  }
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k] == gone_row && matrix.has_spring(k)) return false;
  }
  if (std::ranges::any_of(update.rows(), [&](std::size_t c) { return now[c] == gone_row; })) return false;
  update.carry(now);
  matrix.carry(now, gone_row, rows.size());
  rows_ = std::move(rows);
  version_ = system.contacts.version;
  return true;
}

void KeptFactor::end_step(const OpenCloseResult& result, std::size_t updated) {
  // The next step is expected to update as many more springs as this one did.
  const bool few = 2 * updated <= step_numbers::most_kept + updated_before_;
  if (!result.converged || result.refinements >= step_numbers::most_refinements || !few) solver_ = nullptr;
  if (!was_tried_) return;
  wait_ = is_kept_ ? 0 : next_wait_;
  next_wait_ = is_kept_ ? 1 : std::min(2 * next_wait_, step_numbers::longest_wait);
}

}  // namespace keyblock::dynamics
