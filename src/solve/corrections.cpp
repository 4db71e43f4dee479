#include "solve/corrections.h"

#include <algorithm>
#include <cmath>

#include "solve/line_search.h"

namespace keyblock::dynamics {

void Corrections::add(linalg::LowRankSolver& solver, linalg::LowRankSolver::Part a,
                      linalg::LowRankSolver::Part b) {
  if (half_.size() == size_) half_.emplace_back();
  solver.forward_solve(a, b, half_[size_]);
  compliance_.resize(size_ * (size_ + 1) / 2);
  for (std::size_t t = 0; t <= size_; ++t) compliance_.push_back(solver.product(half_[t], half_[size_]));
  ++size_;
}

double Corrections::compliance_times(std::size_t s, std::span<const double> x) const {
  double sum = 0.0;
  for (std::size_t t = 0; t < size_; ++t) sum += compliance(s, t) * x[t];
  return sum;
}

/// Matrix and right side of the springs with ∂β/∂e ≠ 0.
void Corrections::assemble() {
  curved_.clear();
  for (std::size_t s = 0; s < size_; ++s) {
    if (stiffness_[s] != 0.0) curved_.push_back(s);
  }
  const std::size_t n = curved_.size();
  triangle_.resize(n * n);
  right_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t s = curved_[i];
    right_[i] = missing_[s] / stiffness_[s];
    for (std::size_t t = 0; t < size_; ++t) {
      if (stiffness_[t] == 0.0) right_[i] -= compliance(s, t) * missing_[t];
    }
    for (std::size_t j = 0; j <= i; ++j) triangle_[i * n + j] = compliance(s, curved_[j]);
    triangle_[i * n + i] += 1.0 / stiffness_[s];
  }
}

/// L D Lᵀ in place of the matrix, and L⁻¹ in front of the right side. False where there is none.
bool Corrections::factor() {
  const std::size_t n = curved_.size();
  for (std::size_t i = 0; i < n; ++i) {
    double* row = &triangle_[i * n];
    for (std::size_t j = 0; j < i; ++j) {
      const double* other = &triangle_[j * n];
      for (std::size_t k = 0; k < j; ++k) row[j] -= row[k] * other[k];  // row: L D so far
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double scaled = row[j] / triangle_[j * n + j];
      row[i] -= scaled * row[j];
      right_[i] -= scaled * right_[j];
      row[j] = scaled;
    }
    if (row[i] == 0.0 || !std::isfinite(row[i])) return false;
  }
  return true;
}

/// (1 + diag(∂β/∂e) C) d = β − φ. Springs with ∂β/∂e = 0 give d at once; the others the symmetric matrix C + diag(∂e/∂β), positive
/// definite among springs that the matrix lacks, negative definite among those that it has too many: L D Lᵀ needs no pivots.
bool Corrections::find_direction() {
  direction_ = missing_;
  assemble();
  if (!factor()) return false;
  const std::size_t n = curved_.size();
  for (std::size_t i = 0; i < n; ++i) right_[i] /= triangle_[i * n + i];
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = 0; j < i; ++j) right_[j] -= triangle_[i * n + j] * right_[i];
  }
  for (std::size_t i = 0; i < n; ++i) direction_[curved_[i]] = right_[i];
  return true;
}

bool Corrections::solve(const linalg::LowRankSolver& solver, std::span<const double> half,
                        std::span<const Law> laws, std::span<const double> stretch) {
  constexpr int most_iterations = 60;
  constexpr double rounding = 1e-13;
  stretch_.resize(size_);
  stiffness_.resize(size_);
  missing_.resize(size_);
  branch_.resize(size_);
  step_.resize(size_);
  force_.assign(size_, 0.0);
  for (std::size_t s = 0; s < size_; ++s) stretch_[s] = stretch[s] + solver.product(half_[s], half);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    double largest = 0.0, missing = 0.0;
    for (std::size_t s = 0; s < size_; ++s) {
      missing_[s] = laws[s].excess(stretch_[s]) - force_[s];
      stiffness_[s] = laws[s].excess_stiffness(stretch_[s]);
      branch_[s] = laws[s].branch(stretch_[s]);
      missing = std::max(missing, std::abs(missing_[s]));
      largest = std::max({largest, std::abs(force_[s]), laws[s].spring.stiffness * std::abs(stretch_[s])});
    }
    if (missing <= rounding * largest) return true;
    if (!find_direction()) return false;
    double start = 0.0;
    for (std::size_t s = 0; s < size_; ++s) {
      step_[s] = compliance_times(s, direction_);
      start -= step_[s] * missing_[s];
    }
    const auto slope = [&](double alpha) {
      double sum = 0.0;
      for (std::size_t s = 0; s < size_; ++s)
        sum +=
            step_[s] * (force_[s] + alpha * direction_[s] - laws[s].excess(stretch_[s] - alpha * step_[s]));
      return sum;
    };
    const double alpha = line_search(
        start, [](double /*alpha*/) {}, slope);
    bool same = alpha == 1.0;
    for (std::size_t s = 0; s < size_; ++s) {
      force_[s] += alpha * direction_[s];
      stretch_[s] -= alpha * step_[s];
      same = same && laws[s].branch(stretch_[s]) == branch_[s];
    }
    if (same) return true;  // the function is quadratic up to here
  }
  return false;
}

void Corrections::finish(linalg::LowRankSolver& solver, std::span<const double> half, std::span<double> d) {
  scaled_.resize(size_);
  for (std::size_t s = 0; s < size_; ++s) scaled_[s] = -force_[s];
  solver.backward_solve(half, std::span(half_).first(size_), scaled_, d);
}

}  // namespace keyblock::dynamics
