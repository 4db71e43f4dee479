#include "solve/followed_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../one_step.h"
#include "solve/law_updates.h"
#include "solve/low_rank_update.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {
namespace {

TEST(FollowedBounds, AreThoseThatChangeMost) {
  FollowedBounds bounds;
  std::vector<FollowedBounds::Change> changes{{3, 1.0}, {5, 1e-6}, {7, 4.0}, {9, 1.0}, {11, 1e-5}};
  bounds.choose(changes);
  EXPECT_THAT(bounds.contacts(), ::testing::ElementsAre(7, 3, 9));
  // Those that are followed stay so.
  changes = {{7, 4.0}, {5, 2.0}};
  bounds.choose(changes);
  EXPECT_THAT(bounds.contacts(), ::testing::ElementsAre(7, 3, 9, 5));
  bounds.reset();
  EXPECT_TRUE(bounds.contacts().empty());
  changes.clear();
  for (std::size_t c = 0; c < 3 * step_numbers::most_followed; ++c) changes.push_back({c, 1.0});
  bounds.choose(changes);
  EXPECT_EQ(bounds.contacts().size(), step_numbers::most_followed);
}

/// A wall whose blocks slide when it is struck.
simulation::Scene wall() {
  simulation::Scene scene(1e8, 30.0);
  scene.rectangle({-1.0, -1.0}, 8.0, 1.0, 0.0, true);
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 4; ++k) scene.rectangle({k + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5);
  }
  return scene;
}

/// Of the contacts whose bounds are followed: by how much the shear forces are not those of their normal forces, and the bounds (L2).
std::pair<double, double> error_of_bounds(const SpringArray& springs, const FollowedBounds& bounds) {
  double error = 0.0, scale = 0.0;
  for (const std::size_t c : bounds.contacts()) {
    const double wanted = springs.strength(c, springs.force(c).normal);
    error += std::pow(std::clamp(springs.ks[c] * springs.w[c], -wanted, wanted) - springs.force(c).shear, 2);
    scale += wanted * wanted;
  }
  return {std::sqrt(error), std::sqrt(scale)};
}

// After one minimization they agree with the normal forces of its end, and what is out of balance is as little as with frozen bounds.
TEST(FollowedBounds, AgreeWithNormalForcesAtTheMinimum) {
  for (const auto precision : {linalg::Precision::full, linalg::Precision::single}) {
    simulation::Simulator s(wall());
    s.run(0.1, 0.005);
    s.state.velocity[s.model.blocks[6].first] -= 0.5;
    s.state.velocity[s.model.blocks[6].first + 1] -= 0.3;
    const auto solver = linalg::make_block_cholesky(precision);
    OneStep step(s, *solver);
    StepMatrix matrix;
    LowRankUpdate update;
    LawUpdates laws;
    laws.begin();
    const StepSystem system = step.system();
    matrix.assemble(system);
    ASSERT_TRUE(solver->factor());
    ASSERT_TRUE(update.minimize(system, step.iterate, matrix, false, true, step.result));
    ASSERT_TRUE(laws.update_bounds(system, step.iterate, 1e-9, update.bounds()));
    ASSERT_FALSE(update.bounds().contacts().empty());
    ASSERT_TRUE(update.minimize(system, step.iterate, matrix, false, false, step.result));
    const auto [error, scale] = error_of_bounds(system.springs(), update.bounds());
    EXPECT_GT(scale, 0.0);
    EXPECT_LT(error, s.model.solver.bound_accuracy * scale);
    EXPECT_LE(step.out_of_balance(), s.model.solver.tolerance);
    EXPECT_LE(step.iterate.out_of_balance(system), s.model.solver.tolerance);
  }
}

}  // namespace
}  // namespace keyblock::dynamics
