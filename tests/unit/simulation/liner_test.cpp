#include "loading/liner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../hung_block.h"
#include "../resumed_run.h"
#include "simulation/elements.h"
#include "simulation/runner.h"

namespace keyblock::simulation {
namespace {

/// 10 cm of shotcrete on one side of blocks between two heights.
loading::Liner liner_beside(const char* name, std::vector<Vec2> wall) {
  loading::Liner liner;
  liner.name = name;
  liner.wall = std::move(wall);
  liner.thickness = 0.1;
  liner.young = 15e9;
  liner.normal_stiffness = 1e9;
  liner.shear_stiffness = 4e8;
  liner.adhesion = liner.cohesion = 1e9;
  liner.friction = 0.5;
  return liner;
}

/// On both sides, so that nothing bends.
std::vector<loading::Liner> liners_beside(double top, double bottom) {
  return {liner_beside("right", {{1.0, top}, {1.0, bottom}}),
          liner_beside("left", {{0.0, bottom}, {0.0, top}})};
}

// Put on where rock has moved, a liner moves nothing, and carries what comes after. A block that is relieved goes up against two springs and two liners:
// each is a bar with a free length of 2 m between 1 m of bond at both ends, of which the stiffness is EA β tanh(β l), β = √(ks/EA).
TEST(Liner, IsInstalledWithoutForce) {
  Scene scene = hung_block();
  scene.setup.liners = liners_beside(4.0, 0.0);
  for (loading::Liner& liner : scene.setup.liners) {
    liner.density = 1e-3;
    liner.staged = 0;
  }
  const double bar = scene.setup.liners[0].axial_stiffness(), beta = std::sqrt(4e8 / bar),
               bond = bar * beta * std::tanh(beta),
               held = 2.0 * hanger_stiffness + 2.0 / (2.0 / bar + 2.0 / bond);
  record::RunObserver nobody;
  Runner runner(scene.setup, {}, nobody);
  std::vector<double> height;
  std::vector<record::ElementState> installed;
  while (!runner.done()) {
    if (!runner.advance().ended_stage) continue;
    height.push_back(runner.state().position[runner.model().blocks[1].first + 1]);
    if (height.size() == 2) installed = element_states(runner.model(), runner.state());
  }
  EXPECT_NEAR(height[1], height[0], 1e-9);
  EXPECT_NEAR(height[2] - height[1], 0.2 * 2600.0 * g / held, 0.03 * 0.2 * 2600.0 * g / held);
  ASSERT_GT(installed.size(), 10u);
  for (std::size_t k = 2; k < installed.size(); ++k) {  // after the springs
    EXPECT_TRUE(installed[k].present);
    EXPECT_NEAR(installed[k].force, 0.0, 1.0);
    EXPECT_NEAR(installed[k].elongation, 0.0, 1e-9);
  }
  EXPECT_LT(runner.finish().energy.residual_ratio, 1e-6);
}

/// A block below a roof, which liners beside both hold, or do not, above a floor.
Scene held_by_liners(double cohesion, int order = 1) {
  Scene scene(1e13, 30.0);
  scene.rectangle({0.0, 3.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 2.0}, 1.0, 1.0, 0.0, false, order);
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.setup.gravity = {0.0, -g};
  scene.setup.time_step = 0.002;
  scene.setup.liners = liners_beside(4.0, 2.0);
  for (loading::Liner& liner : scene.setup.liners) liner.cohesion = cohesion;
  scene.setup.stages = {stage("let go", record::StageKind::rest, 4.3)};
  return scene;
}

TEST(Liner, HasTheSameBitsForAnyThreadsAndAfterAnInterruption) {
  for (const int order : {1, 2}) {
    for (const double cohesion : {1e9, 2e4}) {
      const Scene scene = held_by_liners(cohesion, order);
      record::RunObserver nobody;
      const record::RunRecord whole = run(scene.setup, {}, nobody);
      EXPECT_LT(whole.energy.residual_ratio, 1e-3) << order << ' ' << cohesion;
      RunOptions threads;
      for (threads.threads = 2; threads.threads <= 4; threads.threads += 2)
        EXPECT_EQ(run(scene.setup, threads, nobody).state_hash, whole.state_hash) << order;
      Stopper stopper(2100);
      EXPECT_EQ(resumed_run(scene.setup, stopper).state_hash, whole.state_hash) << order;
    }
  }
}

// It falls where its weight is more than the bonds on both sides of it bear. Let go at once it takes twice its weight.
TEST(Liner, HoldsABlockAsFarAsItsBondsDo) {
  for (const int order : {1, 2}) {
    for (const double share : {0.3, 3.0}) {
      const double weight = 2600.0 * g;
      Scene scene = held_by_liners(share * weight, order);
      for (loading::Liner& liner : scene.setup.liners) liner.friction = 0.0;
      record::RunObserver nobody;
      Runner runner(scene.setup, {}, nobody);
      while (!runner.done()) runner.advance();
      const double fallen = 2.5 - runner.state().position[runner.model().blocks[1].first + 1];
      if (share < 1.0) {
        EXPECT_GT(fallen, 1.5) << order;
      } else {
        EXPECT_LT(fallen, 0.01) << order;
      }
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
