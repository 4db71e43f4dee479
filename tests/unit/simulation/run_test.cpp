#include "simulation/run.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "../fresh_folder.h"
#include "../resumed_run.h"
#include "../scene.h"
#include "core/error.h"
#include "simulation/checkpoint.h"

namespace keyblock::simulation {
namespace {

/// Motion A sin ωt sampled finely enough for its integral.
loading::GroundMotion sine(double amplitude, double frequency, double cycles) {
  std::vector<double> time;
  std::vector<Vec2> acceleration;
  const int count = static_cast<int>(cycles * 400);
  for (int k = 0; k <= count; ++k) {
    time.push_back(k / (400.0 * frequency));
    acceleration.push_back({amplitude * std::sin(2.0 * std::numbers::pi * frequency * time.back()), 0.0});
  }
  return {"sine", time, acceleration};
}

/// A block on an incline of 20°, φ 30°, settled and then shaken n times by the same motion.
RunSetup shaken_incline(int shakings) {
  const double alpha = 20.0 * std::numbers::pi / 180.0;
  Scene scene(5e10, 30.0);
  scene.rectangle({-20.0 * std::cos(alpha), -20.0 * std::sin(alpha)}, 24.0, -1.0, 20.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, 20.0);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.motions.push_back(sine(0.5 * 9.81, 1.0, 2.0));
  setup.stages.push_back(stage("settle", record::StageKind::settle));
  for (int k = 0; k < shakings; ++k) setup.stages.push_back(stage("shake", record::StageKind::shake));
  setup.histories.push_back({"block", "b1", {0.3, 0.4}});
  return setup;
}

struct LastRecord final : record::RunObserver {
  record::RunRecord record;
  void end(const record::RunRecord& run) override { record = run; }
};

/// Why a run cannot go on.
std::string failure_of(const RunSetup& setup, record::RunObserver& observer) {
  try {
    run(setup, {}, observer);
  } catch (const RunError& error) {
    return error.what();
  }
  return {};
}

double slid(int shakings) {
  LastHistory observer;
  const record::RunRecord record = run(shaken_incline(shakings), {}, observer);
  EXPECT_EQ(record.open_close.unconverged_steps, 0);
  EXPECT_TRUE(record.stages[0].equilibrium_reached);
  EXPECT_LT(record.energy.residual_ratio, 0.01);
  return std::hypot(observer.last.points[0].ux, observer.last.points[0].uy);
}

TEST(Run, RepeatedShakingGivesRepeatedSlip) {
  const double once = slid(1);
  EXPECT_NEAR(once / (2.0 * 0.313620), 1.0, 5e-3);
  EXPECT_NEAR(slid(5) / (5.0 * once), 1.0, 5e-3);
}

struct AllSteps final : record::RunObserver {
  std::vector<record::StepRow> rows;
  void step(const record::StepRow& row) override { rows.push_back(row); }
};

// Pseudo time steps begin at the time step and grow by a quarter after every step that converges at once, to fifty time steps.
TEST(Run, StaticStepsAreWrittenWithTheirPseudoTimeStep) {
  RunSetup setup = shaken_incline(1);
  setup.time_step = 0.02;  // s: a row of every step
  AllSteps observer;
  const record::RunRecord record = run(setup, {}, observer);
  double longest = 0.0;
  ASSERT_GE(std::ssize(observer.rows), record.stages[0].steps);
  EXPECT_EQ(observer.rows[0].step_size, setup.time_step);
  for (const record::StepRow& row : observer.rows) {
    if (row.stage == 0) {
      longest = std::max(longest, row.step_size);
    } else {
      EXPECT_LE(row.step_size, setup.time_step);
    }
  }
  EXPECT_GE(longest, 2.0 * setup.time_step);
  EXPECT_LE(longest, 1e5 * setup.time_step);
  EXPECT_EQ(observer.rows.back().step_size, setup.time_step);
}

void expect_equal_energies(const record::Energy& one, const record::Energy& other) {
  for (const auto term :
       {&record::Energy::kinetic, &record::Energy::strain, &record::Energy::gravity, &record::Energy::contact,
        &record::Energy::friction, &record::Energy::damping, &record::Energy::radiated,
        &record::Energy::input, &record::Energy::numerical, &record::Energy::residual_ratio})
    EXPECT_EQ(one.*term, other.*term);
}

/// By conjugate residuals, or as it is by default.
class ResumedRun : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(ByConjugateResiduals, ResumedRun, ::testing::Bool());

TEST_P(ResumedRun, EndsInTheSameBits) {
  const FreshFolder folder;
  RunSetup setup = shaken_incline(5);
  if (GetParam()) setup.solver.linear = dynamics::LinearSolver::iterative;
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);

