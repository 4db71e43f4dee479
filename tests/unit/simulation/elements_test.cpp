#include "simulation/elements.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../hung_block.h"
#include "../resumed_run.h"

namespace keyblock::simulation {
namespace {

constexpr double hung_weight = 2600.0 * g, of_hanger = hanger_stiffness;  // N/m; N/m per m

/// Ballast of a fifth of the block's weight is taken away after a second spring was installed.
RunSetup hung_by_two() {
  RunSetup setup = hung_block().setup;
  setup.springs[0].name = "first";
  setup.stages.pop_back();
  return setup;
}

TEST(Elements, SpringsCarryWhatTheyHold) {
  RunObserver nobody;
  const RunRecord record = run(hung_by_two(), {}, nobody);
  ASSERT_EQ(record.elements.size(), 2u);
  const ElementRecord &first = record.elements[0], &second = record.elements[1];
  EXPECT_EQ(first.name, "first");
  EXPECT_EQ(second.name, "spring[1]");
  EXPECT_EQ(first.kind, "spring");
  EXPECT_NEAR(first.force, 1.1 * hung_weight, 1e-4 * hung_weight);
  EXPECT_NEAR(first.elongation, 1.1 * hung_weight / of_hanger, 1e-4 * hung_weight / of_hanger);
  EXPECT_NEAR(first.peak_force, 1.2 * hung_weight, 1e-3 * hung_weight);
  EXPECT_EQ(first.peak_stage, "hang");
  EXPECT_FALSE(first.has_yielded());
  EXPECT_EQ(first.utilization(), 0.0);
  // Put in without force, it is pressed when the block rises.
  EXPECT_NEAR(second.force, -0.1 * hung_weight, 1e-4 * hung_weight);
  EXPECT_NEAR(second.peak_force, 0.1 * hung_weight, 1e-3 * hung_weight);
  EXPECT_EQ(second.peak_stage, "unload");
  EXPECT_NEAR(second.elongation, -0.1 * hung_weight / of_hanger, 1e-4 * hung_weight / of_hanger);
  EXPECT_EQ(second.yielded, 0.0);
}

TEST(Elements, ASpringThatYieldsIsAtItsLimit) {
  RunSetup setup = hung_by_two();
  setup.springs.pop_back();
  setup.staged_supports.clear();
  setup.springs[0].yield = 0.5 * hung_weight;
  setup.stages = {stage("fall", StageKind::rest, 0.2)};
  RunObserver nobody;
  const RunRecord record = run(setup, {}, nobody);
  ASSERT_EQ(record.elements.size(), 1u);
  EXPECT_NEAR(record.elements[0].utilization(), 1.0, 1e-9);
  EXPECT_TRUE(record.elements[0].has_yielded());
  EXPECT_GT(record.elements[0].yielded, 0.01);
  EXPECT_NEAR(record.elements[0].yielded, record.elements[0].elongation - 0.5 * hung_weight / of_hanger,
              1e-9);
}

TEST(Elements, ASupportCarriesItsBlock) {
  for (const bool is_edge : {false, true}) {
    Scene scene(1e11, 30.0);
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    RunSetup setup = scene.setup;
    setup.gravity = {0.0, -g};
    setup.time_step = 0.002;
    loading::Support support;
    support.block = "b0";
    support.is_edge = is_edge;
    support.points = {{0.0, 0.0}, {1.0, 0.0}};
    support.stiffness = is_edge ? 2e7 : 1e7;  // both together 2e7
    setup.supports = {support};
    setup.stages = {stage("settle", StageKind::settle)};
    setup.stages[0].tolerance = 1e-9;
    RunObserver nobody;
    const RunRecord record = run(setup, {}, nobody);
    ASSERT_EQ(record.elements.size(), 1u);
    EXPECT_EQ(record.elements[0].name, "support[0]");
    EXPECT_EQ(record.elements[0].kind, "support");
    EXPECT_NEAR(record.elements[0].force, hung_weight, 1e-4 * hung_weight) << is_edge;
    EXPECT_NEAR(record.elements[0].elongation, hung_weight / 2e7, 1e-4 * hung_weight / 2e7) << is_edge;
    EXPECT_TRUE(std::isinf(record.elements[0].limit));
  }
}

/// Stops after the first step of the last stage.
struct StopsAtTheLastStage : RunObserver {
  std::atomic<bool> stop = false;
  void stage_begin(int stage, const StageRecord& /*record*/) override { stop = stage == 2; }
};

TEST(Elements, LargestForcesAreKeptWhenARunGoesOn) {
  const RunSetup setup = hung_by_two();
  RunObserver nobody;
  const RunRecord whole = run(setup, {}, nobody);
  StopsAtTheLastStage stopper;
  const RunRecord resumed = resumed_run(setup, stopper);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(resumed.elements[k].peak_force, whole.elements[k].peak_force) << k;
    EXPECT_EQ(resumed.elements[k].peak_stage, whole.elements[k].peak_stage) << k;
    EXPECT_EQ(resumed.elements[k].force, whole.elements[k].force) << k;
  }
}

}  // namespace
}  // namespace keyblock::simulation
