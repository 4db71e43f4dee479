#include "simulation/elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../hung_block.h"
#include "../resumed_run.h"
#include "core/error.h"

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
  record::RunObserver nobody;
  const record::RunRecord record = run(hung_by_two(), {}, nobody);
  ASSERT_EQ(record.elements.size(), 2u);
  const record::ElementRecord &first = record.elements[0], &second = record.elements[1];
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
  setup.stages = {stage("fall", record::StageKind::rest, 0.2)};
  record::RunObserver nobody;
  const record::RunRecord record = run(setup, {}, nobody);
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
    setup.stages = {stage("settle", record::StageKind::settle)};
    setup.stages[0].tolerance = 1e-9;
    record::RunObserver nobody;
    const record::RunRecord record = run(setup, {}, nobody);
    ASSERT_EQ(record.elements.size(), 1u);
    EXPECT_EQ(record.elements[0].name, "support[0]");
    EXPECT_EQ(record.elements[0].kind, "support");
    EXPECT_NEAR(record.elements[0].force, hung_weight, 1e-4 * hung_weight) << is_edge;
    EXPECT_NEAR(record.elements[0].elongation, hung_weight / 2e7, 1e-4 * hung_weight / 2e7) << is_edge;
    EXPECT_TRUE(std::isinf(record.elements[0].limit));
  }
}

/// Stops after the first step of the last stage.
struct StopsAtTheLastStage : record::RunObserver {
  std::atomic<bool> stop = false;
  void stage_begin(int stage, const record::StageRecord& /*record*/) override { stop = stage == 2; }
};

TEST(Elements, LargestForcesAreKeptWhenARunGoesOn) {
  const RunSetup setup = hung_by_two();
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  StopsAtTheLastStage stopper;
  const record::RunRecord resumed = resumed_run(setup, stopper);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(resumed.elements[k].peak_force, whole.elements[k].peak_force) << k;
    EXPECT_EQ(resumed.elements[k].peak_stage, whole.elements[k].peak_stage) << k;
    EXPECT_EQ(resumed.elements[k].force, whole.elements[k].force) << k;
  }
}

const record::ElementRecord* named(const record::RunRecord& record, const std::string& name) {
  const auto found = std::ranges::find(record.elements, name, &record::ElementRecord::name);
  return found == record.elements.end() ? nullptr : &*found;
}

/// One block of rock between rollers, on a half-space.
RunSetup rock_on_a_base() {
  Scene scene(2e8, 40.0, 2600.0);
  scene.rectangle({0.0, 0.0}, 10.0, 4.0);
  RunSetup setup = std::move(scene.setup);
  setup.gravity = {0.0, -g};
  setup.time_step = 0.0025;
  Boundary boundary;
  boundary.sides = record::Sides::roller;
  dynamics::RockLayer rock{.density = 2600.0};
  rock.shear = 2e8 / 2.4;
  rock.upright = 2e8 / (1.0 - 0.04);
  rock.sideways = 0.2 * rock.upright;
  boundary.layers = {rock};
  boundary.dashpots = rock.impedance();
  setup.boundary = boundary;
  setup.stages = {stage("settle", record::StageKind::settle)};
  setup.stages[0].tolerance = 1e-9;
  return setup;
}

// The base carries the weight; the sides what the rock would be wide without them, which is the same on either side.
TEST(Elements, TheBoundaryCarriesTheRock) {
  record::RunObserver nobody;
  const record::RunRecord record = run(rock_on_a_base(), {}, nobody);
  ASSERT_EQ(record.elements.size(), 3u);
  const record::ElementRecord *left = named(record, "boundary.left"),
                              *right = named(record, "boundary.right"),
                              *base = named(record, "boundary.base");
  ASSERT_TRUE(left != nullptr && right != nullptr && base != nullptr);
  const double weight = 40.0 * 2600.0 * g;
  EXPECT_EQ(base->kind, "boundary");
  EXPECT_NEAR(base->force, weight, 1e-4 * weight);
  EXPECT_GT(left->force, 0.01 * weight);
  EXPECT_NEAR(left->force, right->force, 1e-4 * weight);
  EXPECT_GT(base->elongation, 0.0);
  EXPECT_TRUE(base->present && std::isinf(base->limit));
  // Ends are Gauss points: within the side, near its ends.
  EXPECT_LT(base->from.x, 3.0);
  EXPECT_GT(base->to.x, 7.0);
}