  Stopper stopper(3500);
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  const record::RunRecord part = run(setup, options, stopper);
  EXPECT_TRUE(part.interrupted);
  EXPECT_LT(part.steps, whole.steps);

  options.stop = nullptr;
  options.resume = true;
  const record::RunRecord resumed = run(setup, options, nobody);
  EXPECT_EQ(resumed.state_hash, whole.state_hash);
  EXPECT_EQ(resumed.steps, whole.steps);
  EXPECT_EQ(resumed.stages.size(), whole.stages.size());
  expect_equal_energies(resumed.energy, whole.energy);

  RunSetup other = setup;
  other.time_step = 0.001;
  EXPECT_THROW(run(other, options, nobody), InputError);
  std::filesystem::resize_file(folder / "checkpoint.bin", 1000);
  EXPECT_THROW(run(setup, options, nobody), InputError);
}

// Sums of many steps are rounded: where a stage began, and with it the motion, is not to be had from them.
TEST(Run, AStageThatIsResumedWithinBeganWhenItDid) {
  const FreshFolder folder;
  RunSetup setup = shaken_incline(1);
  setup.motions = {sine(0.5 * 9.81, 1.0, 6.0)};
  setup.stages.insert(setup.stages.begin() + 1, stage("rest", record::StageKind::rest, 1.0));
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  Stopper stopper(whole.steps - 100);
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  ASSERT_TRUE(run(setup, options, stopper).interrupted);
  ASSERT_GT(read_checkpoint(folder, setup).stage_step, 0);
  EXPECT_NEAR(read_checkpoint(folder, setup).mechanics.last_step, setup.time_step, 1e-9);
  options.stop = nullptr;
  options.resume = true;
  const record::RunRecord resumed = run(setup, options, nobody);
  EXPECT_EQ(resumed.stages[2].start_time, 1.0);
  EXPECT_EQ(resumed.stages[2].start_time, whole.stages[2].start_time);
  EXPECT_EQ(resumed.state_hash, whole.state_hash);
}

TEST(Run, ResumesBeforeAnythingIsExcavated) {
  const FreshFolder folder;
  RunSetup setup = shaken_incline(2);
  setup.excavations.push_back({"above", {{0.0, 5.0}, {1.0, 5.0}, {1.0, 6.0}}});
  setup.stages.back().excavate = {0};
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  Stopper stopper(whole.stages[0].steps + 100);
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  ASSERT_TRUE(run(setup, options, stopper).interrupted);
  ASSERT_TRUE(read_checkpoint(folder, setup).damage.reference.start.empty());
  options.stop = nullptr;
  options.resume = true;
  EXPECT_EQ(run(setup, options, nobody).state_hash, whole.state_hash);
}

// The end of a stage has a checkpoint of its own. From one after its last step, no step would be left to find contacts by.
TEST(Run, NoCheckpointWithinAStageAfterItsLastStep) {
  const FreshFolder folder;
  RunSetup setup = shaken_incline(0);
  setup.stages.push_back(stage("rest", record::StageKind::rest, 2000 * setup.time_step));
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  Stopper stopper(whole.steps);
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  ASSERT_EQ(run(setup, options, stopper).steps, whole.steps);
  const RunState kept = read_checkpoint(folder, setup);
  EXPECT_EQ(kept.stage, 1);
  EXPECT_EQ(kept.stage_step, 0);
}

TEST(Run, ThatCannotGoOnHasNotReachedItsEnd) {
  struct Failing final : record::RunObserver {
    bool interrupted = false;
    void step(const record::StepRow&) override { throw RunError("the disk is full"); }
    void end(const record::RunRecord& record) override { interrupted = record.interrupted; }
  };
  Failing observer;
  EXPECT_THROW(run(shaken_incline(1), {}, observer), RunError);
  EXPECT_TRUE(observer.interrupted);
}

TEST(Run, OtherFilesAreOtherInput) {
  const FreshFolder folder;
  RunSetup setup = shaken_incline(1);
  setup.files = {{"q.csv", "00ff"}};
  record::RunObserver nobody;
  RunOptions options;
  options.directory = folder;
  run(setup, options, nobody);
  EXPECT_NO_THROW(read_checkpoint(folder, setup));
  setup.files[0].hash = "00fe";
  EXPECT_THROW(read_checkpoint(folder, setup), InputError);
}

// Blocks that overlap at the start are taken as they are: the joint between them is not pressed.
TEST(Run, GapsAreThoseThatTheJointLawHas) {
  struct LastContacts final : record::RunObserver {
    record::ContactFrame last;
    void contacts(const record::ContactFrame& frame) override { last = frame; }
  };
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({-0.5, -0.001}, 1.0, 0.5);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.stages = {stage("settle", record::StageKind::settle)};
  LastContacts observer;
  run(setup, {}, observer);
  double force = 0.0;
  for (const record::ContactRecord& contact : observer.last.contacts) {
    if (contact.normal_force <= 0.0) continue;
    force += contact.normal_force;
    EXPECT_LT(contact.gap, 0.0);
    EXPECT_GT(contact.gap, -1e-5);
  }
  EXPECT_NEAR(force / (2600.0 * g * 0.5), 1.0, 0.01);
}

RunSetup shaken_wall() {
  Scene scene(1e9, 35.0);
  scene.add({{-2.0, -1.0}, {8.0, -1.0}, {8.0, 0.0}, {-2.0, 0.0}}, true);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 4; ++column) {
      scene.rectangle({1.0 * column + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5, 0.0, false, row == 4 ? 2 : 1);
    }
  }
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.motions.push_back(sine(6.0, 2.0, 2.0));
  setup.stages = {stage("settle", record::StageKind::settle), stage("shake", record::StageKind::shake),
                  stage("rest", record::StageKind::rest, 0.5)};
  return setup;
}

