#include "solve/newton.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "solve/line_search.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

using Force = SpringArray::Force;
using Residual = linalg::BlockSolver::Residual;

/// By how much the force of a row at D + αp differs from the straight line on which it is at D.
Force force_beside(const SpringArray& springs, std::size_t c, double alpha) {
  const double y = springs.y[c] + alpha * springs.dy[c], w = springs.w[c] + alpha * springs.dw[c];
  return springs.force_at(c, y, w) - springs.force_on(c, springs.branch[c], y, w);
}

/// Where the matrix is not exact, the gradient is found anew before it counts as settled.
Residual residual_kind(bool exact) {
  return exact ? Residual::exact : Residual::estimated;
}

}  // namespace

template <typename Body>
void Newton::for_reached_coefficients(const StepSystem& system, const Iterate& iterate,
                                      const Body& body) const {
  if (!local_.is_active())
    return system.team.for_range(iterate.direction.size(), coefficients_worth_threads, body);
  for (const std::size_t b : local_.blocks()) std::apply(body, system.problem.terms().coefficients(b));
}

template <typename Body>
void Newton::for_reached_rows(const StepSystem& system, const Body& body) const {
  if (!local_.is_active())
    return system.team.for_range(system.springs().size(), contacts_worth_threads, body);
  for (const std::size_t c : local_.rows()) body(c, c + 1);
}

void Newton::begin(const StepSystem& system) {
  local_.reset();
  may_go_whole_way_ = LocalSolve::serves(system);
}

bool Newton::solve(const StepSystem& system, Iterate& iterate, bool exact, const OpenCloseResult& result) {
  using namespace step_numbers;
  const Profile::Scope scope(system.profile, Phase::solution);
  const double tolerance = system.options.tolerance;
  // The springs that act are not known better than to a share of what is out of balance.
  const auto enough = [&](double share) {
    return std::max(linear_share * tolerance, share * iterate.out_of_balance(system));
  };
  // Where no row changes its branch and little is out of balance, one system of all blocks is all that is needed.
  const bool is_calm = result.changes == 0 && iterate.out_of_balance(system) <= calm * tolerance;
  local_.reset();
  if (!is_calm && local_.solve(system, iterate, enough(forcing_local))) return system.solver.solved();
  std::vector<double>&direction = iterate.direction, &gradient = iterate.gradient;
  system.team.for_range(direction.size(), coefficients_worth_threads,
                        [&](std::size_t begin, std::size_t end) {
                          for (std::size_t k = begin; k < end; ++k) direction[k] = -gradient[k];
                        });
  const std::size_t n = system.problem.model().unknowns;
  system.solver.solve(std::span(direction).first(n), std::span(iterate.residual).first(n),
                      system.excess_over(enough(forcing)), residual_kind(exact));
  return system.solver.solved();
}

bool Newton::go_along(const StepSystem& system, Iterate& iterate, double enough, bool exact,
                      OpenCloseResult& result) {
  find_direction(system, iterate);
  const bool whole_way = !local_.is_active() && std::exchange(may_go_whole_way_, false);
  if (whole_way) find_changes(system, 1.0);
  double alpha = whole_way ? 1.0 : search_line(system, iterate);
  // Where no row changes, what the system left over is all that is.
  if (!local_.is_active() && changes_.empty() && bends_.empty() &&
      system.problem.terms().residual_ratio(iterate.residual) >= enough) {
    if (!improve(system, iterate, exact)) return false;
    find_direction(system, iterate);
    alpha = search_line(system, iterate);
  }
  go(system, iterate, alpha);
  result.changes += changes_.size();
  return true;
}

/// Takes what the last linear solution left over below the share of the tolerance. False when it cannot be had.
bool Newton::improve(const StepSystem& system, Iterate& iterate, bool exact) const {
  const Profile::Scope scope(system.profile, Phase::solution);
  const std::size_t n = system.problem.model().unknowns;
  system.solver.improve(std::span(iterate.direction).first(n), std::span(iterate.residual).first(n),
                        system.excess_over(step_numbers::linear_share * system.options.tolerance),
                        residual_kind(exact));
  return system.solver.solved();
}

/// What the direction of search does to every spring.
void Newton::find_direction(const StepSystem& system, Iterate& iterate) const {
  if (local_.is_active()) return local_.find_direction(system, iterate);
  SpringArray& springs = system.springs();
  system.problem.displace(iterate.direction, iterate.displacement);
  iterate.for_relatives(system, [&](std::size_t c, std::size_t count, const Iterate::Relatives& r) {
    store_first(&springs.dy[c], -r.normal, static_cast<int>(count));
    store_first(&springs.dw[c], r.tangent, static_cast<int>(count));
  });
}

