#include "linalg/block_conjugate_residual.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace keyblock::linalg {

namespace {

// Excess of the iteration's residual, with which that of the matrix is small enough.
constexpr double well_enough = 0.9;
// Share of the square of the residual asked for, at which it is looked at for the first time.
constexpr double early = 0.5;

}  // namespace

/// Conjugate residuals from r_, p_, s_, rho_ and ss_ on, to z_.
///
/// When it is enough, the residual itself has to say: its norm in the scaled system differs from the largest of its numbers by a
/// factor of ten and more, the one way or the other. As it costs more than an iteration it is looked at when it should be small
/// enough, going by how far it was away the last time; the first time by the last solutions, or three quarters of the digits on the way.
BlockConjugateResidual::Iterations BlockConjugateResidual::iterate(double too_large, const Excess& excess,
                                                                   int most) {
  const double start = too_large;
  const bool goes_on = rho_ > 0.0;
  Ways ways;
  double wanted = 0.0, first_rr = 0.0;
  for (int iterations = 1;; ++iterations) {
    const Dots dots = apply(ways);
    if (iterations == 1) {
      first_rr = dots.rr;
      const double lag = *std::max_element(lag_.begin(), lag_.end()), three_quarters = std::sqrt(start);
      wanted =
          first_rr * (lag > 0.0 ? std::min(three_quarters, early * lag) : three_quarters) / (start * start);
    }
    const double beta = rho_ > 0.0 ? dots.rq / rho_ : 0.0;
    rho_ = dots.rq;
    ss_ = dots.qq - beta * beta * ss_;
    // Nothing is left of r in single precision, or the matrix is not positive definite.
    if (!(rho_ > 0.0 && ss_ > 0.0 && dots.rr <= most_growth * most_growth * first_rr)) {
      if (ways.pending == 1) {  // r and s have gone that; so do p and z
        ways.take({});
        go(ways);
      }
      return {iterations, false};
    }
    const double alpha = rho_ / ss_;
    ways.take({static_cast<float>(alpha), static_cast<float>(beta), 1.0F});
    const double rr = std::max(0.0, dots.rr - alpha * rho_);
    if (rr > wanted && iterations < most) continue;
    go(ways);
    ways = {};
    if (iterations == most) return {iterations, false};
    find_residual(estimate_);
    too_large = excess(estimate_);
    if (too_large <= well_enough) {
      if (goes_on) return {iterations, true};
      std::copy_backward(lag_.begin(), lag_.end() - 1, lag_.end());
      lag_.front() = rr / first_rr * (start * start) / (too_large * too_large);
      return {iterations, true};
    }
    wanted = 0.5 * rr / (too_large * too_large);
  }
}

/// From where the iteration is, or from the beginning where rho_ is 0.
void BlockConjugateResidual::approach(std::span<double> x, std::span<double> residual, const Excess& excess,
                                      Residual kind) {
  solved_ = true;
  bool goes_on = rho_ > 0.0;
  int iterations = 0;
  double most = HUGE_VAL;
  for (double too_large = excess(residual); too_large > 1.0; too_large = excess(residual)) {
    if (iterations >= most_iterations || !(too_large < most)) {
      solved_ = false;
      return;
    }
    most = most_growth * too_large;
    if (!goes_on) start(residual);
    goes_on = false;
    const Iterations taken = iterate(too_large, excess, most_iterations - iterations);
    iterations += taken.count;
    if (taken.enough && kind == Residual::estimated) {
      take_over(x, residual, kind);
      return;
    }
    take_over(x, residual, Residual::exact);
  }
}

void BlockConjugateResidual::solve(std::span<double> x, std::span<double> residual, const Excess& excess,
                                   Residual kind) {
  for_numbers(x.size(), [&](std::size_t k) { residual[k] = std::exchange(x[k], 0.0); });
  estimate_.resize(x.size());
  rho_ = 0.0;
  approach(x, residual, excess, kind);
}

void BlockConjugateResidual::improve(std::span<double> x, std::span<double> residual, const Excess& excess,
                                     Residual kind) {
  for_numbers(z_.size(), [&](std::size_t k) { z_[k] = 0.0F; });
  approach(x, residual, excess, kind);
}

std::unique_ptr<BlockSolver> make_block_conjugate_residual(ThreadTeam* team) {
  return std::make_unique<BlockConjugateResidual>(team);
}

}  // namespace keyblock::linalg
