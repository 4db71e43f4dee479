#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../scene.h"
#include "record/break_records.h"

namespace keyblock::simulation {
namespace {

struct Breaks final : record::RunObserver {
  bool may_break = false;
  std::vector<record::BreakRecord> rows;
  void begin(const record::ModelRecord& model) override { may_break = model.may_break; }
  void breaks(const record::BreakRecord& row) override { rows.push_back(row); }
};

/// A block of 2 m by 0.5 m that sets out from a floor at 0.3 m/s, bonded or not.
Scene leaving(Vec2 velocity, double cohesion, double tension) {
  Scene scene(1e10, 30.0);
  scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 2.0, 0.5);
  scene.setup.joints.standard.cohesion = cohesion;
  scene.setup.joints.standard.tension = tension;
  scene.setup.properties[1].velocity = velocity;
  scene.setup.time_step = 0.001;
  scene.setup.stages = {stage("leave", record::StageKind::rest, 0.05)};
  return scene;
}

TEST(Breaks, AreToldOfEachContactOnceWithItsPlace) {
  for (const int contacts : {2, 3}) {
    Scene scene = leaving({0.0, 0.3}, 1e5, 1e3);
    scene.setup.solver.face_contacts = contacts;
    Breaks breaks;
    const record::RunRecord record = run(scene.setup, {}, breaks);
    EXPECT_TRUE(breaks.may_break);
    ASSERT_EQ(breaks.rows.size(), static_cast<std::size_t>(contacts));
    double length = 0.0, middle = 0.0;
    for (const record::BreakRecord& row : breaks.rows) {
      EXPECT_EQ(row.mode, record::BreakMode::tension);
      EXPECT_LE(row.step, 2);
      EXPECT_NEAR(row.position.y, 0.0, 1e-3);
      EXPECT_EQ(row.block_a + row.block_b, 1);
      EXPECT_EQ(row.element, -1);
      length += row.length;
      middle += row.position.x / contacts;
    }
    EXPECT_NEAR(length, 2.0, 1e-9);
    EXPECT_NEAR(middle, 1.0, 1e-3);
    ASSERT_EQ(record.breaks.size(), 1u);
    EXPECT_EQ(record.breaks[0].events, contacts);
    EXPECT_DOUBLE_EQ(record.breaks[0].first, breaks.rows.front().time);
  }
}

TEST(Breaks, AreOfShearWhereTheBondSlips) {
  Breaks breaks;
  run(leaving({0.3, 0.0}, 1e3, 1e6).setup, {}, breaks);
  ASSERT_EQ(breaks.rows.size(), 2u);
  for (const record::BreakRecord& row : breaks.rows) EXPECT_EQ(row.mode, record::BreakMode::shear);
}

TEST(Breaks, AreNoneWhereTheBondHoldsOrThereIsNone) {
  Breaks strong, none;
  run(leaving({0.3, 0.0}, 1e9, 1e9).setup, {}, strong);
  EXPECT_TRUE(strong.may_break);
  EXPECT_TRUE(strong.rows.empty());
  run(leaving({0.3, 0.0}, 0.0, 0.0).setup, {}, none);
  EXPECT_FALSE(none.may_break);
  EXPECT_TRUE(none.rows.empty());
}

// A joint that loses its tension and then, as it has opened, its cohesion: an event each.
TEST(Breaks, AreTwoWhereCohesionOutlivesTension) {
  Scene scene = leaving({0.0, 0.05}, 1e5, 1e3);
  scene.setup.joints.standard.residual = contact::JointProperties::Residual{20.0, 1e4, 0.01};
  Breaks breaks;
  run(scene.setup, {}, breaks);
  ASSERT_EQ(breaks.rows.size(), 4u);
  EXPECT_LT(breaks.rows[1].step, breaks.rows[2].step);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(breaks.rows[k].mode, k < 2 ? record::BreakMode::tension : record::BreakMode::opening) << k;
}

/// A block of 1 m, bonded to a floor, that a force along its base pushes, more and more.
Scene pushed(double height, double cohesion) {
  Scene scene(1e9, 30.0);
  scene.rectangle({-3.0, -1.0}, 7.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, height, 0.0, false, 2);
  scene.setup.gravity = {0.0, -g};
  scene.setup.joints.standard.cohesion = cohesion;
  loading::Load push;
  push.block = "b1";
  push.is_line = true;
  push.from = {0.0, 0.0};
  push.to = {1.0, 0.0};
  push.value = push.value_end = {100e3, 0.0};
  push.factor = loading::TimeTable({{0.0, 0.0}, {1.0, 1.0}});
  scene.setup.loads.push_back(push);
  scene.setup.time_step = 0.005;
  scene.setup.stages = {stage("in place", record::StageKind::settle),
                        stage("push", record::StageKind::rest, 1.0)};
  return scene;
}

// All bonds of a model break in one step, which is taken again with what has been found of it.
TEST(Breaks, AreToldWhereAllBondsBreakInOneStep) {
  for (const double height : {0.4, 0.6, 0.8, 1.0}) {
    Breaks breaks;
    run(pushed(height, 50e3).setup, {}, breaks);
    double length = 0.0;
    for (const record::BreakRecord& row : breaks.rows) {
      EXPECT_EQ(row.mode, record::BreakMode::shear);
      // Coulomb, from above: bonds go one after another.
      EXPECT_LT(row.time, (50e3 + std::tan(30.0 * degree) * 2600.0 * g * height) / 100e3 + 0.005);
      length += row.length;
    }
    EXPECT_NEAR(length, 1.0, 1e-9) << height;
  }
}

TEST(Breaks, AreNoneWhereSlipTakesNothing) {
  Scene scene = pushed(0.1, 20e3);
  scene.setup.stages[1].duration = 0.25;
  scene.setup.joints.standard.residual = contact::JointProperties::Residual{30.0, 20e3, 0.0};
  Breaks breaks;
  AllContacts contacts;
  run(scene.setup, {}, breaks);
  EXPECT_TRUE(breaks.rows.empty());
  run(scene.setup, {}, contacts);
  ASSERT_FALSE(contacts.frames.empty());
  const std::vector<record::ContactRecord>& last = contacts.frames.back().contacts;
  ASSERT_FALSE(last.empty());
  double slip = 0.0;
  for (const record::ContactRecord& contact : last) slip = std::max(slip, contact.slip());
  EXPECT_GT(slip, 1e-3);
  for (const record::ContactRecord& contact : last) EXPECT_EQ(contact.strength_left, 1.0);
}

// Without tensile strength the heel of a wall that tips over has its cohesion until it has opened by 1e-4 of the block size.
TEST(Breaks, AreOfOpeningWhereAWallTipsOver) {
  Scene scene = pushed(1.0, 50e3);
  loading::Load& push = scene.setup.loads[0];
  push.value = push.value_end = {30e3, 0.0};
  push.from = {0.0, 1.0};
  push.to = {1.0, 1.0};
  Breaks breaks;
  run(scene.setup, {}, breaks);
  ASSERT_FALSE(breaks.rows.empty());
  EXPECT_EQ(breaks.rows[0].mode, record::BreakMode::opening);
  EXPECT_NEAR(breaks.rows[0].position.x, 0.0, 1e-3);
  EXPECT_NEAR(breaks.rows[0].position.y, 1e-4, 5e-5);
  // It tips over where the push has the moment of its weight: 0.425 s.
  EXPECT_NEAR(breaks.rows[0].time, 0.5 * 2600.0 * g / 30e3, 0.04);
}

// Excavated rock does not break.
TEST(Breaks, AreNotOfRockThatIsTakenAway) {
  Scene scene = leaving({}, 1e5, 1e3);
  scene.setup.system.blocks[1].excavations = {0};
  scene.setup.excavations.push_back({"trench", {{-0.1, 0.0}, {2.1, 0.0}, {2.1, 0.6}, {-0.1, 0.6}}});
  scene.setup.stages[0].excavate = {0};
  Breaks breaks;
  run(scene.setup, {}, breaks);
  EXPECT_TRUE(breaks.rows.empty());
}

}  // namespace
}  // namespace keyblock::simulation
