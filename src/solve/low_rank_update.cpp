#include "solve/low_rank_update.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

using Force = SpringArray::Force;

/// Takes the force of one spring out of the gradient.
void leave_out(const StepSystem& system, Iterate& iterate, std::size_t row, bool normal, double force) {
  iterate.add_force(system, row, {normal ? force : 0.0, normal ? 0.0 : force}, -1.0);
}

}  // namespace

std::size_t LowRankUpdate::limit(const StepSystem& system) {
  using namespace step_numbers;
  // Without inertia little is left of a block whose springs are taken away.
  if (system.problem.is_static()) return least_corrected;
  return std::clamp(system.problem.model().blocks.size() / blocks_of_corrected, least_corrected,
                    most_corrected);
}

bool LowRankUpdate::is_exact(const StepSystem& system, bool is_kept) const {
  return !is_kept && !faces_bend_ && system.solver.low_rank()->is_exact() &&
         updated_.size() <= step_numbers::most_exact;
}

/// Faces of joints that press otherwise than the matrix has it are refined for, from then on.
void LowRankUpdate::look_at_faces(const StepSystem& system, const StepMatrix& matrix) {
  faces_bend_ = faces_bend_ || !matrix.has_faces_as_they_press(system.springs());
}

std::vector<std::size_t> LowRankUpdate::rows() const {
  std::vector<std::size_t> rows;
  for (const Spring spring : updated_) rows.push_back(spring.row);
  return rows;
}

bool LowRankUpdate::minimize(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool is_kept,
                             bool from_zero, OpenCloseResult& result) {
  if (!iterate_until_done(system, iterate, matrix, is_kept, from_zero, result)) {
    iterate.place_if_moved(system);
    iterate.find_gradient(system);
    return false;
  }
  if (is_exact(system, is_kept)) find_rest(system, iterate, matrix);
  result.changes += updated_.size();
  return true;
}

/// Finds the gradient where what the factor gets wrong is to be refined away. `wants`: whether.
bool LowRankUpdate::refines(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool wants) {
  if (!wants) return false;
  iterate.find_gradient(system);
  leave_out_wanted(system, iterate, matrix);
  return true;
}

bool LowRankUpdate::iterate_until_done(const StepSystem& system, Iterate& iterate, StepMatrix& matrix,
                                       bool is_kept, bool from_zero, OpenCloseResult& result) {
  const std::span<double> direction = std::span(iterate.direction).first(system.problem.model().unknowns);
  const double enough =
      (is_kept ? step_numbers::kept_share : step_numbers::linear_share) * system.options.tolerance;
  if (!begin(system, iterate, matrix, is_kept, enough, from_zero, direction)) return false;
  go(system, iterate, matrix, direction, result);
  for (int refinements = 0;;) {
    if (updated_.size() + wanted_.size() > limit(system)) return false;
    take_wanted(system, matrix);
    const std::size_t fresh = wanted_.size();
    // What the factor gets wrong is refined away at the end, until nothing of it is left, and what that of an earlier step does
    // along with the first springs that come to be updated.
    const bool wants = fresh == 0 ? !is_exact(system, is_kept) : is_kept && refinements == 0;
    const bool fits = !refines(system, iterate, matrix, wants) || iterate.out_of_balance(system) <= enough;
    if (fits && fresh == 0) return true;
    if (fits) {
      std::ranges::fill(direction, 0.0);
    } else {
      if (refinements++ == step_numbers::most_refinements) return false;
      ++result.refinements;
      iterate.turn_against_gradient(direction.size());
    }
    if (!solve(system, matrix, fresh, direction)) return false;
    go(system, iterate, matrix, direction, result);
  }
}

