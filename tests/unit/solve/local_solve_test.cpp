#include "solve/local_solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "../one_step.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {
namespace {

/// The first linear system of a step in which one brick is struck.
struct StruckWall {
  explicit StruckWall(double blow_to_all = 0.0) : s(long_wall()) {
    s.run(0.01, 0.005);
    for (const Block& block : s.model.blocks) {
      if (!block.fixed) s.state.velocity[block.first + 1] += blow_to_all;
    }
    s.state.velocity[s.model.blocks[struck].first] += 3.0;
    solver = linalg::make_block_conjugate_residual(&s.team);
    step.emplace(s, *solver);
    step->iterate.place(step->system());
    step->iterate.find_gradient(step->system());
    std::ranges::fill(step->iterate.direction, 0.0);
    matrix.assemble(step->system());
    is_factored = solver->factor();
  }
  [[nodiscard]] double enough() {
    return step_numbers::forcing_local * step->iterate.out_of_balance(step->system());
  }
  bool solve() { return local.solve(step->system(), step->iterate, enough()); }

  /// A x, block by block and contact by contact.
  [[nodiscard]] std::vector<double> matrix_times(std::span<const double> x) const {
    const StepProblem& problem = step->problem;
    std::vector<double> y(x.size(), 0.0);
    for (std::size_t b = 0; b < problem.model().blocks.size(); ++b) {
      if (problem.model().moves(b)) problem.terms().multiply(b, x, y);
    }
    for (std::size_t c = 0; c < problem.rows().size(); ++c) {
      const Row& row = problem.rows()[c];
      const Vec2 r = problem.relative(row, x);
      const SpringArray::Force force{-matrix.normal_stiffness(c) * dot(row.normal, r),
                                     matrix.shear_stiffness(c) * dot(row.tangent(), r)};
      problem.add_force(row, row.gradient(force), y);
    }
    return y;
  }

  static constexpr std::size_t struck = 75;
  simulation::Simulator s;
  std::unique_ptr<linalg::BlockSolver> solver;
  std::optional<OneStep> step;
  StepMatrix matrix;
  LocalSolve local;
  bool is_factored = false;
};

TEST(LocalSolve, SolvesTheSystemNearTheBlocksThatAreOutOfBalance) {
  StruckWall wall;
  ASSERT_TRUE(wall.is_factored);
  const double enough = wall.enough();
  ASSERT_TRUE(wall.solve());
  EXPECT_TRUE(wall.local.is_active());
  EXPECT_TRUE(wall.solver->solved());
  const auto moved = wall.local.moved_blocks();
  EXPECT_NE(std::ranges::find(moved, StruckWall::struck), moved.end());
  EXPECT_LT(moved.size(), wall.s.model.blocks.size() / 4);
  // A p = −g − ρ, and ρ is small where blocks move.
  const Iterate& iterate = wall.step->iterate;
  std::vector<double> error = wall.matrix_times(iterate.direction);
  for (const std::size_t b : wall.local.blocks()) {
    const auto [first, last] = wall.step->problem.terms().coefficients(b);
    for (std::size_t k = first; k < last; ++k)
      EXPECT_NEAR(error[k], -iterate.gradient[k] - iterate.residual[k],
                  1e-6 * wall.step->problem.terms().weight(b));
  }
  for (std::size_t k = 0; k < error.size(); ++k) error[k] += iterate.gradient[k];
  for (const std::size_t b : moved)
    EXPECT_LE(wall.step->problem.terms().residual_ratio(b, error), 1.001 * enough);
}

TEST(LocalSolve, KnowsWhatItDoesToItsContacts) {
  StruckWall wall;
  ASSERT_TRUE(wall.solve());
  const StepSystem system = wall.step->system();
  wall.local.find_direction(system, wall.step->iterate);
  std::vector<std::uint8_t> moves(wall.s.model.blocks.size(), 0);
  for (const std::size_t b : wall.local.moved_blocks()) moves[b] = 1;
  std::vector<std::size_t> expected;
  for (std::size_t c = 0; c < wall.step->contacts.size(); ++c) {
    const contact::Contact& contact = wall.step->contacts[c];
    if (moves[static_cast<std::size_t>(contact.block_a)] + moves[static_cast<std::size_t>(contact.block_b)] >
        0)
      expected.push_back(c);
  }
  std::vector<std::size_t> contacts(wall.local.rows().begin(), wall.local.rows().end());
  std::ranges::sort(contacts);
  EXPECT_EQ(contacts, expected);
  const double largest = largest_of(wall.step->iterate.direction);
  for (const std::size_t c : contacts) {
    const Row& row = system.row(c);
    const Vec2 r = wall.step->problem.relative(row, wall.step->iterate.direction);
    EXPECT_NEAR(system.springs().dy[c], -dot(row.normal, r), 1e-12 * largest);
    EXPECT_NEAR(system.springs().dw[c], dot(row.tangent(), r), 1e-12 * largest);
  }
}

TEST(LocalSolve, LeavesSystemsOfManyBlocksAlone) {
  StruckWall wall(3.0);
  EXPECT_FALSE(wall.solve());
  EXPECT_FALSE(wall.local.is_active());
  EXPECT_EQ(largest_of(wall.step->iterate.direction), 0.0);
}

TEST(LocalSolve, ResetEndsIt) {
  StruckWall wall;
  ASSERT_TRUE(wall.solve());
  const std::vector<double> first = wall.step->iterate.direction;
  wall.local.reset();
  EXPECT_FALSE(wall.local.is_active());
  std::ranges::fill(wall.step->iterate.direction, 0.0);
  ASSERT_TRUE(wall.solve());
  EXPECT_EQ(wall.step->iterate.direction, first);
}

TEST(LocalSolve, ServesIterativeSolversInDynamicSteps) {
  StruckWall wall;
  EXPECT_TRUE(LocalSolve::serves(wall.step->system()));
  wall.s.model.solver.accelerators.local_solve = false;
  EXPECT_FALSE(LocalSolve::serves(wall.step->system()));
  EXPECT_FALSE(wall.solve());
  wall.s.model.solver.accelerators.local_solve = true;

  const auto direct = linalg::make_block_cholesky();
  OneStep with_factor(wall.s, *direct);
  EXPECT_FALSE(LocalSolve::serves(with_factor.system()));

  OneStep at_rest(wall.s, *wall.solver);
  at_rest.next.drive.is_static = true;
  const std::vector<double> inertia_scale(wall.s.model.blocks.size(), 1.0);
  at_rest.next.drive.inertia_scale = inertia_scale;
  at_rest.problem.build(wall.s.model, wall.s.state, at_rest.next.drive, at_rest.coupled, wall.s.team);
  EXPECT_FALSE(LocalSolve::serves(at_rest.system()));
}

}  // namespace
}  // namespace keyblock::dynamics