// A run that is killed leaves no more than this of the stage it was in.
TEST(Run, TellsWhatIsPlannedBeforeAStageBegins) {
  struct Begun final : record::RunObserver {
    record::ModelRecord model;
    std::vector<record::StageRecord> stages;
    void begin(const record::ModelRecord& record) override { model = record; }
    void stage_begin(int, const record::StageRecord& record) override { stages.push_back(record); }
  };
  RunSetup setup = shaken_incline(1);
  setup.stages.push_back(stage("rest", record::StageKind::rest, 0.0041));
  Begun begun;
  const record::RunRecord record = run(setup, {}, begun);
  EXPECT_EQ(begun.model.stage_names, (std::vector<std::string>{"settle", "shake", "rest"}));
  EXPECT_EQ(begun.model.slip_limit, setup.damage.slip);
  ASSERT_EQ(begun.stages.size(), 3U);
  EXPECT_FALSE(begun.stages[0].planned_duration);
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_EQ(begun.stages[k].duration, 0.0);
    EXPECT_EQ(begun.stages[k].planned_duration, record.stages[k].duration);
  }
  EXPECT_DOUBLE_EQ(begun.stages[2].planned_duration.value_or(0.0), 0.004);
  EXPECT_EQ(begun.stages[1].pga, record.stages[1].pga);
  EXPECT_EQ(begun.stages[1].motion, record.stages[1].motion);
  EXPECT_GT(begun.stages[1].pga, 1.0);
}

struct StopInRest final : record::RunObserver {
  std::atomic<bool> stop = false;
  void step(const record::StepRow& row) override { stop = row.stage == 2; }
};

// Of many contacts, the sum of their energies depends on its order.
TEST(Run, AResumedRunHasTheSameEnergies) {
  const RunSetup setup = shaken_wall();
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  StopInRest stopper;
  expect_equal_energies(resumed_run(setup, stopper).energy, whole.energy);
}

// Neither a checkpoint nor what begins from it may form them anew: sums depend on their order.
TEST(Run, StoredEnergiesArePartOfTheState) {
  const FreshFolder folder;
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({-0.5, 0.0}, 1.0, 0.5);
  Simulator simulator(scene);
  RunState kept;
  kept.mechanics = simulator.state;
  kept.mechanics.contact_energy = 0.1;
  kept.mechanics.support_energy = 0.3;
  write_checkpoint(folder, scene.setup, kept);
  RunState read = read_checkpoint(folder, scene.setup);
  simulator.stepper.resume(read.mechanics);
  EXPECT_EQ(read.mechanics.contact_energy, 0.1);
  EXPECT_EQ(read.mechanics.support_energy, 0.3);
}

