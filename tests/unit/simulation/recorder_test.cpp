#include "simulation/recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../scene.h"
#include "simulation/runner.h"

namespace keyblock::simulation {
namespace {

/// Contacts of a block that falls on a floor at y = 0, after every step.
std::vector<record::ContactFrame> contacts_of_a_fall() {
  Scene scene(3e9, 30.0);
  scene.setup.solver.contact_damping = 0.0;  // forces are those of the springs alone
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.01}, 0.1, 0.1);
  scene.setup.time_step = scene.setup.output.contact_interval = 0.002;
  scene.setup.stages.push_back(stage("fall", record::StageKind::rest, 0.1));
  AllContacts observer;
  run(scene.setup, {}, observer);
  return observer.frames;
}

// In the step of an impact a contact begins open, and ends pressed: all that is recorded of it is of the end.
TEST(Recorder, GapOfAContactIsThatOfItsForce) {
  const auto frames = contacts_of_a_fall();
  bool struck = false;
  int pressed = 0;
  for (const record::ContactFrame& frame : frames) {
    for (const record::ContactRecord& c : frame.contacts) {
      EXPECT_NEAR(c.gap, c.position.y, 1e-9) << frame.time;
      if (c.normal_force > 0.0) {
        if (!struck) {
          EXPECT_EQ(c.state, record::ContactState::locked);
        }
        EXPECT_LT(c.gap, 0.0) << frame.time;
        EXPECT_NEAR(-c.gap * 20.0 * 3e9 * c.length / c.normal_force, 1.0, 1e-6) << frame.time;
        ++pressed;
      } else {
        EXPECT_EQ(c.state, record::ContactState::open) << frame.time;
        EXPECT_GE(c.gap, 0.0) << frame.time;
      }
    }
    struck = pressed > 0;
  }
  EXPECT_GT(pressed, 4);
}

// A block rests on an incline: what its contacts push it with is its weight.
TEST(Recorder, ForcesOfContactsOnBlockA) {
  Scene scene(3e9, 30.0);
  scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 20.0, true);
  const Vec2 along{std::cos(20.0 * degree), std::sin(20.0 * degree)};
  scene.rectangle(Vec2{-1.0, -1.0} + perpendicular(along) + along, 1.0, 0.5, 20.0);
  scene.setup.time_step = 0.002;
  scene.setup.stages.push_back(stage("settle", record::StageKind::settle));
  AllContacts observer;
  run(scene.setup, {}, observer);
  Vec2 on_block;
  for (const record::ContactRecord& c : observer.frames.back().contacts) {
    const Vec2 force = c.normal_force * c.normal + c.shear_force * Vec2{c.normal.y, -c.normal.x};
    on_block += c.block_a == 1 ? force : -1.0 * force;
  }
  const double weight = 0.5 * 2600.0 * g;
  EXPECT_NEAR(on_block.x, 0.0, 0.02 * weight);
  EXPECT_NEAR(on_block.y, weight, 0.02 * weight);
}

