#include "solve/local_solve.h"

#include <algorithm>
#include <numeric>

#include "core/index.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

bool LocalSolve::solve(const StepSystem& system, Iterate& iterate, double enough) {
  is_active_ = false;
  if (!serves(system)) return false;
  const StepProblem& problem = system.problem;
  const std::span<const double> ratios = iterate.ratios(system);
  find_all(
      system.team, ratios.size(), blocks_worth_threads,
      [&](std::size_t b) { return ratios[b] > step_numbers::elsewhere_share * enough; }, out_of_balance_);
  for (std::size_t& b : out_of_balance_) b = at(problem.points().body(b).unknown);
  if (!system.solver.local()->find_local(out_of_balance_, reach_)) return false;
  take_reach(system);
  for (const std::size_t b : blocks_) {
    const auto [first, last] = problem.terms().coefficients(b);
    for (std::size_t k = first; k < last; ++k) iterate.direction[k] = -iterate.gradient[k];
  }
  const auto excess = [&](std::span<const double> residual) {
    double largest = 0.0;
    for (const std::size_t b : blocks_)
      largest = std::max(largest, problem.terms().residual_ratio(b, residual));
    return largest / enough;
  };
  const std::size_t n = problem.model().unknowns;
  system.solver.local()->solve_local(std::span(iterate.direction).first(n),
                                     std::span(iterate.residual).first(n), excess);
  is_active_ = true;
  return true;
}

void LocalSolve::find_rows_of_blocks(const StepSystem& system) {
  const std::uint64_t version = system.contacts.version;
  if (!first_row_.empty() && version != 0 && version_ == version) return;
  version_ = version;
  const auto& rows = system.problem.rows();
  const auto for_ends = [&](const auto& body) {
    for (std::size_t c = 0; c < rows.size(); ++c) {
      for (const int unknown : {rows[c].unknown_a, rows[c].unknown_b}) {
        if (unknown >= 0) body(at(unknown), c);
      }
    }
  };
  // Counted two places on: in the next one stands where a block begins, until it is filled, and then where the block after it does.
  first_row_.assign(system.problem.model().bodies() + 2, 0);
  for_ends([&](std::size_t block, std::size_t /*row*/) { ++first_row_[block + 2]; });
  std::partial_sum(first_row_.begin(), first_row_.end(), first_row_.begin());
  rows_of_block_.resize(first_row_.back());
  for_ends([&](std::size_t block, std::size_t row) {
    rows_of_block_[first_row_[block + 1]++] = static_cast<std::uint32_t>(row);
  });
}

/// What the next solution reaches. A row of two blocks that move comes once, with the first of them.
void LocalSolve::take_reach(const StepSystem& system) {
  find_rows_of_blocks(system);
  is_taken_.assign(system.problem.model().bodies(), 0);
  rows_.clear();
  for (const std::size_t block : std::span(reach_.blocks).first(reach_.moved)) {
    for (std::size_t i = first_row_[block]; i < first_row_[block + 1]; ++i) {
      const Row& row = system.row(rows_of_block_[i]);
      const int other = at(row.unknown_a) == block ? row.unknown_b : row.unknown_a;
      if (other < 0 || is_taken_[at(other)] == 0) rows_.push_back(rows_of_block_[i]);
    }
    is_taken_[block] = 1;
  }
  moved_ = reach_.moved;
  blocks_.clear();
  for (const std::size_t unknown : reach_.blocks)
    blocks_.push_back(system.problem.points().block_of_unknown(unknown));
}

/// Blocks beside those that move stand still: the displacement is that of another direction there.
void LocalSolve::find_direction(const StepSystem& system, Iterate& iterate) const {
  SpringArray& springs = system.springs();
  system.problem.points().displace(iterate.direction, blocks_, rows_, iterate.displacement);
  for (const std::size_t c : rows_) {
    const Row& row = system.row(c);
    const Vec2 r = vec2_of(row.relative(iterate.displacement));
    springs.dy[c] = -dot(row.normal, r);
    springs.dw[c] = dot(row.tangent(), r);
  }
}

}  // namespace keyblock::dynamics
