#include "solve/corrections.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solve/line_search.h"

namespace keyblock::dynamics {

void Corrections::add(linalg::LowRankSolver& solver,
                      std::span<const linalg::LowRankSolver::PairVector> springs) {
  const std::size_t first = size_;
  size_ += springs.size();
  if (half_.size() < size_) half_.resize(size_);
  make_room(size_);
  const std::span<linalg::ForwardVector> fresh = std::span(half_).subspan(first, springs.size());
  solver.forward_solve(springs, fresh);
  for (std::size_t s = 0; s < size_; ++s) {
    const std::size_t from = std::max(s, first);
    solver.find_products(half_[s], fresh.subspan(from - first), {compliances(s) + from, size_ - from});
    for (std::size_t t = from; t < size_; ++t) compliances(t)[s] = compliances(s)[t];
  }
}

/// For rows and columns of so many springs.
void Corrections::make_room(std::size_t springs) {
  if (springs <= room_) return;
  const std::size_t room = (springs + springs / 2 + lane_count - 1) / lane_count * lane_count;
  std::vector<double> roomy(room * room, 0.0);
  for (std::size_t s = 0; s < room_; ++s) std::copy_n(compliances(s), room_, &roomy[s * room]);
  compliance_ = std::move(roomy);
  room_ = room;
}

/// C times the direction.
void Corrections::find_step() {
  step_.assign(room_, 0.0);
  for (std::size_t s = 0; s < size_; ++s) {
    if (direction_[s] != 0.0) linalg::add_multiple(direction_[s], compliances(s), size_, step_.data());
  }
}

/// The springs with ∂β/∂e ≠ 0, and how many of the first are those of the last direction, with the same ∂β/∂e.
std::size_t Corrections::find_curved() {
  std::size_t count = 0, same = 0;
  for (std::size_t s = 0; s < size_; ++s) {
    if (stiffness_[s] == 0.0) continue;
    const Curved now{s, stiffness_[s]};
    if (count == curved_.size()) curved_.emplace_back();
    if (same == count && curved_[count] == now) ++same;
    curved_[count++] = now;
  }
  curved_.resize(count);
  return same;
}

/// (1 + diag(∂β/∂e) C) d = β − φ. Springs with ∂β/∂e = 0 give d at once; the others the symmetric matrix C + diag(∂e/∂β), positive
/// definite among springs that the matrix lacks, negative definite among those that it has too many: L D Lᵀ needs no pivots.
bool Corrections::find_direction() {
  const std::size_t same = find_curved();
  const auto entry = [&](std::size_t i, std::size_t j) {
    const double compliance = compliances(curved_[i].spring)[curved_[j].spring];
    return i == j ? compliance + 1.0 / curved_[i].stiffness : compliance;
  };
  if (!factor_.factor(curved_.size(), same, entry)) return false;
  direction_ = missing_;
  for (const Curved& curved : curved_) direction_[curved.spring] = 0.0;
  find_step();  // of the springs that are not curved
  right_.clear();
  for (const auto& [s, stiffness] : curved_) right_.push_back(missing_[s] / stiffness - step_[s]);
  factor_.solve(right_);
  for (std::size_t i = 0; i < curved_.size(); ++i) direction_[curved_[i].spring] = right_[i];
  find_step();
  return true;
}

bool Corrections::solve(const linalg::LowRankSolver& solver, std::span<const double> half,
                        std::span<const Law> laws, std::span<const double> stretch) {
  stretch_.resize(size_);
  stiffness_.resize(size_);
  missing_.resize(size_);
  branch_.resize(size_);
  force_.assign(size_, 0.0);
  for (std::size_t s = 0; s < size_; ++s) stretch_[s] = stretch[s] + solver.product(half_[s], half);
  return minimize(laws);
}

/// φ from the φ at hand, by Newton's method. False when it is not found.
bool Corrections::minimize(std::span<const Law> laws) {
  constexpr int most_iterations = 60;
  constexpr double rounding = 1e-13;
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
    for (std::size_t s = 0; s < size_; ++s) start -= step_[s] * missing_[s];
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