// A wall that slides on its courses has more contacts than are handed over at once: none is lost or taken twice, and each has the slip of
// its own piece of joint.
TEST(Recorder, ContactsThatAreGivenSomeAtATimeAreThoseOfTheFrame) {
  Scene scene(3e9, 10.0);
  scene.rectangle({-1.0, -1.0}, 12.0, 1.0, 0.0, true);
  for (int row = 0; row < 6; ++row)
    for (int k = 0; k < 6; ++k) scene.rectangle({1.0 * k + 0.3 * (row % 2), 0.5 * row}, 1.0, 0.5);
  scene.setup.motions = {loading::GroundMotion("m", {0.0, 0.1}, {{4.0, 0.0}, {4.0, 0.0}})};
  scene.setup.time_step = scene.setup.output.contact_interval = 0.002;
  scene.setup.stages = {stage("settle", record::StageKind::settle),
                        stage("shaking", record::StageKind::shake)};
  AllContacts observer;
  std::vector<record::ContactRecord> given;
  RunOptions options;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport&) {
    given.clear();
    runner.each_contact([&](std::span<const record::ContactRecord> some) {
      given.insert(given.end(), some.begin(), some.end());
    });
    EXPECT_EQ(given.size(), runner.contact_count());
  };
  run(scene.setup, options, observer);
  const std::vector<record::ContactRecord>& kept = observer.frames.back().contacts;
  ASSERT_GT(kept.size(), 64U);
  ASSERT_EQ(given.size(), kept.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    EXPECT_EQ(given[k].block_a, kept[k].block_a);
    EXPECT_EQ(given[k].normal_force, kept[k].normal_force);
    EXPECT_EQ(given[k].position, kept[k].position);
    EXPECT_EQ(given[k].shear_displacement, kept[k].shear_displacement);
    // The first course slides on the floor: its vertices have gone as far as its blocks have, along x.
    if (kept[k].block_b == 0) largest = std::max(largest, kept[k].slip());
  }
  // At 4 m/s² the base goes away under a friction of 10°: ½ (4 − g tan 10°) t².
  EXPECT_NEAR(largest, 0.5 * (4.0 - g * std::tan(10.0 * degree)) * 0.01, 0.1 * 0.0113);
}

struct AllHistories final : record::RunObserver {
  std::vector<record::HistoryRow> rows;
  void history(const record::HistoryRow& row) override { rows.push_back(row); }
};

// Three blocks beside each other fall freely; the first is excavated after two steps, the second after four.
TEST(Recorder, HistoriesFollowTheRockThatStaysLongestAndEndWithTheirBlock) {
  Scene scene(3e9, 30.0);
  for (int b = 0; b < 3; ++b) scene.rectangle({1.0 * b, 0.0}, 1.0, 1.0);
  for (int e = 0; e < 2; ++e)
    scene.setup.excavations.push_back(
        {"", scene.setup.system.blocks[static_cast<std::size_t>(e)].polygon.outer});
  scene.setup.system.blocks[0].excavations = {0};
  scene.setup.system.blocks[1].excavations = {1};
  scene.setup.histories = {
      {"in the first", "", {0.5, 0.5}}, {"border 0-1", "", {1.0, 0.5}}, {"border 1-2", "", {2.0, 0.5}}};
  scene.setup.time_step = 0.001;
  for (int s = 0; s < 3; ++s) {
    scene.setup.stages.push_back(stage("fall", record::StageKind::rest, 0.002));
    if (s > 0) scene.setup.stages.back().excavate = {s - 1};
  }
  AllHistories observer;
  run(scene.setup, {}, observer);
  ASSERT_EQ(observer.rows.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& points = observer.rows[k].points;
    EXPECT_EQ(std::isnan(points[0].uy), k >= 2) << k;
    EXPECT_EQ(std::isnan(points[0].sxy), k >= 2) << k;
    EXPECT_EQ(std::isnan(points[1].uy), k >= 4) << k;
    EXPECT_FALSE(std::isnan(points[2].uy)) << k;
  }
}

