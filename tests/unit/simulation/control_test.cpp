#include "simulation/control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "../fresh_folder.h"
#include "../scene.h"
#include "core/error.h"
#include "simulation/run.h"
#include "simulation/runner.h"

namespace keyblock::simulation {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A block on the ground that is pulled to the right by half of its weight, and held by friction of 30°.
RunSetup pulled() {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 9.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  scene.setup.properties[1].name = "stone";
  scene.setup.joint_set_names = {"J1"};
  scene.setup.joints.joint_sets.resize(1);
  const double weight = scene.setup.properties[1].material.density * 0.5 * g;
  loading::Load load;
  load.block = "stone";
  load.from = {0.5, 0.05};
  load.value = {0.5 * weight, 0.0};
  scene.setup.loads = {load};
  scene.setup.time_step = 0.002;
  scene.setup.stages = {stage("settle", record::StageKind::settle),
                        stage("one", record::StageKind::rest, 0.2),
                        stage("two", record::StageKind::rest, 0.2)};
  return scene.setup;
}

double speed_of_stone(const Runner& runner) {
  const dynamics::Block& block = runner.model().blocks[1];
  return runner.state().velocity[block.first] / std::sqrt(block.area);
}

void run_to_the_end(Runner& runner) {
  while (!runner.done()) runner.advance();
}

TEST(Control, FrictionThatIsTakenAwayLetsABlockSlide) {
  const RunSetup setup = pulled();
  record::RunObserver nobody;
  Runner held(setup, {}, nobody), freed(setup, {}, nobody);
  run_to_the_end(held);
  EXPECT_NEAR(speed_of_stone(held), 0.0, 1e-3);
  while (freed.stage() == 0) freed.advance();
  freed.control().set_strength("joints", {0.2, 0.0, 0.0});
  run_to_the_end(freed);
  EXPECT_NEAR(speed_of_stone(freed), (0.5 - 0.2) * g * 0.4, 0.01);
  EXPECT_LT(freed.energy().residual_ratio, 1e-3);
}

TEST(Control, LoadsAreScaled) {
  const RunSetup setup = pulled();
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  while (runner.stage() == 0) runner.advance();
  runner.control().set_load_scale(0, 2.0);
  run_to_the_end(runner);
  EXPECT_NEAR(speed_of_stone(runner), (1.0 - std::numbers::inv_sqrt3) * g * 0.4, 0.02);
  EXPECT_LT(runner.energy().residual_ratio, 1e-3);
}

TEST(Control, WhatVelocitiesAreSetToIsWorkFromOutside) {
  const RunSetup setup = pulled();
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  while (runner.stage() == 0) runner.advance();
  const record::Energy before = runner.energy();
  std::vector<double> velocity = runner.state().velocity;
  for (double& v : velocity) v = 1.0;
  runner.control().set_velocity(velocity);
  const record::Energy after = runner.energy();
  EXPECT_GT(after.kinetic, before.kinetic);
  EXPECT_NEAR(after.input - before.input, after.kinetic - before.kinetic, 1e-9 * after.kinetic);
  const dynamics::Block& bed = runner.model().blocks[0];
  EXPECT_EQ(runner.state().velocity[bed.first], 0.0);  // it is fixed
}

TEST(Control, OfNothingChangesNoBit) {
  const RunSetup setup = pulled();
  record::RunObserver nobody;
  const std::string whole = run(setup, {}, nobody).state_hash;
  RunOptions options;
  options.after_step = [](Runner& runner, const dynamics::StepReport&) {
    Control control = runner.control();
    control.set_load_scale(0, 1.0);
    control.set_motion_scale(1.0);
    const contact::JointLaw law = *control.law("joints");
    control.set_strength("joints", {law.friction_coefficient, law.cohesion, law.tension});
  };
  EXPECT_EQ(run(setup, options, nobody).state_hash, whole);
}

TEST(Control, WhatWasChangedIsInCheckpoints) {
  const FreshFolder folder;
  const RunSetup setup = pulled();
  record::RunObserver nobody;
  const auto steered = [&](RunOptions options) {
    options.after_step = [](Runner& runner, const dynamics::StepReport&) {
      if (runner.state().step != 20) return;
      runner.control().set_strength("J1", {0.3, 1e3, 2e3});
      runner.control().set_strength("joints", {0.3, 0.0, 0.0});
      runner.control().set_load_scale(0, 1.5);
      runner.control().set_motion_scale(0.5);
      const int stone = runner.model().surface.block_begin[1];
      const std::vector<contact::ContactStrength> given{
          {stone + 1, 2, 0.1}, {stone, 2, 0.2, 1e3}, {stone, 2, 0.4}};
      runner.control().set_contact_strengths(given);
    };
    return options;
  };
  const std::string whole = run(setup, steered({}), nobody).state_hash;
  RunOptions options;
  options.directory = folder;
  {
    Runner runner(setup, steered(options), nobody);
    while (runner.stage() < 2) runner.advance();
  }
  options.resume = true;
  Runner runner(setup, steered(options), nobody);
  EXPECT_EQ(runner.control().law("J1")->cohesion, 1e3);
  ASSERT_EQ(runner.control().contact_strengths().size(), 2U);
  EXPECT_EQ(runner.control().contact_strengths()[0].friction_coefficient, 0.4);
  EXPECT_EQ(runner.control().contact_strengths()[0].cohesion, 1e3);
  EXPECT_EQ(runner.model().contact_strengths.all().size(), 2U);
  run_to_the_end(runner);
  EXPECT_EQ(runner.finish().state_hash, whole);
}

TEST(Control, RefusesWhatCannotBe) {
  const RunSetup setup = pulled();
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  Control control = runner.control();
  EXPECT_FALSE(control.law("J2"));
  EXPECT_TRUE(control.law("frame"));
  EXPECT_THROW(control.set_strength("J2", {0.5, 0.0, 0.0}), InputError);
  EXPECT_THROW(control.set_strength("J1", {-0.5, 0.0, 0.0}), InputError);
  EXPECT_THROW(control.set_strength("J1", {0.5, nan, 0.0}), InputError);
  EXPECT_THROW(control.set_load_scale(1, 1.0), InputError);
  EXPECT_THROW(control.set_load_scale(0, nan), InputError);
  EXPECT_THROW(control.set_motion_scale(nan), InputError);
  EXPECT_THROW(control.set_velocity(std::vector<double>(3)), InputError);
  EXPECT_THROW(control.set_velocity(std::vector<double>(runner.state().velocity.size(), nan)), InputError);
}

TEST(Control, MotionsThatAbsoluteHistoriesIntegrateStayAsPlanned) {
  RunSetup setup = pulled();
  setup.histories.push_back({.name = "top", .block = "stone", .point = {0.5, 0.25}, .absolute = true});
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  runner.control().set_motion_scale(1.0);
  EXPECT_THROW(runner.control().set_motion_scale(2.0), InputError);
}

}  // namespace
}  // namespace keyblock::simulation
