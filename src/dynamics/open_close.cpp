#include "dynamics/open_close.h"

#include <algorithm>
#include <cmath>

namespace keyblock::dynamics {

void OpenClose::evaluate(const StepProblem& problem, std::span<const double> d) {
  const auto& rows = problem.rows();
  for (std::size_t c = 0; c < rows.size(); ++c) {
    r_[c] = problem.relative(rows[c], d) + rows[c].moved;
    active_[c] = StepProblem::active(rows[c], r_[c]);
  }
}

/// Solves with the springs of the last step, as if they could pull and hold without limit.
bool OpenClose::first_solve(const StepProblem& problem, linalg::BlockSolver& solver, std::span<double> d,
                            OpenCloseResult& result) {
  const auto& rows = problem.rows();
  problem.assemble(assumed_, solver);
  ++result.iterations;
  ++result.factorizations;
  if (!solver.factor()) return false;
  std::copy(problem.right().begin(), problem.right().end(), d.begin());
  for (std::size_t c = 0; c < rows.size(); ++c) {
    const contact::Spring& s = rows[c].spring;
    const double normal = assumed_[c].normal ? s.normal_stiffness() * rows[c].depth(rows[c].moved) : 0.0;
    const double shear =
        assumed_[c].shear ? s.shear_stiffness() * rows[c].shear(rows[c].moved) : s.sliding_force();
    problem.add_contact_force(rows[c], normal * rows[c].normal - shear * rows[c].tangent, d);
  }
  solver.solve(d.first(problem.unknowns()));
  return true;
}

double OpenClose::line_search(const StepProblem& problem, std::span<const double> d) {
  const auto& rows = problem.rows();
  for (std::size_t c = 0; c < rows.size(); ++c) r_direction_[c] = problem.relative(rows[c], direction_);
  problem.multiply(direction_, h_direction_);
  double slope_at_zero = 0.0, curvature = 0.0;  // of the quadratic part
  for (std::size_t k = 0; k < direction_.size(); ++k) {
    slope_at_zero += h_direction_[k] * d[k] - problem.right()[k] * direction_[k];
    curvature += h_direction_[k] * direction_[k];
  }
  const auto slope = [&](double alpha) {
    double sum = slope_at_zero + alpha * curvature;
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const StepProblem::Row& row = rows[c];
      const Vec2 r = r_[c] + alpha * r_direction_[c];
      sum -= row.spring.normal_force(row.depth(r)) * dot(row.normal, r_direction_[c]);
      sum += row.spring.shear_force(row.shear(r)) * dot(row.tangent, r_direction_[c]);
    }
    return sum;
  };
  const double start = slope(0.0), target = 0.01 * std::abs(start);
  if (!(start < 0.0)) return 1.0;  // the minimum, to the last digit
  double low = 0.0, low_slope = start, high = 1.0, high_slope = slope(1.0);
  while (high_slope < -target && high < 64.0) {
    low = high;
    low_slope = high_slope;
    high *= 2.0;
    high_slope = slope(high);
  }
  if (std::abs(high_slope) <= target) return high;
  double alpha = high;
  for (int iteration = 0; iteration < 60; ++iteration) {
    // Regula falsi, with bisection every third time so that the bracket always shrinks.
    alpha =
        iteration % 3 == 2 ? 0.5 * (low + high) : low - low_slope * (high - low) / (high_slope - low_slope);
    const double value = slope(alpha);
    if (std::abs(value) <= target) break;
    if (value < 0.0) {
      low = alpha;
      low_slope = value;
    } else {
      high = alpha;
      high_slope = value;
    }
  }
  return alpha;
}

bool OpenClose::minimize(const StepProblem& problem, linalg::BlockSolver& solver,
                         const SolverOptions& options, bool warm, std::span<double> d,
                         OpenCloseResult& result) {
  const int limit = result.iterations + options.max_iterations;
  if (!warm) {
    if (!first_solve(problem, solver, d, result)) return false;
    evaluate(problem, d);
    problem.gradient(d, r_, gradient_);
    // The same springs act; what may still differ is the direction in which a contact slides.
    if (active_ == assumed_ && problem.residual_ratio(gradient_) < options.tolerance) return true;
  } else {
    evaluate(problem, d);
    problem.gradient(d, r_, gradient_);
  }
  while (result.iterations < limit) {
    ++result.iterations;
    if (active_ != assumed_) {  // else the factorization at hand is that of ∇²Π here
      assumed_ = active_;
      problem.assemble(assumed_, solver);
      ++result.factorizations;
      if (!solver.factor()) return false;
    }
    for (std::size_t k = 0; k < direction_.size(); ++k) direction_[k] = -gradient_[k];
    solver.solve(std::span(direction_).first(problem.unknowns()));
    const double alpha = line_search(problem, d);
    for (std::size_t k = 0; k < d.size(); ++k) d[k] += alpha * direction_[k];
    evaluate(problem, d);
    problem.gradient(d, r_, gradient_);
    if (alpha == 1.0 && active_ == assumed_) return true;
    if (problem.residual_ratio(gradient_) < options.tolerance) return true;
  }
  return false;
}