/// The first way from D, into `direction`. False when it is not found.
bool LowRankUpdate::begin(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool is_kept,
                          double enough, bool from_zero, std::span<double> direction) {
  faces_bend_ = false;
  if (!from_zero) {
    look_at_faces(system, matrix);
    matrix.find_differing(system);
    find_wanted(system.springs(), matrix);
    leave_out_wanted(system, iterate, matrix);
    iterate.turn_against_gradient(direction.size());
    return solve(system, matrix, 0, direction);
  }
  start_on_lines(system, iterate, matrix);
  if (is_kept || system.solver.low_rank()->is_exact())
    return solve(system, matrix, updated_.size(), direction);
  // A long way: what its last digits lack would have springs seem to act otherwise that do not.
  const Profile::Scope scope(system.profile, Phase::solution);
  system.solver.solve(direction, std::span(iterate.residual).first(direction.size()),
                      system.excess_over(enough), linalg::BlockSolver::Residual::estimated);
  return system.solver.solved();
}

/// −∇Π at D = 0 into the direction, with all springs on the straight lines of the factored matrix.
void LowRankUpdate::start_on_lines(const StepSystem& system, Iterate& iterate, const StepMatrix& matrix) {
  const SpringArray& springs = system.springs();
  const std::span<const double> right = system.problem.terms().right();
  std::copy(right.begin(), right.end(), iterate.direction.begin());
  const std::vector<double> faces = matrix.face_lines(springs, springs.y0);
  const auto minus_gradient = [&](std::size_t c) {
    Force force = springs.force_on(c, matrix.branch(c), springs.y0[c], springs.w0[c]);
    if (!faces.empty()) force.normal += faces[c];
    return -1.0 * system.row(c).gradient(force);
  };
  system.problem.add_forces(minus_gradient, iterate.vertex_force, iterate.direction);
}

/// D ← D + direction; springs that act otherwise than the matrix has them there and are not updated yet, into wanted_.
void LowRankUpdate::go(const StepSystem& system, Iterate& iterate, StepMatrix& matrix,
                       std::span<const double> direction, OpenCloseResult& result) {
  ++result.iterations;
  const std::span<double> d = iterate.increment;
  in_lanes(static_cast<int>(direction.size()), [&](int k, int count) {
    store_first(&d[at(k)], load_first(&d[at(k)], count) + load_first(&direction[at(k)], count), count);
  });
  for (const std::size_t b : matrix.free_blocks()) system.problem.terms().solve_alone(b, d);
  iterate.place(system);
  look_at_faces(system, matrix);
  matrix.find_differing(system);
  find_wanted(system.springs(), matrix);
}

/// The way that the springs on their lines would go, in `direction`, becomes that with the springs that are updated, the last `fresh` of which
/// are on the straight lines of the matrix so far. False when their forces are not found; none are updated then.
bool LowRankUpdate::solve(const StepSystem& system, const StepMatrix& matrix, std::size_t fresh,
                          std::span<double> direction) {
  linalg::LowRankSolver& halves = *system.solver.low_rank();
  {
    const Profile::Scope scope(system.profile, Phase::solution);
    halves.forward_solve(direction, base_);
  }
  if (!find_forces(system, matrix, fresh)) {
    reset();
    return false;
  }
  const Profile::Scope scope(system.profile, Phase::solution);
  corrections_.finish(halves, base_, direction);
  return true;
}

/// The law of a spring, and how far it is stretched at D, m. A spring that the matrix has with another stiffness keeps that, stretched so that its
/// force at D is right. One that is none any more, as its contact has become one of a face of a joint, has no force.
double LowRankUpdate::find_law(const SpringArray& springs, const StepMatrix& matrix, Spring spring,
                               Corrections::Law& law) {
  const auto [c, normal] = spring;
  const Force constant = springs.force_on(c, matrix.branch(c), 0.0, 0.0);
  const double in_matrix = normal ? matrix.normal_stiffness(c) : matrix.shear_stiffness(c),
               now = normal ? springs.kn[c] : springs.ks[c], own = now > 0.0 ? now : 1.0,
               stiffness = in_matrix > 0.0 ? in_matrix : own;
  law.spring = normal ? springs.normal_law(c) : springs.shear_law(c);
  law.spring.stiffness = stiffness;
  if (now == 0.0) law.spring.low = law.spring.high = 0.0;
  law.line_stiffness = in_matrix;
  law.line_force = normal ? constant.normal : constant.shear;
  return now / stiffness * (normal ? springs.y[c] : springs.w[c]);
}

