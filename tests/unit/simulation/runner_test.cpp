#include "simulation/runner.h"

#include <gtest/gtest.h>

#include "../fresh_folder.h"
#include "../scene.h"
#include "core/error.h"
#include "simulation/checkpoint.h"

namespace keyblock::simulation {
namespace {

/// Two blocks on the ground: settled, one of them excavated, and the other left alone for 50 steps twice.
RunSetup three_stages() {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 5.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, 0.0, false, 2);
  scene.rectangle({1.0, 0.0}, 1.0, 0.5);
  scene.setup.system.blocks[2].excavations = {0};
  scene.setup.excavations.push_back({"beside", {{1.0, 0.0}, {2.0, 0.0}, {2.0, 0.5}, {1.0, 0.5}}});
  scene.setup.time_step = 0.002;
  scene.setup.properties[1].velocity = {0.3, 0.0};
  scene.setup.stages = {stage("settle", record::StageKind::settle),
                        stage("open", record::StageKind::rest, 0.1),
                        stage("rest", record::StageKind::rest, 0.1)};
  scene.setup.stages[1].excavate = {0};
  return scene.setup;
}

/// What an observer was told, in order.
struct Told final : record::RunObserver {
  std::vector<std::string> calls;
  int ends = 0;
  record::RunRecord last;
  void begin(const record::ModelRecord&) override { calls.emplace_back("begin"); }
  void resume(const record::Reported&) override { calls.emplace_back("resume"); }
  void stage_begin(int k, const record::StageRecord&) override {
    calls.push_back("stage " + std::to_string(k));
  }
  void stage_end(int k, const record::StageRecord& record) override {
    calls.push_back((record.interrupted ? "interrupted " : "ended ") + std::to_string(k));
  }
  void end(const record::RunRecord& record) override {
    calls.emplace_back("end");
    ++ends;
    last = record;
  }
};

TEST(Runner, StepByStepEndsInTheSameBits) {
  const RunSetup setup = three_stages();
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  Told told;
  Runner runner(setup, {}, told);
  long steps = 0;
  int stages = 0;
  while (!runner.done()) {
    EXPECT_EQ(runner.state().step, steps);
    const Advance advance = runner.advance();
    EXPECT_TRUE(advance.took_step);
    EXPECT_TRUE(advance.report.converged);
    steps += advance.took_step;
    stages += advance.ended_stage;
    EXPECT_EQ(runner.stage(), stages);
  }
  const record::RunRecord record = runner.finish();
  EXPECT_EQ(record.state_hash, whole.state_hash);
  EXPECT_EQ(record.steps, whole.steps);
  EXPECT_EQ(steps, whole.steps);
  EXPECT_EQ(record.energy.friction, whole.energy.friction);
  EXPECT_FALSE(record.interrupted);
  EXPECT_EQ(told.calls, (std::vector<std::string>{"begin", "stage 0", "ended 0", "stage 1", "ended 1",
                                                  "stage 2", "ended 2", "end"}));
}

TEST(Runner, ThatIsDoneDoesNothing) {
  const RunSetup setup = three_stages();
  Told told;
  Runner runner(setup, {}, told);
  while (!runner.done()) runner.advance();
  const record::RunRecord record = runner.finish();
  const Advance more = runner.advance();
  EXPECT_FALSE(more.took_step);
  EXPECT_FALSE(more.ended_stage);
  EXPECT_EQ(runner.finish().state_hash, record.state_hash);
  EXPECT_EQ(runner.state().step, record.steps);
  EXPECT_EQ(told.ends, 1);
}

TEST(Runner, ShowsStateModelAndContactsBetweenSteps) {
  const RunSetup setup = three_stages();
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  EXPECT_EQ(runner.contact_count(), 0U);
  while (runner.stage() == 0) runner.advance();
  EXPECT_EQ(runner.model().surface.present[2], 1);
  double force = 0.0;
  std::size_t contacts = 0;
  runner.each_contact([&](std::span<const record::ContactRecord> some) {
    contacts += some.size();
    for (const record::ContactRecord& contact : some)
      if (contact.block_a + contact.block_b == 1) force += contact.normal_force;
  });
  EXPECT_EQ(contacts, runner.contact_count());
  EXPECT_NEAR(force / (2600.0 * g * 0.5), 1.0, 0.02);
  EXPECT_EQ(runner.state().time, 0.0);
  runner.advance();
  EXPECT_EQ(runner.model().surface.present[2], 0);
  EXPECT_NEAR(runner.state().time, setup.time_step, 1e-12);
  EXPECT_LT(runner.energy().residual_ratio, 0.01);
}

TEST(Runner, CallsBackAfterEveryStep) {
  const RunSetup setup = three_stages();
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  std::vector<long> steps;
  long iterations = 0;
  std::size_t most_contacts = 0;
  RunOptions options;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport& report) {
    steps.push_back(runner.state().step);
    iterations += report.iterations;
    most_contacts = std::max(most_contacts, runner.contact_count());
    EXPECT_FALSE(runner.done());
  };
  const record::RunRecord record = run(setup, options, nobody);
  EXPECT_EQ(record.state_hash, whole.state_hash);
  ASSERT_EQ(std::ssize(steps), whole.steps);
  for (std::size_t k = 0; k < steps.size(); ++k) EXPECT_EQ(steps[k], static_cast<long>(k) + 1);
  EXPECT_NEAR(static_cast<double>(iterations) / static_cast<double>(whole.steps),
              whole.open_close.mean_iterations, 1e-12);
  EXPECT_GE(most_contacts, 4U);
}

