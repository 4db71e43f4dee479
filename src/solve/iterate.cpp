#include "solve/iterate.h"

#include <cmath>
#include <functional>
#include <utility>

namespace keyblock::dynamics {

void Iterate::begin(const StepSystem& system, std::span<double> d) {
  increment = d;
  relative.resize(system.problem.rows().size());
  gradient.resize(d.size());
  direction.resize(d.size());
  residual.resize(d.size(), 0.0);
  gradient_changed();
  is_placed = false;
}

void Iterate::place(const StepSystem& system) {
  SpringArray& springs = system.springs();
  system.problem.displace(increment, displacement);
  for_relatives(system, [&](std::size_t c, std::size_t count, const Relatives& r) {
    for (std::size_t i = 0; i < count; ++i)
      store_pair(relative[c + i], r.each[i] + load_pair(system.row(c + i).moved));
    springs.stretch(c, count, r.normal, r.tangent);
  });
  springs.press_faces();
  is_placed = true;
}

void Iterate::find_gradient(const StepSystem& system) {
  const SpringArray& springs = system.springs();
  system.problem.gradient(
      increment, [&](std::size_t c) { return system.row(c).gradient(springs.force(c)); }, vertex_force,
      gradient);
  gradient_changed();
}

void Iterate::add_force(const StepSystem& system, std::size_t c, Force force, double scale) {
  if (force.is_zero()) return;
  const Row& row = system.row(c);
  system.problem.add_force(row, scale * row.gradient(force), gradient);
}

/// Of a spring that had the force `before` with its old law.
void Iterate::take_force(const StepSystem& system, std::size_t c, Force before) {
  SpringArray& springs = system.springs();
  springs.branch[c] = springs.branch_at(c, springs.y[c], springs.w[c]);
  add_force(system, c, springs.force(c) - before);
  gradient_changed();
}

void Iterate::let_go_of_faces(const StepSystem& system, std::size_t c) {
  SpringArray& springs = system.springs();
  if (!springs.faces.has(c)) return;
  const std::vector<std::size_t> rows(springs.faces.all_rows().begin(), springs.faces.all_rows().end());
  std::vector<double> before;
  for (const std::size_t row : rows) before.push_back(springs.faces.force(row));
  springs.faces.pull_no_more(c);
  springs.press_faces();
  // A row where two faces meet stands in both, and its force is of both.
  std::vector<bool> is_done(springs.size(), false);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (is_done[rows[k]]) continue;
    is_done[rows[k]] = true;
    add_force(system, rows[k], {springs.faces.force(rows[k]) - before[k], 0.0});
  }
  gradient_changed();
}

void Iterate::gradient_changed_at(const StepSystem& system, std::span<const std::size_t> blocks) {
  for (const std::size_t b : blocks) ratios_[b] = system.problem.terms().residual_ratio(b, gradient);
  largest_ratio_.reset();
}

std::span<const double> Iterate::ratios(const StepSystem& system) {
  if (std::exchange(knows_ratios_, true)) return ratios_;
  ratios_.resize(system.problem.model().bodies());
  system.team.for_range(ratios_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) ratios_[b] = system.problem.terms().residual_ratio(b, gradient);
  });
  return ratios_;
}

double Iterate::out_of_balance(const StepSystem& system) {
  const std::span<const double> all = ratios(system);
  if (!largest_ratio_) {
    largest_ratio_ =
        largest_of(system.team, all.size(), blocks_worth_threads, [&](std::size_t b) { return all[b]; });
  }
  return *largest_ratio_;
}

bool Iterate::is_finite(ThreadTeam& team) const {
  // One sum in place of a question to each: no number that is not finite leaves a sum finite, as ∞ − ∞ is none either.
  const auto some = [&](std::size_t group) {
    const std::size_t k = group * lane_count;
    return load_first(&gradient[k], static_cast<int>(std::min<std::size_t>(lane_count, gradient.size() - k)));
  };
  return std::isfinite(sum(sum_of<Lanes>(team, (gradient.size() + lane_count - 1) / lane_count,
                                         coefficients_worth_threads / lane_count, some)));
}

void Iterate::turn_against_gradient(std::size_t n) {
  std::transform(gradient.begin(), gradient.begin() + static_cast<std::ptrdiff_t>(n), direction.begin(),
                 std::negate());
}

}  // namespace keyblock::dynamics
