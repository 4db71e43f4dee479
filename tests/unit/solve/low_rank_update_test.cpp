#include "solve/low_rank_update.h"

#include <gtest/gtest.h>

#include "../one_step.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {
namespace {

/// Two blocks on the ground, side by side, at rest.
simulation::Scene two_blocks() {
  simulation::Scene scene(1e8, 30.0);
  scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  scene.rectangle({1.0, 0.0}, 1.0, 0.5, 0.0, false, 2);
  return scene;
}

/// Two blocks that come to rest, of which the first is then struck: some of its contacts open, others slide.
struct Struck {
  Struck() : s(two_blocks()) {
    s.run(0.1, 0.005);
    s.state.velocity[s.model.blocks[1].first] -= 0.3;
    s.state.velocity[s.model.blocks[1].first + 1] += 0.05;
  }
  simulation::Simulator s;
};

/// An update of a step whose matrix is factored with the springs of the step before.
struct Update {
  Update(simulation::Simulator& s, linalg::Precision precision)
      : solver(linalg::make_block_cholesky(precision)), step(s, *solver) {
    matrix.assemble(step.system());
    is_factored = solver->factor();
  }
  bool minimize(bool from_zero) {
    return update.minimize(step.system(), step.iterate, matrix, false, from_zero, step.result);
  }
  std::unique_ptr<linalg::BlockSolver> solver;
  OneStep step;
  StepMatrix matrix;
  LowRankUpdate update;
  bool is_factored = false;
};

TEST(LowRankUpdate, FindsTheMinimumThatNewtonFinds) {
  for (const auto precision : {linalg::Precision::full, linalg::Precision::single}) {
    Struck struck;
    const std::vector<double> expected = plain_increment(struck.s);
    Update with(struck.s, precision);
    ASSERT_TRUE(with.is_factored);
    ASSERT_TRUE(with.minimize(true));
    EXPECT_GT(with.update.size(), 0U);
    EXPECT_GT(with.step.result.changes, 0U);
    const double tolerance = struck.s.model.solver.tolerance;
    EXPECT_LE(with.step.out_of_balance(), tolerance);
    EXPECT_LE(with.step.iterate.out_of_balance(with.step.system()), tolerance);
    EXPECT_LT(apart(with.step.d, expected), tolerance * largest_of(expected));
  }
}

// What is known at D is used: from the minimum there is nothing left to do.
TEST(LowRankUpdate, BeginsWhereTheIncrementIs) {
  Struck struck;
  const std::vector<double> expected = plain_increment(struck.s);
  Update with(struck.s, linalg::Precision::full);
  const StepSystem system = with.step.system();
  for (std::size_t k = 0; k < expected.size(); ++k) with.step.d[k] = 0.9 * expected[k];
  with.step.iterate.place(system);
  with.step.iterate.find_gradient(system);
  ASSERT_TRUE(with.minimize(false));
  EXPECT_LT(apart(with.step.d, expected), struck.s.model.solver.tolerance * largest_of(expected));
}

TEST(LowRankUpdate, ResetForgetsTheSprings) {
  Struck struck;
  const std::vector<double> expected = plain_increment(struck.s);
  Update with(struck.s, linalg::Precision::full);
  ASSERT_TRUE(with.minimize(true));
  EXPECT_EQ(with.update.rows().size(), with.update.size());
  with.update.reset();
  EXPECT_EQ(with.update.size(), 0U);
  EXPECT_TRUE(with.update.rows().empty());
  // The springs are found again.
  std::ranges::fill(with.step.d, 0.0);
  ASSERT_TRUE(with.minimize(true));
  EXPECT_GT(with.update.size(), 0U);
  EXPECT_LT(apart(with.step.d, expected), struck.s.model.solver.tolerance * largest_of(expected));
}

// Stones that are all thrown into the air at once. What was done until then is a state from which Newton's method goes on.
TEST(LowRankUpdate, GivesUpWhereTooManySpringsAct) {
  constexpr int stones = 80;
  simulation::Scene scene(1e8, 30.0);
  scene.rectangle({-1.0, -1.0}, 2.0 * stones + 2.0, 1.0, 0.0, true);
  for (int k = 0; k < stones; ++k) scene.rectangle({2.0 * k, 0.0}, 1.0, 0.5);
  simulation::Simulator s(scene);
  s.run(0.05, 0.005);
  for (int k = 1; k <= stones; ++k)
    s.state.velocity[s.model.blocks[static_cast<std::size_t>(k)].first + 1] += 0.5;
  Update with(s, linalg::Precision::full);
  ASSERT_TRUE(with.is_factored);
  EXPECT_FALSE(with.minimize(true));
  EXPECT_LE(with.update.size(), step_numbers::most_corrected);
  std::vector<double> g(with.step.d.size());
  gradient_by_rows(with.step.problem, with.step.d, g);
  EXPECT_GT(with.step.out_of_balance(), s.model.solver.tolerance);
  EXPECT_LT(apart(g, with.step.iterate.gradient), 1e-9 * largest_of(g));
}

}  // namespace
}  // namespace keyblock::dynamics
