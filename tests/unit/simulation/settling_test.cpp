#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../scene.h"
#include "record/standing.h"
#include "record/verdict.h"
#include "simulation/run.h"

namespace keyblock::simulation {
namespace {

// A loose block in the roof of an opening: it keeps moving while the rest comes to equilibrium, is named, and falls
// when time runs.
TEST(Settling, NamesTheBlockThatMovesAndLetsItFall) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 3.0, 0.5, 0.0, true);
  scene.rectangle({0.0, 0.5}, 1.0, 1.0);
  scene.rectangle({2.0, 0.5}, 1.0, 1.0);
  scene.rectangle({1.2, 1.0}, 0.6, 0.4);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.stages = {stage("settle", record::StageKind::settle), stage("fall", record::StageKind::rest, 1.0)};
  record::RunObserver nobody;
  const record::RunRecord record = run(setup, {}, nobody);
  ASSERT_EQ(record.stages[0].moving.size(), 1u);
  EXPECT_EQ(record.stages[0].moving[0].block, 3);
  EXPECT_NEAR(record.stages[0].moving[0].carried, 0.0, 0.01);
  EXPECT_TRUE(record.stages[0].equilibrium_reached);
  EXPECT_LE(record.stages[0].worst_residual_ratio, 1e-4);
  EXPECT_EQ(record::verdict_text(record.stages[0]), "1 block falling");
  EXPECT_LT(record.max_overlap.depth, 1e-3);
}

// Ten blocks on soft joints close them by more than the way after which a loose block is called moving.
TEST(Settling, WhatClosesUnderItsLoadIsNotMoving) {
  constexpr double stiffness = 3e7, weight = 2600.0 * g;
  Scene scene(1e13, 30.0);
  scene.setup.joints.standard.normal_stiffness = stiffness;
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  for (int k = 0; k < 10; ++k) scene.rectangle({0.0, 1.0 * k}, 1.0, 1.0);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.stages = {stage("settle", record::StageKind::settle)};
  setup.stages[0].tolerance = 1e-3;
  setup.histories.push_back({"top", "b10", {0.5, 9.5}});
  LastHistory observer;
  const record::RunRecord record = run(setup, {}, observer);
  EXPECT_TRUE(record.stages[0].equilibrium_reached);
  EXPECT_TRUE(record.stages[0].moving.empty());
  EXPECT_NEAR(observer.last.points[0].uy, -55.0 * weight / stiffness, 2e-3 * 55.0 * weight / stiffness);
}

// A slender cantilever bends by a tenth of its length: it is not in equilibrium until it has.
TEST(Settling, ABlockOnSupportsIsNeverCalledMoving) {
  Scene scene(1e5, 0.0, 1.0);
  scene.rectangle({0.0, -0.1}, 8.0, 0.2, 0.0, false, 4);
  RunSetup setup = scene.setup;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 1.0;
  loading::Support support;
  support.block = "b0";
  support.is_edge = true;
  support.points = {{0.0, -0.1}, {0.0, 0.1}};
  support.stiffness = 1e6;
  setup.supports.push_back(support);
  loading::Load load;
  load.block = "b0";
  load.from = {8.0, 0.0};
  load.value = {0.0, -0.3};
  setup.loads.push_back(load);
  setup.stages.push_back(stage("settle", record::StageKind::settle));
  setup.stages.back().tolerance = 1e-8;
  setup.histories.push_back({"tip", "b0", {8.0, 0.0}});
  LastHistory observer;
  const record::RunRecord record = run(setup, {}, observer);
  EXPECT_TRUE(record.stages[0].equilibrium_reached);
  EXPECT_TRUE(record.stages[0].moving.empty());
  EXPECT_LT(record.stages[0].worst_residual_ratio, 1e-8);
  EXPECT_NEAR(observer.last.points[0].uy, -0.3 * 512.0 / (3.0 * 1e5 * 0.2 * 0.2 * 0.2 / 12.0), 0.02);
}

/// How a stage of settling ends.
record::StageRecord settle(RunSetup setup) {
  setup.stages = {stage("settle", record::StageKind::settle)};
  record::RunObserver nobody;
  return run(setup, {}, nobody).stages[0];
}

/// How a straight column of 20 m × 1 m stands under a share of its buckling load, Euler: π² E h³ / (48 L²).
record::Standing column_under(double share, int order, bool automatic = false) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 20.0, 0.0, false, order);
  RunSetup setup = scene.setup;
  setup.properties[0].material.poisson = 0.0;
  setup.properties[0].automatic_order = automatic;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 1.0;
  loading::Support support;
  support.block = "b0";
  support.is_edge = true;
  support.points = {{0.0, 0.0}, {1.0, 0.0}};
  support.stiffness = 1e13;
  setup.supports.push_back(support);
  loading::Load load;
  load.block = "b0";
  load.is_line = true;
  load.from = {1.0, 20.0};
  load.to = {0.0, 20.0};
  load.value = load.value_end = {0.0, -share * std::numbers::pi * std::numbers::pi * 1e9 / (48.0 * 400.0)};
  setup.loads.push_back(load);
  return record::standing_of(settle(setup), {}, false);
}