// A pressure on the four walls of a square opening of 1 m: as much on each.
TEST(Elements, PressureOnWallsIsTheirForce) {
  Scene scene(1e9, 60.0);
  scene.rectangle({-1.0, -1.0}, 1.0, 5.0, 0.0, true);
  scene.rectangle({3.0, -1.0}, 1.0, 5.0, 0.0, true);
  scene.rectangle({0.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 3.0}, 3.0, 1.0, 0.0, true);
  for (const double y : {0.0, 1.0, 2.0}) {
    for (const double x : {0.0, 1.0, 2.0}) scene.rectangle({x, y}, 1.0, 1.0);
  }
  RunSetup& setup = scene.setup;
  setup.system.blocks[8].excavations = {0};
  setup.excavations.push_back({"middle", {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}}});
  setup.excavations[0].pressure.constant = 1e5;
  setup.gravity = {};
  setup.in_situ = block::InSituStress{.sxx = -1e5, .syy = -1e5};
  setup.time_step = 0.002;
  setup.stages = {stage("in place", record::StageKind::settle), stage("open", record::StageKind::settle)};
  setup.stages[0].tolerance = setup.stages[1].tolerance = 1e-7;
  setup.stages[1].excavate = {0};
  record::RunObserver nobody;
  const record::RunRecord record = run(setup, {}, nobody);
  ASSERT_EQ(record.elements.size(), 4u);
  const std::pair<const char*, Vec2> walls[] = {{"middle.crown", {1.0, 2.0}},
                                                {"middle.left", {1.0, 1.0}},
                                                {"middle.right", {2.0, 1.0}},
                                                {"middle.invert", {1.0, 1.0}}};
  for (const auto& [name, from] : walls) {
    const record::ElementRecord* wall = named(record, name);
    ASSERT_NE(wall, nullptr) << name;
    EXPECT_EQ(wall->kind, "pressure");
    EXPECT_NEAR(wall->force, 1e5, 100.0) << name;
    EXPECT_NEAR(norm(wall->from - from), 0.0, 1e-2) << name;
    EXPECT_EQ(wall->peak_stage, "open");
  }
}

/// Keeps frames and rows of histories.
struct Watcher : record::RunObserver {
  record::ModelRecord model;
  std::vector<record::Frame> frames;
  std::vector<record::HistoryRow> rows;
  void begin(const record::ModelRecord& record) override { model = record; }
  void frame(const record::Frame& frame) override { frames.push_back(frame); }
  void history(const record::HistoryRow& row) override { rows.push_back(row); }
};

History follows(const char* name, const char* element) {
  History history;
  history.name = name;
  history.element = element;
  return history;
}

TEST(Elements, FramesAndHistoriesSayWhatTheyCarry) {
  RunSetup setup = hung_by_two();
  setup.histories = {follows("cell", "spring[1]"), {"corner", "b1", {0.5, 0.5}}};
  Watcher watcher;
  const record::RunRecord record = run(setup, {}, watcher);
  ASSERT_EQ(watcher.model.elements.size(), 2u);
  EXPECT_EQ(watcher.model.elements[0].name, "first");
  EXPECT_EQ(watcher.model.elements[0].from.y, 3.0);
  EXPECT_EQ(watcher.model.elements[0].from_block, 0);
  EXPECT_EQ(watcher.model.elements[0].to_block, 1);
  EXPECT_EQ(watcher.model.history_names, std::vector<std::string>{"corner"});
  ASSERT_EQ(watcher.model.element_histories.size(), 1u);
  EXPECT_EQ(watcher.model.element_histories[0].element, 1);
  const record::Frame& last = watcher.frames.back();
  ASSERT_EQ(last.elements.size(), 2u);
  EXPECT_EQ(last.elements[1].force, record.elements[1].force);
  EXPECT_EQ(last.elements[0].from.y, record.elements[0].from.y);
  EXPECT_FALSE(watcher.frames.front().elements[1].present);
  // Before it was installed it has no force.
  EXPECT_TRUE(std::isnan(watcher.rows.front().elements[0].force));
  EXPECT_EQ(watcher.rows.back().elements[0].force, record.elements[1].force);
  EXPECT_EQ(watcher.rows.back().elements[0].elongation, record.elements[1].elongation);
  EXPECT_EQ(watcher.rows.back().points.size(), 1u);
}

TEST(Elements, AHistoryNeedsTheNameOfOne) {
  RunSetup setup = hung_by_two();
  setup.histories = {follows("cell", "frist")};
  record::RunObserver nobody;
  try {
    run(setup, {}, nobody);
    FAIL();
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().front();
    EXPECT_EQ(d.key, "history.cell.element");
    EXPECT_EQ(d.found, "\"frist\"");
    EXPECT_EQ(d.expected, "the name of an element: first, spring[1]");
  }
}

TEST(Elements, DamageHasTheirUtilization) {
  RunSetup setup = hung_by_two();
  record::RunObserver nobody;
  for (const record::Damage& damage : {run(setup, {}, nobody).stages.back().damage}) {
    EXPECT_TRUE(std::isnan(damage.largest_utilization));  // no spring has a limit
    EXPECT_EQ(damage.yielded_elements, 0);
  }
  setup.springs[0].yield = 2.0 * hung_weight;
  const record::RunRecord holds = run(setup, {}, nobody);
  EXPECT_NEAR(holds.stages.front().damage.largest_utilization, 0.6, 1e-3);
  EXPECT_EQ(holds.stages.back().damage.yielded_elements, 0);
  setup.springs.pop_back();
  setup.staged_supports.clear();
  setup.springs[0].yield = 0.5 * hung_weight;
  setup.stages = {stage("fall", record::StageKind::rest, 0.2)};
  const record::Damage fallen = run(setup, {}, nobody).stages.back().damage;
  EXPECT_NEAR(fallen.largest_utilization, 1.0, 1e-9);
  EXPECT_EQ(fallen.yielded_elements, 1);
}

}  // namespace
}  // namespace keyblock::simulation