// A block that nothing holds stays where it is while its frame moves, through stages of all kinds.
TEST(Recorder, AbsoluteHistoriesHaveTheMotionOfTheFrame) {
  Scene scene(3e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  RunSetup& setup = scene.setup;
  setup.gravity = {};
  setup.histories = {{"relative", "", {0.5, 0.5}}, {"absolute", "", {0.5, 0.5}, true}};
  setup.motions = {loading::GroundMotion("m", {0.0, 0.3, 0.5}, {{0.0, 1.0}, {2.0, 0.0}, {1.0, -1.0}})};
  setup.time_step = 0.001;
  for (const record::StageKind kind :
       {record::StageKind::shake, record::StageKind::rest, record::StageKind::shake}) {
    setup.stages.push_back(stage("s", kind, 0.7));
    setup.stages.back().scale = kind == record::StageKind::shake ? 2.0 : 1.0;
  }
  AllHistories observer;
  run(setup, {}, observer);
  for (const record::HistoryRow& row : observer.rows) {
    EXPECT_NEAR(row.points[1].ux, 0.0, 2e-6) << row.time;
    EXPECT_NEAR(row.points[1].uy, 0.0, 2e-6) << row.time;
    EXPECT_NEAR(row.points[1].vx, 0.0, 1e-12) << row.time;
    EXPECT_NEAR(row.points[1].vy, 0.0, 1e-12) << row.time;
  }
  EXPECT_LT(observer.rows.back().points[0].ux, -1.0);
}

// What an accelerometer on a block records, by every rule: a block that falls has -g, and so has one in the frame of a base that is shaken
// less the mean of the record over the step.
TEST(Recorder, AccelerationIsTheMeanOverTheStep) {
  for (const dynamics::TimeIntegration rule :
       {dynamics::TimeIntegration::shi, dynamics::TimeIntegration::average_acceleration,
        dynamics::TimeIntegration::generalized_alpha}) {
    Scene scene(3e9, 30.0);
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    RunSetup& setup = scene.setup;
    setup.solver.integrator = rule;
    setup.histories = {{"relative", "", {0.2, 0.9}}, {"absolute", "", {0.2, 0.9}, true}};
    setup.motions = {loading::GroundMotion("m", {0.0, 0.5}, {{0.5, 1.0}, {1.5, -1.0}})};
    setup.time_step = 0.001;
    setup.output.history_interval = 0.003;
    setup.stages = {stage("shaking", record::StageKind::shake, 0.3)};
    setup.stages.back().scale = 2.0;
    AllHistories observer;
    run(setup, {}, observer);
    ASSERT_EQ(observer.rows.size(), 166U);
    for (const record::HistoryRow& row : observer.rows) {
      const record::HistoryRow::Point &relative = row.points[0], &absolute = row.points[1];
      const double middle = row.time - 0.0005;
      EXPECT_NEAR(absolute.ax - relative.ax, 2.0 * (0.5 + 2.0 * middle), 1e-9) << row.time;
      EXPECT_NEAR(absolute.ay - relative.ay, 2.0 * (1.0 - 4.0 * middle), 1e-9) << row.time;
      // The rules of order two take the record at the ends of steps.
      const double slack = rule == dynamics::TimeIntegration::shi ? 1e-9 : 0.01;
      EXPECT_NEAR(absolute.ax, 0.0, slack) << row.time;
      EXPECT_NEAR(absolute.ay, -9.81, slack) << row.time;
    }
  }
}

// A block that rests on a base and does not slip has the acceleration of the record: at a = 1 m/s², friction of 30° holds it.
TEST(Recorder, AbsoluteAccelerationOfABlockThatHoldsIsTheRecord) {
  Scene scene(3e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({-0.5, 0.0}, 1.0, 0.5);
  RunSetup& setup = scene.setup;
  setup.histories = {{"block", "", {0.0, 0.25}, true}, {"base", "", {0.0, -0.5}, true}};
  setup.motions = {loading::GroundMotion("m", {0.0, 0.4, 0.8}, {{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}})};
  setup.time_step = 0.001;
  setup.stages = {stage("weight", record::StageKind::settle, 0.0),
                  stage("shaking", record::StageKind::shake, 0.8)};
  AllHistories observer;
  run(setup, {}, observer);
  double largest = 0.0;
  for (const record::HistoryRow& row : observer.rows) {
    if (row.time == 0.0) {
      for (const record::HistoryRow::Point& p : row.points) EXPECT_EQ(p.ax == 0.0 && p.ay == 0.0, true);
      continue;
    }
    const double middle = row.time - 0.0005, record = 1.0 - std::abs(middle - 0.4) / 0.4;
    EXPECT_NEAR(row.points[1].ax, record, 0.002) << row.time;
    EXPECT_NEAR(row.points[0].ax, record, 0.02) << row.time;
    EXPECT_NEAR(row.points[0].ay, 0.0, 0.02) << row.time;
    largest = std::max(largest, row.points[0].ax);
  }
  EXPECT_NEAR(largest, 1.0, 0.02);
}

}  // namespace
}  // namespace keyblock::simulation