TEST(Runner, ThatIsFinishedInAStageIsResumedToTheSameBits) {
  const FreshFolder folder;
  const RunSetup setup = three_stages();
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  RunOptions options;
  options.directory = folder;
  Told told;
  {
    Runner runner(setup, options, told);
    while (runner.stage() < 2) runner.advance();
    runner.advance();
    const record::RunRecord part = runner.finish();
    EXPECT_TRUE(part.interrupted);
    EXPECT_TRUE(runner.done());
    ASSERT_EQ(part.stages.size(), 3U);
    EXPECT_TRUE(part.stages[2].interrupted);
    EXPECT_EQ(part.stages[2].steps, 1);
    EXPECT_EQ(told.calls.back(), "end");
    EXPECT_EQ(told.calls[told.calls.size() - 2], "interrupted 2");
  }
  options.resume = true;
  Told more;
  Runner runner(setup, options, more);
  EXPECT_EQ(runner.stage(), 2);
  while (!runner.done()) runner.advance();
  EXPECT_EQ(runner.finish().state_hash, whole.state_hash);
  EXPECT_FALSE(more.last.interrupted);
  EXPECT_EQ(more.calls, (std::vector<std::string>{"begin", "resume", "stage 2", "ended 2", "end"}));
}

TEST(Runner, ACallbackStopsTheRunAfterItsStep) {
  const RunSetup setup = three_stages();
  std::atomic<bool> stop = false;
  RunOptions options;
  options.stop = &stop;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport&) {
    stop = runner.stage() == 1 && runner.state().time > 0.05;
  };
  Told told;
  Runner runner(setup, options, told);
  while (!runner.done()) runner.advance();
  EXPECT_EQ(runner.stage(), 1);
  EXPECT_NEAR(runner.state().time, 0.05, 0.003);
  stop = false;  // what has been recorded as interrupted does not go on
  EXPECT_TRUE(runner.done());
  EXPECT_TRUE(runner.finish().interrupted);
  EXPECT_EQ(told.calls.back(), "end");
}

TEST(Runner, FailsOnceAndTellsTheObserver) {
  const RunSetup setup = three_stages();
  RunOptions options;
  options.after_step = [](const Runner& runner, const dynamics::StepReport&) {
    if (runner.state().step == 3) throw RunError("no more");
  };
  Told told;
  Runner runner(setup, options, told);
  runner.advance();
  runner.advance();
  EXPECT_THROW(runner.advance(), RunError);
  EXPECT_TRUE(runner.done());
  EXPECT_TRUE(told.last.interrupted);
  EXPECT_FALSE(runner.advance().took_step);
  EXPECT_EQ(runner.finish().steps, 3);
  EXPECT_EQ(told.ends, 1);
}

TEST(Runner, RefusesRockThatYieldsWithoutLimit) {
  RunSetup setup = three_stages();
  for (BlockProperties& properties : setup.properties) properties.material.young = 1.0;
  record::RunObserver nobody;
  EXPECT_THROW(Runner(setup, {}, nobody), RunError);
}

}  // namespace
}  // namespace keyblock::simulation