// Blocks of low orders, which the program may have chosen, bend too little or not at all, and balance under any load.
TEST(Settling, AColumnBeyondItsBucklingLoadDoesNotStandAtAnyOrder) {
  for (const int order : {1, 2, 3}) {
    EXPECT_EQ(column_under(0.95, order), record::Standing::stands) << order;
    EXPECT_EQ(column_under(1.05, order), record::Standing::unstable) << order;
  }
  EXPECT_EQ(column_under(0.95, 1, true), record::Standing::stands);
  EXPECT_EQ(column_under(1.05, 1, true), record::Standing::unstable);
}

// Rock beside it holds a slender block, whose contacts the test has to know.
TEST(Settling, ASlenderBlockBetweenOthersIsStable) {
  const double pressed = 2.0 * std::numbers::pi * std::numbers::pi * 1e9 / (48.0 * 400.0);
  Scene scene(1e9, 30.0);
  scene.setup.joints.standard.normal_stiffness = 1e9;
  scene.rectangle({0.0, 0.0}, 1.0, 20.0);
  scene.rectangle({-2.0, 0.0}, 2.0, 20.0, 0.0, true);
  scene.rectangle({1.0, 0.0}, 2.0, 20.0, 0.0, true);
  scene.rectangle({-2.0, -1.0}, 5.0, 1.0, 0.0, true);
  scene.rectangle({-2.0, 20.0}, 5.0, 1.0, 0.0, true);
  RunSetup setup = scene.setup;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 1.0;
  setup.in_situ = block::InSituStress{.sxx = -pressed, .syy = -pressed};
  EXPECT_EQ(record::standing_of(settle(setup), {}, false), record::Standing::stands);
}

// Without gravity, a block that only its neighbour loads is in balance when the neighbour is.
TEST(Settling, EndsWithoutGravity) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 1.0}, 1.0, 1.0);
  scene.rectangle({0.0, 2.0}, 1.0, 1.0);
  RunSetup setup = scene.setup;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 0.01;
  loading::Load load;
  load.block = "b2";
  load.is_line = true;
  load.from = {1.0, 3.0};
  load.to = {0.0, 3.0};
  load.value = load.value_end = {0.0, -1e4};
  setup.loads.push_back(load);
  const record::StageRecord settled = settle(setup);
  EXPECT_TRUE(settled.equilibrium_reached);
  EXPECT_LT(settled.steps, 200);
}

// Pressed between two plates by the stress that it was cut in.
TEST(Settling, IsMeasuredByInSituStressWithoutGravity) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 1.0}, 1.0, 1.0);
  scene.rectangle({0.0, 2.0}, 1.0, 1.0, 0.0, true);
  RunSetup setup = scene.setup;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 0.002;
  setup.in_situ = block::InSituStress{.sxx = -1e6, .syy = -2e6};
  const record::StageRecord settled = settle(setup);
  EXPECT_TRUE(settled.equilibrium_reached);
  EXPECT_LT(settled.worst_residual_ratio, 1e-4);
}

// The outline of an opening that is not there yet, in rock that is pulled along it: what is fused does not slide.
TEST(Settling, FusedRockMayBePulled) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 1.0}, 1.0, 1.0);
  RunSetup setup = scene.setup;
  for (cutting::CutBlock& block : setup.system.blocks) {
    for (cutting::EdgeLabel& label : block.labels[0]) label.kind = cutting::EdgeKind::excavation;
  }
  setup.time_step = 0.002;
  setup.in_situ = block::InSituStress{.syy = 1e4, .sxy = 1e3};
  EXPECT_TRUE(settle(setup).equilibrium_reached);
}

/// A block on an incline of 30°.
RunSetup on_incline(double friction) {
  Scene scene(20e9, friction);
  scene.rectangle({-5.0, -1.0}, 10.0, 1.0, 0.0, true);
  scene.rectangle({-0.5, 0.0}, 1.0, 1.0);
  scene.setup.gravity = {-0.5 * g, -std::sqrt(0.75) * g};
  scene.setup.time_step = 0.005;
  return scene.setup;
}

