// Newton steps near some blocks: all that they take is looked at in the contacts and coefficients of these alone.
#include <numeric>
#include <span>

#include "core/index.h"
#include "dynamics/open_close.h"

namespace keyblock::dynamics {

/// Whether what is out of balance at few blocks may be taken off near these. In a static step, which has little inertia, that is everywhere.
bool OpenClose::solves_near(const StepProblem& problem, const linalg::BlockSolver& solver) {
  return solver.solves_near() && !problem.is_static();
}

/// direction_ ← −A⁻¹ gradient_ near the blocks that are out of balance, where these are few. False, and nothing is done, where not.
bool OpenClose::solve_near(const StepProblem& problem, linalg::BlockSolver& solver, double enough) {
  constexpr double share = 0.5;  // of what is enough, that the others may be out of balance by
  if (!solves_near(problem, solver)) return false;
  find_ratios(problem);
  find_all(
      *team_, ratios_.size(), blocks_worth_threads,
      [&](std::size_t b) { return ratios_[b] > share * enough; }, out_of_balance_blocks_);
  for (std::size_t& b : out_of_balance_blocks_) b = at(problem.unknown(b));
  if (!solver.find_near(out_of_balance_blocks_, reach_)) return false;
  find_near(problem);
  for (const std::size_t b : near_.blocks) {
    const auto [first, last] = problem.coefficients(b);
    for (std::size_t k = first; k < last; ++k) direction_[k] = -gradient_[k];
  }
  const auto excess = [&](std::span<const double> residual) {
    double largest = 0.0;
    for (const std::size_t b : near_.blocks) largest = std::max(largest, problem.residual_ratio(b, residual));
    return largest / enough;
  };
  const std::size_t n = problem.unknowns();
  solver.solve_near(std::span(direction_).first(n), std::span(residual_).first(n), excess);
  return true;
}

void OpenClose::find_contacts_of_blocks(const StepProblem& problem) {
  if (!first_contact_.empty() && contacts_version_ != 0 && near_version_ == contacts_version_) return;
  near_version_ = contacts_version_;
  const auto& rows = problem.rows();
  const auto for_ends = [&](const auto& body) {
    for (std::size_t c = 0; c < rows.size(); ++c) {
      for (const int unknown : {rows[c].unknown_a, rows[c].unknown_b}) {
        if (unknown >= 0) body(at(unknown), c);
      }
    }
  };
  // Counted two places on: in the next one stands where a block begins, until it is filled, and then where the block after it does.
  first_contact_.assign(problem.blocks() + 2, 0);
  for_ends([&](std::size_t block, std::size_t /*contact*/) { ++first_contact_[block + 2]; });
  std::partial_sum(first_contact_.begin(), first_contact_.end(), first_contact_.begin());
  contacts_of_block_.resize(first_contact_.back());
  for_ends([&](std::size_t block, std::size_t contact) {
    contacts_of_block_[first_contact_[block + 1]++] = static_cast<std::uint32_t>(contact);
  });
}

/// What the next solution reaches. A contact of two blocks that move comes once, with the first of them.
void OpenClose::find_near(const StepProblem& problem) {
  find_contacts_of_blocks(problem);
  is_taken_.assign(problem.blocks(), 0);
  near_.contacts.clear();
  for (const std::size_t block : std::span(reach_.blocks).first(reach_.moved)) {
    for (std::size_t i = first_contact_[block]; i < first_contact_[block + 1]; ++i) {
      const StepProblem::Row& row = problem.rows()[contacts_of_block_[i]];
      const int other = at(row.unknown_a) == block ? row.unknown_b : row.unknown_a;
      if (other < 0 || is_taken_[at(other)] == 0) near_.contacts.push_back(contacts_of_block_[i]);
    }
    is_taken_[block] = 1;
  }
  near_.moved = reach_.moved;
  near_.blocks.clear();
  for (const std::size_t unknown : reach_.blocks) near_.blocks.push_back(problem.block(unknown));
}

/// Blocks beside those that move stand still: displacement_ is that of another direction there.
void OpenClose::find_direction_near(const StepProblem& problem) {
  problem.displace(direction_, near_.blocks, near_.contacts, displacement_);
  for (const std::size_t c : near_.contacts) {
    const StepProblem::Row& row = problem.rows()[c];
    const Vec2 r = vec2_of(row.relative(displacement_));
    springs_->dy[c] = -dot(row.normal, r);
    springs_->dw[c] = dot(row.tangent(), r);
  }
}

OpenClose::Products OpenClose::products_near(const StepProblem& problem) const {
  Products products;
  for (const std::size_t b : std::span(near_.blocks).first(near_.moved)) {
    const auto [first, last] = problem.coefficients(b);
    for (std::size_t k = first; k < last; ++k) products += products_of(k);
  }
  return products;
}

}  // namespace keyblock::dynamics