// All linear solvers solve the same problem. Before anything slides for good, they differ by no more than tolerances do.
TEST(Run, LinearSolversAgree) {
  RunSetup setup = shaken_wall();
  setup.stages = {stage("settle", record::StageKind::settle), stage("shake", record::StageKind::shake)};
  setup.stages[1].duration = 0.1;
  setup.histories.push_back({"top", "", {2.0, 2.4}});
  std::vector<record::HistoryRow::Point> ends;
  for (const auto linear : {dynamics::LinearSolver::direct, dynamics::LinearSolver::block,
                            dynamics::LinearSolver::iterative, dynamics::LinearSolver::automatic}) {
    setup.solver.linear = linear;
    LastHistory observer;
    const record::RunRecord record = run(setup, {}, observer);
    EXPECT_EQ(record.open_close.unconverged_steps, 0);
    ends.push_back(observer.last.points[0]);
  }
  EXPECT_GT(std::abs(ends[0].vx), 1e-3);
  for (const record::HistoryRow::Point& end : ends) {
    EXPECT_NEAR(end.ux, ends[0].ux, 1e-7);
    EXPECT_NEAR(end.uy, ends[0].uy, 1e-7);
    EXPECT_NEAR(end.vx, ends[0].vx, 1e-5);
  }
}

// The same bits on every rerun, for any number of threads and from every build, and as long as nobody changes the
// mechanics: whoever does so on purpose puts the new value here.
TEST(Run, GoldenStateHash) {
  record::RunObserver nobody;
  RunOptions two;
  two.threads = 2;
  const record::RunRecord record = run(shaken_wall(), {}, nobody);
  EXPECT_EQ(record.open_close.unconverged_steps, 0);
  EXPECT_EQ(record.state_hash, "4d61b85e2a8154a6");
  EXPECT_EQ(run(shaken_wall(), two, nobody).state_hash, record.state_hash);
  EXPECT_LT(record.max_overlap.depth, 1e-3);
}

TEST(Run, ClosedContactsAreThoseAtTheEndOfAStepThatWasHalved) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 1.0}, 1.0, 1.0);
  Simulator s(scene);
  s.run(0.1, 0.002);
  EXPECT_EQ(s.stepper.advance(s.state, 0.002, nullptr).closed_contacts, 2);
  s.model.solver.max_iterations = 0;
  s.model.solver.max_halvings = 1;
  const dynamics::StepReport halved = s.stepper.advance(s.state, 0.002, nullptr);
  EXPECT_EQ(halved.substeps, 2);
  EXPECT_EQ(halved.closed_contacts, 2);
}

/// A block on another, for 20 steps of settling.
RunSetup pressed_block(double young) {
  Scene scene(young, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 1.0}, 1.0, 1.0);
  scene.setup.time_step = 0.002;
  scene.setup.stages.push_back(stage("settle", record::StageKind::settle));
  scene.setup.stages.back().max_steps = 20;
  return scene.setup;
}

TEST(Run, StepsThatDoNotConvergeAreNoEquilibrium) {
  LastRecord last;
  EXPECT_NE(failure_of(pressed_block(1e300), last), "");
  EXPECT_TRUE(last.record.stages.empty() || !last.record.stages[0].equilibrium_reached);
}

// A block on the ground turns by half a radian in the only step of its stage, which is not cut into shorter ones.
TEST(Run, EndsWithAStageOfWhichNoStepConverges) {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 5.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.properties[1].spin = 250.0;
  setup.solver.max_halvings = 0;
  setup.stages.push_back(stage("turn", record::StageKind::rest, 0.002));
  LastRecord last;
  EXPECT_EQ(failure_of(setup, last),
            "no step of stage 'turn' converged, of 1 from step 1 of the run on; the results up to there "
            "are kept");
  EXPECT_EQ(last.record.stages.size(), 1U);
  setup.solver.max_halvings = 8;
  EXPECT_EQ(failure_of(setup, last), "");
}

// Flight takes one iteration a step, the impact more.
TEST(Run, GoesOnWhereSingleStepsDoNotConverge) {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.05}, 1.0, 0.5, 5.0);
  RunSetup setup = scene.setup;
  setup.time_step = 0.002;
  setup.stages.push_back(stage("fall", record::StageKind::rest, 0.3));
  setup.solver.max_iterations = 1;
  setup.solver.max_halvings = 0;
  record::RunObserver nobody;
  const record::RunRecord record = run(setup, {}, nobody);
  EXPECT_GT(record.open_close.unconverged_steps, 0);
  EXPECT_LT(record.open_close.unconverged_steps, record.steps);
}

TEST(Run, EndsWhereEnergiesAreNoNumbers) {
  LastRecord last;
  RunSetup setup = pressed_block(1e300);
  setup.stages = {stage("rest", record::StageKind::rest, 0.04)};
  EXPECT_EQ(
      failure_of(setup, last),
      "the energies after step 10 of stage 'rest' are no finite numbers; the results up to there are kept");
  EXPECT_EQ(last.record.steps, 10);
}

}  // namespace
}  // namespace keyblock::simulation