/// How the forces of the springs that are updated change on the way from D. False when that is not found.
bool LowRankUpdate::find_forces(const StepSystem& system, const StepMatrix& matrix, std::size_t fresh) {
  const SpringArray& springs = system.springs();
  laws_.clear();
  stretch_.clear();
  force_.assign(updated_.size(), 0.0);
  for (std::size_t k = 0; k < updated_.size(); ++k) {
    Corrections::Law& law = laws_.emplace_back();
    stretch_.push_back(find_law(springs, matrix, updated_[k], law));
    const bool is_fresh = k + fresh >= updated_.size();
    if (!is_fresh) force_[k] = law.excess(stretch_.back());
    law.line_force += force_[k];
  }
  if (!corrections_.solve(*system.solver.low_rank(), base_, laws_, stretch_)) return false;
  for (std::size_t k = 0; k < updated_.size(); ++k) force_[k] += corrections_.forces()[k];
  return true;
}

/// Springs of the rows that differ from the matrix and are not updated yet.
void LowRankUpdate::find_wanted(const SpringArray& springs, const StepMatrix& matrix) {
  wanted_.clear();
  for (const std::size_t c : matrix.differing()) {
    const SpringArray::Branch is = springs.branch[c], line = matrix.branch(c);
    for (const bool normal : {true, false}) {
      const Spring spring{c, normal};
      if (normal ? is.closed == line.closed : is.shear == line.shear) continue;
      if (!is_updated(spring)) wanted_.push_back(spring);
    }
  }
}

void LowRankUpdate::remember_places() {
  place_.clear();
  for (std::size_t k = 0; k < updated_.size(); ++k) {
    const std::size_t number = updated_[k].number();
    if (place_.size() <= number) place_.resize(number + 1, 0);
    place_[number] = k + 1;
  }
}

void LowRankUpdate::carry(std::span<const std::size_t> now) {
  for (Spring& spring : updated_) spring.row = now[spring.row];
  remember_places();
}

/// Those in wanted_ are updated from now on.
void LowRankUpdate::take_wanted(const StepSystem& system, StepMatrix& matrix) {
  if (parts_.size() < wanted_.size()) parts_.resize(wanted_.size());
  vectors_.clear();
  for (std::size_t k = 0; k < wanted_.size(); ++k) {
    const Spring spring = wanted_[k];
    auto& [a, b] = parts_[k];
    const Row& row = system.row(spring.row);
    system.problem.derivative(row, spring.normal ? -1.0 * row.normal : row.tangent(), a, b);
    vectors_.push_back({{row.unknown_a, a}, {row.unknown_b, b}});
    updated_.push_back(spring);
    matrix.take_hold(system.problem, row);
  }
  corrections_.add(*system.solver.low_rank(), vectors_);
  remember_places();
}

/// Takes out of the gradient what the springs in wanted_, which the increment knows nothing of, do otherwise than the matrix has them.
void LowRankUpdate::leave_out_wanted(const StepSystem& system, Iterate& iterate, const StepMatrix& matrix) {
  for (const Spring spring : wanted_) {
    const Force force = matrix.force_beside(system.springs(), spring.row);
    leave_out(system, iterate, spring.row, spring.normal, spring.normal ? force.normal : force.shear);
  }
  if (!wanted_.empty()) iterate.gradient_changed();
}

/// ∇Π where all but the springs that differ are on the straight lines of a matrix that has been solved exactly: what these do otherwise than
/// they have been updated to.
void LowRankUpdate::find_rest(const StepSystem& system, Iterate& iterate, const StepMatrix& matrix) {
  std::fill(iterate.gradient.begin(), iterate.gradient.end(), 0.0);
  iterate.gradient_changed();
  for (const std::size_t c : matrix.differing())
    iterate.add_force(system, c, matrix.force_beside(system.springs(), c));
  for (std::size_t k = 0; k < updated_.size(); ++k)
    leave_out(system, iterate, updated_[k].row, updated_[k].normal, force_[k]);
}

}  // namespace keyblock::dynamics
