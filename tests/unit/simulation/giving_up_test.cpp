// Runs that end before their time: stopped from outside, or because there is nothing to compute.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "../scene.h"
#include "core/error.h"
#include "simulation/feasibility.h"

namespace keyblock::simulation {
namespace {

using testing::HasSubstr;

/// A block on the ground.
RunSetup block_on_ground(double young = 1e9) {
  Scene scene(young, 30.0);
  scene.rectangle({-2.0, -1.0}, 5.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.stages.push_back(stage("rest", record::StageKind::rest, 0.02));
  return setup;
}

std::string failure_of(const RunSetup& setup) {
  record::RunObserver nobody;
  try {
    run(setup, {}, nobody);
  } catch (const RunError& error) {
    return error.what();
  }
  return {};
}

// No part of the step converges, and it is cut into more parts than there is time for.
TEST(GivingUp, AStepThatIsStoppedWithinIsNoStep) {
  struct Records final : record::RunObserver {
    int frames = 0, contacts_seen = 0;
    void frame(const record::Frame&) override { ++frames; }
    void contacts(const record::ContactFrame&) override { ++contacts_seen; }
  };
  RunSetup setup = block_on_ground();
  setup.solver.max_iterations = 0;
  setup.solver.max_halvings = 40;
  std::atomic<bool> stop = false;
  RunOptions options;
  options.stop = &stop;
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop = true;
  });
  Records records;
  const record::RunRecord record = run(setup, options, records);
  other.join();
  EXPECT_TRUE(record.interrupted);
  EXPECT_EQ(record.steps, 0);
  ASSERT_EQ(record.stages.size(), 1U);
  EXPECT_TRUE(record.stages[0].interrupted);
  EXPECT_EQ(records.frames, 2);
  EXPECT_EQ(records.contacts_seen, 0);  // those at hand are of the step that was given up
}

TEST(GivingUp, AStopThatWasAskedForBeforeEndsTheStep) {
  const RunSetup setup = block_on_ground();
  dynamics::Model model = build_model(setup);
  dynamics::State state = initial_state(setup, model);
  ThreadTeam team(1);
  Profile profile;
  std::atomic<bool> stop = true;
  dynamics::Stepper stepper(model, team, profile, &stop);
  stepper.start(state);
  EXPECT_THROW(stepper.advance(state, 0.002, nullptr), dynamics::Interrupted);
  const std::vector<double> scale(2, 1.0);
  EXPECT_THROW(stepper.relax(state, {.step = 0.002, .inertia_scale = scale}), dynamics::Interrupted);
  EXPECT_EQ(state.step, 0);
  stop = false;
  EXPECT_NO_THROW(stepper.advance(state, 0.002, nullptr));
  EXPECT_EQ(state.step, 1);
}

TEST(GivingUp, TheFirstOfTwoFailuresIsTold) {
  struct FullDisk final : record::RunObserver {
    void frame(const record::Frame&) override { throw RunError("no space left"); }
    void end(const record::RunRecord&) override { throw RunError("the file is half written"); }
  };
  FullDisk disk;
  const auto fails = [&] { run(block_on_ground(), {}, disk); };
  EXPECT_THAT(fails,
              testing::Throws<RunError>(testing::Property(&RunError::what, HasSubstr("no space left"))));
}

TEST(GivingUp, NoMoreMemoryKeepsTheResults) {
  struct Greedy final : record::RunObserver {
    bool ended = false;
    void frame(const record::Frame&) override { throw std::bad_alloc(); }
    void end(const record::RunRecord& record) override { ended = record.interrupted; }
  };
  Greedy greedy;
  const auto fails = [&] { run(block_on_ground(), {}, greedy); };
  EXPECT_THAT(fails, testing::Throws<RunError>(testing::Property(
                         &RunError::what, HasSubstr("out of memory for a model of 2 blocks"))));
  EXPECT_TRUE(greedy.ended);
}

TEST(GivingUp, RockThatIsTooSoft) {
  EXPECT_THAT(
      failure_of(block_on_ground(8.0)),
      HasSubstr("the rock is too soft to be computed: young = 8 Pa of block 'b1', and weight or stress of "
                "1.28e+04 Pa deform it by 1.6e+03 times its size (density 2600 kg/m3, height 0.5 m)"));
  EXPECT_EQ(failure_of(block_on_ground(1e9)), "");
  RunSetup weightless = block_on_ground(8.0);
  weightless.gravity = {};
  EXPECT_FALSE(yields_without_limit(weightless));
  weightless.in_situ.emplace();
  weightless.in_situ->sxy = -10.0;
  EXPECT_FALSE(yields_without_limit(weightless));  // nothing releases the stress
  weightless.stages[0].excavate = {0};
  EXPECT_TRUE(yields_without_limit(weightless));
  weightless.properties[1].material.young = 11.0;
  EXPECT_FALSE(yields_without_limit(weightless));
  weightless.properties[0].material.young = 1.0;  // fixed
  EXPECT_FALSE(yields_without_limit(weightless));
}

TEST(GivingUp, JointsThatAreTooSoft) {
  RunSetup setup = block_on_ground();
  const double stress = 2600.0 * g * 0.5, size = std::sqrt(0.5);
  const auto with_closure = [&](double share) {
    setup.joints.standard.normal_stiffness = stress / (share * size);
    return failure_of(setup);
  };
  EXPECT_EQ(with_closure(0.08), "");
  EXPECT_NEAR(largest_closure(setup).share(), 0.08, 1e-12);
  EXPECT_THAT(with_closure(0.5),
              HasSubstr("the joints are too soft to be computed: normal_stiffness = 3.607e+04 "
                        "Pa/m, and weight or stress of 1.28e+04 Pa closes them by 0.35 m, "
                        "where blocks are 0.71 m large"));
  setup.joints.standard.normal_stiffness.reset();
  setup.joints.trace_maps.resize(1);
  setup.joints.trace_maps[0].normal_stiffness = 1.0;
  EXPECT_THAT(failure_of(setup), HasSubstr("too soft"));
}

// No step converges: the run does not go on to the end of its stage, and says what is odd in the input.
TEST(GivingUp, ARunOfWhichNoStepConverges) {
  RunSetup setup = block_on_ground();
  setup.properties[1].spin = 1e4;
  setup.solver.max_halvings = 0;
  setup.solver.max_iterations = 0;
  setup.stages[0].duration = 2.0;
  setup.warnings = {"rock.density = 2.6 kg/m3"};
  EXPECT_EQ(failure_of(setup),
            "100 steps in a row did not converge, the last of them step 100 of stage 'rest'; the results up "
            "to there "
            "are kept; odd input: rock.density = 2.6 kg/m3");
}

}  // namespace
}  // namespace keyblock::simulation