// Within 0.04 % of the limit, on both sides of it.
TEST(Settling, TellsABlockThatSlidesFromOneThatHolds) {
  const record::StageRecord slides = settle(on_incline(29.99)), holds = settle(on_incline(30.01));
  EXPECT_EQ(record::verdict_text(slides), "mechanism of 1 block");
  EXPECT_LT(slides.steps, 30);
  ASSERT_EQ(slides.moving.size(), 1u);
  EXPECT_GT(slides.moving[0].carried, 0.99);
  EXPECT_EQ(record::verdict_text(holds), "in equilibrium");
  EXPECT_LT(holds.steps, 15);
}

// Two drums that tip over together, about the toe of the lower one: they press on each other, and are one mechanism.
TEST(Settling, BlocksThatMoveTogetherAreOneMechanism) {
  Scene scene(20e9, 60.0);
  scene.rectangle({-5.0, -1.0}, 10.0, 1.0, 0.0, true);
  scene.rectangle({-0.5, 0.0}, 1.0, 2.0);
  scene.rectangle({-0.5, 2.0}, 1.0, 2.0);
  scene.setup.time_step = 0.005;
  const auto leaning = [&](double slope) {
    scene.setup.gravity = {-slope * g, -g};
    return settle(scene.setup);
  };
  EXPECT_EQ(record::verdict_text(leaning(0.249)), "in equilibrium");
  const record::StageRecord tips = leaning(0.251);
  EXPECT_EQ(record::verdict_text(tips), "mechanism of 2 blocks");
}

// Weightless, pushed over its edge by a load on its side: nothing but contacts measures the blocks beside it.
TEST(Settling, FindsWhatMovesWithoutGravity) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({1.0, 1.0}, 1.0, 1.0);
  scene.rectangle({1.0, 2.0}, 1.0, 1.0);
  RunSetup setup = scene.setup;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 0.01;
  loading::Load load;
  load.block = "b2";
  load.is_line = true;
  load.from = {2.0, 3.0};
  load.to = {1.0, 3.0};
  const auto pushed = [&](double share) {
    load.value = load.value_end = {share * 1e4, -1e4};
    setup.loads = {load};
    return settle(setup);
  };
  EXPECT_EQ(record::verdict_of(pushed(0.24)),
            record::Verdict::equilibrium);  // tips at 1/4: 2 m high, 1 m wide
  EXPECT_EQ(pushed(0.26).moving.size(), 2u);
}

// The forces at the position that was reached are what is reported: at 0.85 of the load that makes it buckle, a column bends in proportion to
// 1/(1 − 0.85), which the linearized step knows nothing of.
TEST(Settling, ASlenderColumnBendsAsFarAsItsThrustDemands) {
  constexpr double length = 60.0, young = 2e9, share = 0.85, lateral = 10.0;
  const double stiffness = young / 12.0;
  const double thrust = share * std::numbers::pi * std::numbers::pi * stiffness / (4.0 * length * length);
  Scene scene(young, 0.0, 1.0);
  scene.rectangle({0.0, -0.5}, length, 1.0, 0.0, false, 6);
  scene.setup.properties[0].material.poisson = 0.0;
  RunSetup setup = scene.setup;
  setup.gravity = {0.0, 0.0};
  setup.time_step = 1.0;
  loading::Support support;
  support.block = "b0";
  support.is_edge = true;
  support.points = {{0.0, -0.5}, {0.0, 0.5}};
  support.stiffness = 2e13;
  setup.supports.push_back(support);
  loading::Load load;
  load.block = "b0";
  load.is_line = true;
  load.from = {length, -0.5};
  load.to = {length, 0.5};
  load.value = load.value_end = {-thrust, lateral};
  setup.loads.push_back(load);
  setup.histories.push_back({"tip", "b0", {length, 0.0}});
  setup.stages = {stage("settle", record::StageKind::settle)};
  LastHistory observer;
  const record::StageRecord settled = run(setup, {}, observer).stages[0];
  const double k = std::sqrt(thrust / stiffness);
  EXPECT_TRUE(settled.equilibrium_reached);
  EXPECT_LE(settled.steps, 12);
  const double expected = lateral / (thrust * k) * (std::tan(k * length) - k * length);
  EXPECT_NEAR(observer.last.points[0].uy, expected, 5e-3 * expected);
}

// A block that falls when the stage begins: what it has gained by then is taken out, and accounted for.
TEST(Settling, TakesOutTheEnergyOfMotion) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 1.5}, 1.0, 1.0);
  scene.setup.properties[1].velocity = {0.1, 0.0};
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.stages = {stage("fall", record::StageKind::rest, 0.2), stage("settle", record::StageKind::settle)};
  setup.stages.back().max_steps = 5;
  record::RunObserver nobody;
  const record::RunRecord record = run(setup, {}, nobody);
  EXPECT_LT(record.energy.residual_ratio, 1e-9);
  EXPECT_LT(record.energy.kinetic, 1e-9);
}

}  // namespace
}  // namespace keyblock::simulation
