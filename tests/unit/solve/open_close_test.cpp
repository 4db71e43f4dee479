#include "solve/open_close.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../one_step.h"

namespace keyblock::dynamics {
namespace {

using simulation::Scene;
using simulation::Simulator;

/// Three rows of blocks.
Scene wall() {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 10.0, 1.0, 0.0, true);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      scene.rectangle({column + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5);
  }
  return scene;
}

/// At rest; each block is then given a velocity of its own.
struct ShakenWall : Simulator {
  explicit ShakenWall(unsigned seed) : Simulator(wall()) {
    run(0.1, 0.005);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> speed(-0.3, 0.3);
    for (const Block& block : model.blocks) {
      if (block.fixed) continue;
      for (std::size_t k = 0; k < 2; ++k) state.velocity[block.first + k] += speed(random);
    }
  }
};

struct Closed {
  explicit Closed(Simulator& s)
      : solver(linalg::make_block_cholesky(linalg::Precision::full)), step(s, *solver) {
    result = open_close.solve(step.system(), step.d);
  }
  std::unique_ptr<linalg::BlockSolver> solver;
  OneStep step;
  OpenClose open_close;
  OpenCloseResult result;
};

TEST(OpenClose, EndsWhereForcesBalanceAndTheLawsOfContactsHold) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    ShakenWall s(seed);
    Closed closed(s);
    ASSERT_TRUE(closed.result.converged) << seed;
    EXPECT_LE(closed.step.out_of_balance(), s.model.solver.tolerance) << seed;
    const SpringArray& springs = closed.step.problem.springs();
    double scale = 0.0, error = 0.0;
    for (std::size_t c = 0; c < closed.step.contacts.size(); ++c) {
      const SpringArray::Force force = springs.force(c);
      EXPECT_GE(force.normal, 0.0) << seed << ' ' << c;
      EXPECT_EQ(force.normal > 0.0, springs.y[c] > 0.0) << seed << ' ' << c;
      EXPECT_LE(std::abs(force.shear), springs.bound[c] * (1.0 + 1e-12)) << seed << ' ' << c;
      // Coulomb's bound is that of the normal force at hand, within the tolerance of its iteration.
      scale += springs.bound[c] * springs.bound[c];
      const double change = std::abs(force.shear) < springs.bound[c]
                                ? 0.0
                                : springs.strength(c, springs.bearing(c)) - springs.bound[c];
      error += change * change;
    }
    EXPECT_LE(std::sqrt(error), 1.5 * s.model.solver.bound_tolerance * std::sqrt(scale)) << seed;
  }
}

TEST(OpenClose, EndsAtTheSameWithoutAnyAccelerator) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    ShakenWall fast(seed), slow(seed);
    for (ShakenWall* s : {&fast, &slow}) simulation::settle_bounds(s->model.solver);
    for (const auto& [name, accelerator] : accelerator_names)
      slow.model.solver.accelerators.*accelerator = false;
    Closed with(fast), without(slow);
    ASSERT_TRUE(with.result.converged && without.result.converged) << seed;
    EXPECT_LT(apart(with.step.d, without.step.d), 1e-4 * largest_of(without.step.d)) << seed;
  }
}

TEST(OpenClose, AsksWhetherToGiveUpBeforeBoundsAreTakenAnew) {
  ShakenWall s(1);
  const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
  OneStep step(s, *solver);
  OpenClose open_close;
  int asked = 0;
  const OpenCloseResult result = open_close.solve(step.system(), step.d, [&] {
    ++asked;
    return true;
  });
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(result.given_up);
  EXPECT_EQ(result.bound_updates, 1);
}

TEST(OpenClose, StopsWhenItIsTold) {
  ShakenWall s(1);
  const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
  OneStep step(s, *solver);
  const std::atomic<bool> stop = true;
  OpenClose open_close(&stop);
  EXPECT_THROW(open_close.solve(step.system(), step.d), Interrupted);
}

}  // namespace
}  // namespace keyblock::dynamics
