#include "dynamics/force_balance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"
#include "coupling/coupling.h"

namespace keyblock::dynamics {

namespace {

double length_of(std::span<const double> numbers) {
  double squared = 0.0;
  for (const double v : numbers) squared += v * v;
  return std::sqrt(squared);
}

std::span<const double> coefficients_of(const Block& block, std::span<const double> all) {
  return all.subspan(block.first, 2 * at(block.size));
}

}  // namespace

void ForceBalance::predict(const Model& model, const StepProblem& problem, std::span<const double> d) {
  left_.assign(model.blocks.size(), 0.0);
  left_down_.assign(model.blocks.size(), 0.0);
  const double g = norm(model.gravity);
  const Vec2 down = g > 0.0 ? model.gravity / g : Vec2{};
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    const std::span<const double> of_block = coefficients_of(model.blocks[b], d);
    left_[b] = problem.terms().inertia(b) * length_of(of_block);
    left_down_[b] = problem.terms().inertia(b) * dot(down, {of_block[0], of_block[1]});
  }
  left_of_lines_ = 0.0;
  for (std::size_t b = model.blocks.size(); b < model.bodies(); ++b) {
    const Body& body = model.body(b);
    const double left = problem.terms().inertia(b) * length_of(d.subspan(body.first, 2 * at(body.size)));
    left_of_lines_ = std::max(left_of_lines_, left / std::max(problem.terms().weight(b), 1e-300));
  }
}

void ForceBalance::find_scales(const Model& model, const StepProblem& problem) {
  constexpr double least_share = 1e-4;  // of the largest scale
  const std::size_t n = model.blocks.size();
  scale_.resize(n);
  for (std::size_t b = 0; b < n; ++b) scale_[b] = problem.terms().weight(b);
  if (norm(model.gravity) > 0.0) return;
  force_.assign(model.bodies(), 0.0);
  for (std::size_t c = 0; c < problem.springs().size(); ++c) {
    const SpringArray::Force force = problem.springs().force(c);
    for (const int unknown : {problem.rows()[c].unknown_a, problem.rows()[c].unknown_b})
      if (unknown >= 0)
        force_[problem.points().block_of_unknown(at(unknown))] += std::hypot(force.normal, force.shear);
  }
  for (std::size_t b = 0; b < n; ++b)
    force_[b] = model.moves(b) ? force_[b] / std::sqrt(model.blocks[b].area) : 0.0;
  // A block with a load or a support of its own may have no contacts.
  for (const GeneralizedLoad& load : model.loads) force_[at(load.block)] = HUGE_VAL;
  for (const int block : held_blocks(model)) force_[at(block)] = HUGE_VAL;
  double largest = 0.0;
  for (std::size_t b = 0; b < n; ++b) {
    if (!model.moves(b)) continue;
    scale_[b] = std::min(scale_[b], force_[b]);
    largest = std::max(largest, scale_[b]);
  }
  for (double& scale : scale_) scale = std::max(scale, least_share * largest);
}

/// Of a strain, a few ε of 1; the force of it on a coefficient of stiffness K = E |∇φ|² A is E |∇φ| A. Of a depth
/// and of the stretch of a support, a few ε of a coordinate.
void ForceBalance::find_rounding(const Model& model, const StepProblem& problem) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double extent = 0.0;
  for (const Vec2 x : model.surface.position) extent = std::max({extent, std::abs(x.x), std::abs(x.y)});
  force_.assign(model.bodies(), 0.0);
  for (std::size_t c = 0; c < problem.springs().size(); ++c) {
    if (problem.springs().force(c).is_zero()) continue;
    for (const int unknown : {problem.rows()[c].unknown_a, problem.rows()[c].unknown_b})
      if (unknown >= 0)
        force_[problem.points().block_of_unknown(at(unknown))] += problem.springs().stiffness(c) * extent;
  }
  for (const auto& coupling : model.couplings) coupling->add_rounding_forces(model, extent, force_);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    if (!model.moves(b)) continue;
    const double elastic =
        std::sqrt(problem.terms().largest_stiffness(b) * block.material.young * block.area);
    of_[b].rounding = epsilon * (elastic + force_[b] / std::sqrt(block.area)) / std::max(scale_[b], 1e-300);
  }
}

void ForceBalance::take_bounds(StepProblem& problem) {
  SpringArray& springs = problem.springs();
  for (std::size_t c = 0; c < springs.size(); ++c) {
    if (springs.friction[c] < 0.0) continue;
    springs.set_bound(c, springs.strength(c, springs.bearing(c)));
  }
}

void ForceBalance::measure(const Model& model, const StepProblem& problem) {
  const SpringArray& springs = problem.springs();
  zero_.assign(model.coefficients, 0.0);
  gradient_.resize(model.coefficients);
  problem.gradient(
      zero_, [&](std::size_t c) { return problem.rows()[c].gradient(springs.force(c)); }, at_vertices_,
      gradient_);
  find_scales(model, problem);
  const std::size_t n = model.blocks.size();
  of_.assign(n, {});
  body_force_.resize(n);
  const double g = norm(model.gravity);
  for (std::size_t b = 0; b < n; ++b) {
    const Block& block = model.blocks[b];
    body_force_[b] = block.body_force();
    if (!model.moves(b)) continue;
    const double scale = std::max(scale_[b], 1e-300);
    of_[b].ratio = length_of(coefficients_of(block, gradient_)) / scale;
    of_[b].predicted = left_[b] / scale;
    if (g > 0.0) of_[b].falling = left_down_[b] / (g * block.body_force());
  }
  find_rounding(model, problem);
}

}  // namespace keyblock::dynamics
