#include "linalg/block_conjugate_residual.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/index.h"

namespace keyblock::linalg {

void BlockConjugateResidual::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  matrix_.analyse(sizes, pairs);
  passes_.analyse(matrix_.order());
}

bool BlockConjugateResidual::factor() {
  lags_ = local_lags_ = {};
  return matrix_.factor(team_);
}

void BlockConjugateResidual::begin(const SolvedPart& part, std::span<const double> residual) {
  rho_ = ss_ = 0.0;
  passes_.start(matrix_, part, residual);
}

/// α and β of the next step from the dot products, and r · r after it. False where nothing is left of r in single precision, or the matrix is
/// not positive definite.
bool BlockConjugateResidual::next_lengths(const IterationDots& dots, double first_rr, PendingSteps& steps,
                                          double& rr) {
  const double beta = rho_ > 0.0 ? dots.rq / rho_ : 0.0;
  rho_ = dots.rq;
  ss_ = dots.qq - beta * beta * ss_;
  constexpr double most_growth = numbers::most_growth * numbers::most_growth;
  if (!(rho_ > 0.0 && ss_ > 0.0 && dots.rr <= most_growth * first_rr)) return false;
  const double alpha = rho_ / ss_;
  steps.add({static_cast<float>(alpha), static_cast<float>(beta), 1.0F});
  rr = std::max(0.0, dots.rr - alpha * rho_);
  return true;
}

/// r · r at which the residual is found for the first time: by the last solutions, or after three quarters of the digits. start: excess at the
/// beginning.
double BlockConjugateResidual::first_check(double first_rr, double start, const Lags& lags) {
  const double lag = std::ranges::max(lags), three_quarters = std::sqrt(start);
  return first_rr *
         (lag > 0.0 ? std::min(three_quarters, numbers::first_check_share * lag) : three_quarters) /
         (start * start);
}

/// Conjugate residuals from r, p, s, rho_ and ss_ on, to z.
///
/// When it is enough, the residual itself has to say: its norm in the scaled system differs from the largest of its numbers by a
/// factor of ten and more, in either direction. As it costs more than an iteration it is found when it should be small enough, by what was
/// missing the last time.
BlockConjugateResidual::Iterations BlockConjugateResidual::iterate(const SolvedPart& part, double too_large,
                                                                   const Excess& excess, int most,
                                                                   Lags& lags) {
  const double start = too_large;
  const bool continues = rho_ > 0.0;
  PendingSteps steps;
  double wanted = 0.0, first_rr = 0.0, rr = 0.0;
  for (int iterations = 1;; ++iterations) {
    const IterationDots dots = passes_.apply(matrix_, part, steps);
    if (iterations == 1) {
      first_rr = dots.rr;
      wanted = first_check(first_rr, start, lags);
    }
    if (!next_lengths(dots, first_rr, steps, rr)) {
      if (steps.count == 1) {  // r and s have taken that step; so do p and z
        steps.add({});
        passes_.take(part, steps);
      }
      return {iterations, false};
    }
    if (rr > wanted && iterations < most) continue;
    passes_.take(part, steps);
    steps = {};
    if (iterations == most) return {iterations, false};
    passes_.estimate_residual(matrix_, part, estimate_);
    too_large = excess(estimate_);
    if (too_large <= numbers::enough_estimated) {
      if (continues) return {iterations, true};
      std::copy_backward(lags.begin(), lags.end() - 1, lags.end());
      lags.front() = rr / first_rr * (start * start) / (too_large * too_large);
      return {iterations, true};
    }
    wanted = numbers::next_check_share * rr / (too_large * too_large);
  }
}

/// From where the iteration is, or from the beginning where rho_ is 0.
void BlockConjugateResidual::approach(std::span<double> x, std::span<double> residual, const Excess& excess,
                                      Residual kind) {
  const SolvedPart part = all();
  solved_ = true;
  bool continues = rho_ > 0.0;
  int iterations = 0;
  double most = HUGE_VAL;
  for (double too_large = excess(residual); too_large > 1.0; too_large = excess(residual)) {
    if (iterations >= numbers::most_iterations || !(too_large < most)) {
      solved_ = false;
      return;
    }
    most = numbers::most_growth * too_large;
    if (!continues) begin(part, residual);
    continues = false;
    const Iterations taken = iterate(part, too_large, excess, numbers::most_iterations - iterations, lags_);
    iterations += taken.count;
    if (taken.enough && kind == Residual::estimated) {
      passes_.add_solution(matrix_, part, x);
      part.for_numbers(residual.size(), [&](std::size_t k) { residual[k] = estimate_[k]; });
      return;
    }
    passes_.add_solution(matrix_, part, x, residual);
  }
}

void BlockConjugateResidual::solve(std::span<double> x, std::span<double> residual, const Excess& excess,
                                   Residual kind) {
  all().for_numbers(x.size(), [&](std::size_t k) { residual[k] = std::exchange(x[k], 0.0); });
  estimate_.resize(x.size());
  rho_ = 0.0;
  approach(x, residual, excess, kind);
}

void BlockConjugateResidual::improve(std::span<double> x, std::span<double> residual, const Excess& excess,
                                     Residual kind) {
  passes_.clear_solution(all());
  approach(x, residual, excess, kind);
}

bool BlockConjugateResidual::find_local(std::span<const std::size_t> blocks, Reach& reach) {
  if (!neighbourhood_.collect(matrix_.order(), matrix_.pattern(), blocks)) return false;
  reach.moved = neighbourhood_.positions().size();
  reach.blocks.clear();
  for (const Positions positions : {neighbourhood_.positions(), neighbourhood_.edge()}) {
    for (const std::size_t position : positions)
      reach.blocks.push_back(at(matrix_.order().block_at[position]));
  }
  return true;
}

void BlockConjugateResidual::solve_local(std::span<double> x, std::span<double> residual,
                                         const Excess& excess) {
  const BlockOrder& order = matrix_.order();
  estimate_.resize(x.size());
  for (const Positions positions : {neighbourhood_.positions(), neighbourhood_.edge()}) {
    for (const std::size_t position : positions) {
      const std::size_t first = order.offset[position];
      for (std::size_t k = first; k < first + at(order.size[position]); ++k)
        estimate_[k] = residual[k] = std::exchange(x[k], 0.0);
    }
  }
  solved_ = true;
  const double too_large = excess(residual);
  if (!(too_large > 1.0)) return;
  const SolvedPart part(order, &neighbourhood_, team_);
  begin(part, residual);
  const Iterations taken = iterate(part, too_large, excess, numbers::most_iterations, local_lags_);
  passes_.add_solution(matrix_, part, x, residual);
  // What is left over beyond may be more than there was, unless the iteration came to nothing.
  solved_ = excess(residual) < (taken.enough ? numbers::most_growth : 1.0) * too_large;
}

std::unique_ptr<BlockSolver> make_block_conjugate_residual(ThreadTeam* team) {
  return std::make_unique<BlockConjugateResidual>(team);
}

}  // namespace keyblock::linalg
