// Joints of their own between two blocks, in whole runs.
#include <gtest/gtest.h>

#include <cmath>

#include "../resumed_run.h"
#include "../scene.h"
#include "cutting/interfaces.h"

namespace keyblock::simulation {
namespace {

constexpr double slope = 30.0, of_others = 20.0, of_interface = 10.0;  // °

/// Two blocks beside each other on one incline, the second one with an interface with it.
Scene two_on_an_incline(int order) {
  Scene scene(1e10, of_others);
  const Vec2 along = direction(slope), up{-along.y, along.x};
  scene.rectangle(-20.0 * along - up, 40.0, 1.0, slope, true);
  scene.rectangle({}, 1.0, 0.5, slope, false, order);
  scene.rectangle(3.0 * along, 1.0, 0.5, slope, false, order);
  scene.setup.joint_set_names = {"foot"};
  scene.setup.joints.joint_sets.push_back(scene.setup.joints.standard);
  scene.setup.joints.joint_sets[0].friction = of_interface;
  scene.setup.system.interfaces = {{0, 2, {cutting::EdgeKind::joint_set, 0}}};
  cutting::label_interfaces(scene.setup.system);
  return scene;
}

// m/s², down the slope.
double acceleration(double friction) {
  return g * (std::sin(slope * degree) - std::cos(slope * degree) * std::tan(friction * degree));
}

/// Way down the slope.
double way(const Simulator& s, int block, Vec2 from) {
  return -dot(s.centroid(block) - from, direction(slope));
}

// Both lie on the same edge. The one goes on far over the place where it lay, and keeps the friction of its interface.
TEST(Interface, IsOfTwoBlocksAndNotOfAnEdge) {
  for (const int order : {1, 2, 3}) {
    Simulator s(two_on_an_incline(order));
    const Vec2 first = s.centroid(1), second = s.centroid(2);
    constexpr double time = 0.6;
    s.run(time, 0.002);
    EXPECT_NEAR(way(s, 1, first), 0.5 * time * time * acceleration(of_others), 2e-3) << order;
    EXPECT_NEAR(way(s, 2, second), 0.5 * time * time * acceleration(of_interface), 2e-3) << order;
  }
}

// A bond of the interface holds its block; the other one slides.
TEST(Interface, BondsItsBlocks) {
  Scene scene = two_on_an_incline(1);
  scene.setup.joints.joint_sets[0].cohesion = 1e5;
  Simulator s(scene);
  const Vec2 first = s.centroid(1), second = s.centroid(2);
  s.run(0.2, 0.002);
  EXPECT_GT(way(s, 1, first), 0.02);
  EXPECT_LT(way(s, 2, second), 1e-4);
}

/// Of the last contacts, and of the edges.
struct Labels final : record::RunObserver {
  std::vector<record::ContactRecord> rows;
  void contacts(const record::ContactFrame& frame) override { rows = frame.contacts; }
};

TEST(Interface, IsTheLabelOfItsContacts) {
  Scene scene = two_on_an_incline(2);
  scene.setup.time_step = 0.002;
  scene.setup.stages = {stage("slide", record::StageKind::rest, 0.1)};
  Labels seen;
  run(scene.setup, {}, seen);
  int own = 0, others = 0;
  for (const record::ContactRecord& row : seen.rows) {
    const bool is_own = row.label == cutting::EdgeLabel{cutting::EdgeKind::joint_set, 0};
    EXPECT_EQ(is_own, row.block_a == 2 || row.block_b == 2);
    (is_own ? own : others) += 1;
  }
  EXPECT_GE(own, 2);
  EXPECT_GE(others, 2);
}

// Of the water around a block, all but what is in the joint below presses on it: it does not float.
TEST(Interface, ThatIsDryHoldsNoWater) {
  for (const int order : {1, 2, 3}) {
    for (const bool is_dry : {false, true}) {
      Scene scene(1e9, 30.0);
      scene.rectangle({-5.0, -1.0}, 10.0, 1.0, 0.0, true);
      scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, false, order);
      scene.setup.joints.joint_sets.push_back(scene.setup.joints.standard);
      scene.setup.joint_set_names = {"foot"};
      scene.setup.system.interfaces = {{0, 1, {cutting::EdgeKind::joint_set, 0}}};
      scene.setup.waters = {{"lake", loading::WaterTable({{0.0, 3.0}}), 1000.0, {is_dry}}};
      scene.setup.time_step = 0.002;
      record::Stage settle = stage("settle", record::StageKind::settle);
      settle.tolerance = 1e-7;
      scene.setup.stages = {settle};
      record::RunObserver nobody;
      const record::RunRecord record = run(scene.setup, {}, nobody);
      ASSERT_TRUE(record.water);
      const auto& [name, force] = record.water->forces.back();
      EXPECT_EQ(name, "water.b1");
      const double up = force.y, weight = 1000.0 * g;
      EXPECT_NEAR(up, is_dry ? -2.0 * weight : weight, 1.0) << order;
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
