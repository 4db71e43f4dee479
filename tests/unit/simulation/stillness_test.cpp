#include "simulation/stillness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../fresh_folder.h"
#include "../scene.h"
#include "simulation/planned_changes.h"

namespace keyblock::simulation {
namespace {

/// A block that slides to rest on a floor from 1 m/s, at φ = 30°: v²/2μg is 88 mm, which take v/μg = 0.18 s.
RunSetup slide(double duration, double time_step = 0.001) {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 8.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  scene.setup.time_step = time_step;
  scene.setup.properties[1].velocity = {1.0, 0.0};
  record::Stage rest = stage("slide", record::StageKind::rest, duration);
  rest.until_still = true;
  rest.still_time = 0.1;
  scene.setup.stages = {rest, stage("after", record::StageKind::rest, 0.05)};
  return scene.setup;
}

// The stage ends so long after the block has come to rest as is asked for, and the next one follows there.
TEST(Stillness, EndsAStageWhenNothingMoves) {
  record::RunObserver nobody;
  const record::RunRecord record = run(slide(5.0), {}, nobody);
  ASSERT_EQ(record.stages.size(), 2u);
  EXPECT_TRUE(record.stages[0].still);
  EXPECT_FALSE(record.stages[0].interrupted);
  EXPECT_FALSE(record.interrupted);
  EXPECT_NEAR(record.stages[0].duration, 0.18 + 0.1, 0.03);
  EXPECT_EQ(record.stages[0].planned_duration, 5.0);
  EXPECT_EQ(record.stages[1].start_time, record.stages[0].duration);
  EXPECT_FALSE(record.stages[1].still);
}

// What still moves at the end of the duration is cut off there, as without `until`.
TEST(Stillness, ADurationThatIsOverEndsTheStage) {
  record::RunObserver nobody;
  const record::RunRecord record = run(slide(0.15), {}, nobody);
  EXPECT_FALSE(record.stages[0].still);
  EXPECT_FALSE(record.stages[0].interrupted);
  EXPECT_EQ(record.stages[0].duration, 0.15);
}

// A run that is interrupted while it waits, and resumed, waits on.
TEST(Stillness, AResumedRunEndsInTheSameBits) {
  const RunSetup setup = slide(5.0, 5e-5);
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);
  const FreshFolder folder;
  RunOptions options;
  options.directory = folder;
  Stopper stopper(4500);  // after the checkpoint at 4000, in which it waits
  options.stop = &stopper.stop;
  EXPECT_TRUE(run(setup, options, stopper).interrupted);
  options.stop = nullptr;
  options.resume = true;
  const record::RunRecord resumed = run(setup, options, nobody);
  EXPECT_EQ(resumed.state_hash, whole.state_hash);
  EXPECT_EQ(resumed.stages[0].steps, whole.stages[0].steps);
}

// A pause in a record is not its end.
TEST(Stillness, ShakingIsOverWhenItStaysWeak) {
  const loading::GroundMotion motion(
      "two", {0.0, 1.0, 2.0, 3.0, 4.0, 5.0},
      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}, {0.0, 4.0}, {0.1, 0.0}, {0.0, 0.0}});
  EXPECT_EQ(end_of_shaking(motion, 5.0, 1.0), 3.0);
  EXPECT_EQ(end_of_shaking(motion, 2.0, 1.0), 1.0);
  EXPECT_EQ(end_of_shaking(motion, 5.0, 0.05), 4.0)
      << "a twentieth of a strong shaking still moves what yields early";
}

/// A load that grows from 1.0 to 1.1 s on a block that bears it.
RunSetup loaded_later(double until) {
  RunSetup setup = slide(5.0);
  setup.properties[1].name = "stone";
  loading::Load load;
  load.block = "stone";
  load.from = load.to = {0.5, 0.25};
  load.value = {100.0, 0.0};
  load.factor = loading::TimeTable({{0.0, 0.0}, {1.0, 0.0}, {until, 1.0}, {until + 1.0, 1.0}});
  setup.loads = {load};
  return setup;
}

// Nothing that is planned may come after the end.
TEST(Stillness, WaitsForALoadThatIsToCome) {
  record::RunObserver nobody;
  const record::RunRecord record = run(loaded_later(1.1), {}, nobody);
  ASSERT_TRUE(record.stages[0].waits_for);
  EXPECT_EQ(record.stages[0].waits_for->what, "load 1");
  EXPECT_EQ(record.stages[0].waits_for->until, 1.1);
  EXPECT_TRUE(record.stages[0].still);
  EXPECT_NEAR(record.stages[0].duration, 1.2, 0.02);
  EXPECT_FALSE(record.stages[1].waits_for);
}

// What comes after its longest duration keeps it going to that: later stages count on its time.
TEST(Stillness, WaitsToTheEndForWhatComesLater) {
  record::RunObserver nobody;
  const record::RunRecord record = run(loaded_later(9.0), {}, nobody);
  EXPECT_FALSE(record.stages[0].still);
  EXPECT_EQ(record.stages[0].duration, 5.0);
}

// The rows of a table that say nothing new are no change.
TEST(PlannedChanges, EndWhereATableIsConstant) {
  using loading::TimeTable;
  EXPECT_EQ(TimeTable({{0.0, 0.0}, {2.0, 0.0}, {2.1, 1.0}, {3.0, 1.0}}).last_change(), 2.1);
  EXPECT_EQ(TimeTable({{0.0, 1.0}, {5.0, 1.0}}).last_change(), std::nullopt);
  EXPECT_EQ(TimeTable().last_change(), std::nullopt);
  RunSetup setup = slide(1.0);
  EXPECT_FALSE(last_planned_change(setup));
  setup.properties[0].name = "floor";
  setup.properties[0].motion_x = TimeTable({{0.0, 0.0}, {3.0, 0.0}, {4.0, 0.1}});
  EXPECT_EQ(last_planned_change(setup)->what, "the motion of the fixed block 'floor'");
  setup.supports.emplace_back().motion_y = TimeTable({{0.0, 0.0}, {6.0, 0.1}});
  EXPECT_EQ(last_planned_change(setup)->time, 6.0);
}

// Only vertices that are there count, and one that is nowhere never stays.
TEST(Stillness, LooksAtVerticesThatAreThere) {
  contact::Surface surface;
  surface.block = {0, 1};
  surface.present = {1, 1};
  surface.position = {{0.0, 0.0}, {1.0, 0.0}};
  Stillness stillness(0.1, 1.0, 0.5);
  EXPECT_FALSE(stillness.is_still(surface, 0.4));
  EXPECT_TRUE(stillness.memory().places.empty());
  EXPECT_FALSE(stillness.is_still(surface, 0.5));
  surface.position[1].x = 1.2;
  EXPECT_FALSE(stillness.is_still(surface, 1.4));
  EXPECT_FALSE(stillness.is_still(surface, 2.3));
  surface.position[1].x = 1.25;
  EXPECT_TRUE(stillness.is_still(surface, 2.4));
  surface.position[0].y = -1.0;
  EXPECT_FALSE(stillness.is_still(surface, 2.5));
  surface.present[0] = 0;
  surface.position[0].y = -2.0;
  EXPECT_FALSE(stillness.is_still(surface, 3.4));
  EXPECT_TRUE(stillness.is_still(surface, 3.5));
  surface.position[1].x = std::nan("");
  EXPECT_FALSE(stillness.is_still(surface, 3.6));
}

}  // namespace
}  // namespace keyblock::simulation