/// Faces of joints that open or close partly between where they are and α along the direction.
void Newton::find_bends(const StepSystem& system, double alpha) {
  bends_.clear();
  const SpringArray& springs = system.springs();
  const FaceSprings& faces = springs.faces;
  if (faces.empty()) return;
  const auto look_at = [&](std::size_t f) {
    if (!faces.is_linear(f, springs.y, springs.dy, alpha)) bends_.emplace_back(f);
  };
  if (local_.is_active()) return faces.for_faces_of(local_.rows(), look_at);
  for (std::size_t f = 0; f < faces.size(); ++f) look_at(f);
}

/// Rows that change their branch between where they are and α along the direction.
void Newton::find_changes(const StepSystem& system, double alpha) {
  const SpringArray& springs = system.springs();
  find_bends(system, alpha);
  const auto changes = [&](std::size_t c) {
    return springs.branch_at(c, springs.y[c] + alpha * springs.dy[c], springs.w[c] + alpha * springs.dw[c]) !=
           springs.branch[c];
  };
  if (local_.is_active()) {
    changes_.clear();
    std::ranges::copy_if(local_.rows(), std::back_inserter(changes_), changes);
    return;
  }
  find_few<lane_count>(
      system.team, springs.size(), contacts_worth_threads,
      [&](std::size_t first) { return springs.any_leaves(first, alpha); }, changes, changes_);
}

/// g·p and ρ·p.
Newton::Products Newton::products(const StepSystem& system, const Iterate& iterate) const {
  const auto of_one = [&](std::size_t k) {
    return Products{iterate.gradient[k] * iterate.direction[k], iterate.residual[k] * iterate.direction[k]};
  };
  if (!local_.is_active())
    return sum_of<Products>(system.team, iterate.direction.size(), coefficients_worth_threads, of_one);
  Products products;
  for (const std::size_t b : local_.moved_blocks()) {
    const auto [first, last] = system.problem.terms().coefficients(b);
    for (std::size_t k = first; k < last; ++k) products += of_one(k);
  }
  return products;
}

/// dΠ(D + αp)/dα given the rows that change up to α. With A p = −g − ρ it is g·p + α (−g·p − ρ·p) except for these.
double Newton::slope(const SpringArray& springs, double alpha) const {
  double sum = slope_at_zero_ + alpha * curvature_;
  for (const std::size_t c : changes_) {
    const Force extra = force_beside(springs, c, alpha);
    sum += extra.normal * springs.dy[c] + extra.shear * springs.dw[c];
  }
  for (const FaceBend& bend : bends_) sum += bend.slope(springs.faces, springs.y, springs.dy, alpha);
  return sum;
}

double Newton::search_line(const StepSystem& system, const Iterate& iterate) {
  const Products along = products(system, iterate);
  slope_at_zero_ = along.gradient;
  curvature_ = -along.residual - along.gradient;
  find_changes(system, 1.0);
  return line_search(
      slope_at_zero_, [&](double alpha) { find_changes(system, alpha); },
      [&](double alpha) { return slope(system.springs(), alpha); });
}

/// D ← D + αp, and the gradient and springs with it.
void Newton::go(const StepSystem& system, Iterate& iterate, double alpha) const {
  SpringArray& springs = system.springs();
  for_reached_coefficients(system, iterate, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      iterate.increment[k] += alpha * iterate.direction[k];
      iterate.gradient[k] = (1.0 - alpha) * iterate.gradient[k] - alpha * iterate.residual[k];
    }
  });
  for (const std::size_t c : changes_) iterate.add_force(system, c, force_beside(springs, c, alpha));
  for (const FaceBend& bend : bends_) {
    bend.for_rows(springs.faces, springs.y, springs.dy, alpha, [&](std::size_t row, double beside) {
      iterate.add_force(system, row, {beside, 0.0});
    });
  }
  if (local_.is_active()) {
    iterate.gradient_changed_at(system, local_.blocks());
  } else {
    iterate.gradient_changed();
  }
  for_reached_rows(system, [&](std::size_t begin, std::size_t end) { springs.go(alpha, begin, end); });
  springs.press_faces();
  iterate.is_placed = false;
  for (const std::size_t c : changes_) springs.branch[c] = springs.branch_at(c, springs.y[c], springs.w[c]);
}

}  // namespace keyblock::dynamics