bool OpenClose::update_bounds(StepProblem& problem, std::span<const contact::Contact> contacts,
                              std::span<contact::Memory* const> memory, double tolerance) {
  auto& rows = problem.rows();
  double error = 0.0, scale = 0.0;
  const auto bound = [&](std::size_t c) {
    const double normal = std::max(0.0, rows[c].spring.normal_force(rows[c].depth(r_[c])));
    return contacts[c].friction_coefficient * normal + (memory[c]->bonded ? contacts[c].cohesion : 0.0);
  };
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (contacts[c].fused) continue;
    // Only what the new bound does to the shear force counts: a contact that holds under both bounds is settled.
    const double wanted = bound(c), elastic = rows[c].spring.shear_stiffness() * rows[c].shear(r_[c]);
    const double change =
        std::clamp(elastic, -wanted, wanted) - rows[c].spring.shear_force(rows[c].shear(r_[c]));
    error += change * change;
    scale += wanted * wanted;
  }
  const double ratio = scale > 0.0 ? std::sqrt(error / scale) : 0.0;
  if (ratio <= tolerance) return false;
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (!contacts[c].fused) rows[c].spring.set_bound(bound(c));
  }
  return true;
}

/// Uzawa's iteration with a step between the stiffness of the spring and what the inertia of the blocks adds to it. False when
/// nothing penetrates and no contact that holds has drifted by more than `tolerance`, m, or when that stalls; springs are then
/// left alone.
bool OpenClose::augment(StepProblem& problem, std::span<const contact::Contact> contacts,
                        std::span<contact::Memory* const> memory, double tolerance) {
  auto& rows = problem.rows();
  double worst = 0.0;
  shift_.assign(rows.size(), {});
  for (std::size_t c = 0; c < rows.size(); ++c) {
    const StepProblem::Row& row = rows[c];
    if (!row.spring.closed(row.depth(r_[c]))) continue;
    const double penetration = -(contacts[c].gap + dot(row.normal, r_[c])) - std::max(0.0, memory[c]->offset);
    const bool holds = row.spring.bound() > 0.0 && row.spring.locked(row.shear(r_[c]));
    const double drift = holds ? memory[c]->drift + dot(row.tangent, r_[c]) : 0.0;
    worst = std::max({worst, std::abs(penetration), std::abs(drift)});
    // A quarter: up to eight contacts may share the inertia of a block before the iteration would overshoot.
    shift_[c] = {penetration * (1.0 + 0.25 * row.inertia / row.spring.normal_stiffness()),
                 drift * (1.0 + 0.25 * row.inertia / row.spring.shear_stiffness())};
  }
  if (worst <= tolerance) return false;
  // Where blocks have more constraints than unknowns the rest cannot be taken out: three updates in a row gain nothing.
  stalls_ = worst > 0.9 * worst_ ? stalls_ + 1 : 0;
  worst_ = worst;
  if (stalls_ == 3) return false;
  for (std::size_t c = 0; c < rows.size(); ++c) rows[c].spring.shift(shift_[c].x, shift_[c].y);
  return true;
}

bool OpenClose::break_bonds(StepProblem& problem, std::span<const contact::Contact> contacts,
                            std::span<contact::Memory* const> memory) {
  bool any = false;
  auto& rows = problem.rows();
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (!memory[c]->bonded || contacts[c].fused) continue;
    contact::Spring& s = rows[c].spring;
    const double normal = s.normal_force(rows[c].depth(r_[c]));
    if (-normal <= contacts[c].tension && s.locked(rows[c].shear(r_[c]))) continue;
    memory[c]->bonded = false;
    s.break_bond();
    s.set_bound(contacts[c].friction_coefficient * std::max(0.0, normal));
    any = true;
  }
  return any;
}

OpenCloseResult OpenClose::solve(StepProblem& problem, std::span<const contact::Contact> contacts,
                                 std::span<contact::Memory* const> memory, linalg::BlockSolver& solver,
                                 const SolverOptions& options, std::span<double> d) {
  const std::size_t rows = problem.rows().size();
  assumed_.resize(rows);
  active_.resize(rows);
  r_.resize(rows);
  r_direction_.resize(rows);
  gradient_.resize(d.size());
  direction_.resize(d.size());
  h_direction_.resize(d.size());
  for (std::size_t c = 0; c < rows; ++c) {
    const contact::Spring& s = problem.rows()[c].spring;
    assumed_[c] = {memory[c]->state != contact::State::open || s.tensile(),
                   memory[c]->state == contact::State::locked && s.bound() > 0.0};
  }
  OpenCloseResult result;
  const bool augmented = options.contact == ContactMethod::augmented_lagrangian;
  worst_ = HUGE_VAL;
  stalls_ = 0;
  bool warm = false;
  for (;;) {
    result.converged = minimize(problem, solver, options, warm, d, result);
    if (!result.converged) break;
    warm = true;
    if (break_bonds(problem, contacts, memory)) {
      result.bond_broken = true;
      continue;
    }
    if (augmented && result.multiplier_updates < options.max_multiplier_updates &&
        augment(problem, contacts, memory, options.penetration_tolerance * problem.block_size())) {
      ++result.multiplier_updates;
      continue;
    }
    const double tolerance =
        result.bound_updates == 0 && !augmented ? options.bound_tolerance : options.bound_accuracy;
    if (result.bound_updates >= options.max_bound_updates) break;
    if (!update_bounds(problem, contacts, memory, tolerance)) break;
    ++result.bound_updates;
  }
  result.residual_ratio = problem.residual_ratio(gradient_);
  return result;
}

}  // namespace keyblock::dynamics
