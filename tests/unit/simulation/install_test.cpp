#include "simulation/install.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../hung_block.h"
#include "../resumed_run.h"
#include "simulation/energy_audit.h"
#include "simulation/runner.h"

namespace keyblock::simulation {
namespace {

constexpr double stiffness = hanger_stiffness;

/// m, by which the block has gone up since before the run, at the end of each stage.
std::vector<double> heights(const RunSetup& setup) {
  std::vector<double> at_ends;
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  while (!runner.done()) {
    if (runner.advance().ended_stage)
      at_ends.push_back(runner.state().position[runner.model().blocks[1].first + 1] - 0.5);
  }
  return at_ends;
}

TEST(Install, ASupportCarriesWhatComesAfterIt) {
  const std::vector<double> height = heights(hung_block().setup);
  const double weight = 2600.0 * g;
  ASSERT_EQ(height.size(), 4u);
  EXPECT_NEAR(height[0], -1.2 * weight / stiffness, 1e-4 * weight / stiffness);
  EXPECT_NEAR(height[1], height[0], 1e-12);
  EXPECT_NEAR(height[2] - height[1], 0.2 * weight / (2.0 * stiffness), 1e-4 * weight / stiffness);
}

TEST(Install, AddsNoEnergy) {
  const Scene scene = hung_block();
  record::RunObserver nobody;
  Runner runner(scene.setup, {}, nobody);
  while (runner.stage() < 1) runner.advance();
  const dynamics::State before = runner.state();
  dynamics::State after = before;
  install(scene.setup, scene.setup.stages[1], runner.model(), after);
  EXPECT_EQ(before.installed, std::vector<std::uint8_t>{0});
  EXPECT_EQ(after.installed, std::vector<std::uint8_t>{1});
  EXPECT_EQ(stored_energy(runner.model(), after), stored_energy(runner.model(), before));
  const dynamics::EnergyLedger &was = before.ledger, &is = after.ledger;
  EXPECT_EQ(is.input, was.input);
  EXPECT_EQ(is.numerical, was.numerical);
  while (!runner.done()) runner.advance();
  EXPECT_LT(runner.finish().energy.residual_ratio, 1e-8);
}

TEST(Install, ASpringThatAStageWouldInstallLaterIsNotThere) {
  Scene scene = hung_block();
  scene.setup.stages.resize(1);
  const std::vector<double> never = heights(scene.setup);
  scene.setup.springs.pop_back();
  scene.setup.staged_supports.clear();
  EXPECT_NEAR(heights(scene.setup)[0], never[0], 1e-12);
}

// Checkpoints are at the ends of stages, and every 2000 steps within them.
TEST(Install, HasTheSameBitsForAnyThreadsAndAfterAnInterruption) {
  Scene scene = hung_block();
  scene.setup.stages.back().duration = 4.3;
  record::RunObserver nobody;
  const record::RunRecord whole = run(scene.setup, {}, nobody);
  RunOptions two;
  two.threads = 2;
  EXPECT_EQ(run(scene.setup, two, nobody).state_hash, whole.state_hash);
  long steps = 0;
  for (std::size_t k = 0; k + 1 < whole.stages.size(); ++k) {
    steps += whole.stages[k].steps;
    Stopper stopper(steps + 1);
    EXPECT_EQ(resumed_run(scene.setup, stopper).state_hash, whole.state_hash) << k;
  }
  Stopper stopper(steps + 2100);
  EXPECT_EQ(resumed_run(scene.setup, stopper).state_hash, whole.state_hash);
}

}  // namespace
}  // namespace keyblock::simulation
