// Water in joints, in whole runs.
#include <gtest/gtest.h>

#include <cmath>

#include "../resumed_run.h"
#include "../scene.h"
#include "simulation/build_water.h"

namespace keyblock::simulation {
namespace {

Water level_at(const char* name, double height) {
  return {name, loading::WaterTable({{0.0, height}}), 1000.0, {}};
}

struct LastContacts final : record::RunObserver {
  std::vector<record::ContactRecord> contacts_;
  void contacts(const record::ContactFrame& frame) override { contacts_ = frame.contacts; }
};

/// A roof of two blocks, between which a wedge hangs from its joints, under water.
Scene wet_roof() {
  Scene scene(1e9, 30.0);
  scene.add({{-3.0, 0.0}, {-1.0, 0.0}, {-0.5, 2.0}, {-3.0, 2.0}}, true);
  scene.add({{1.0, 0.0}, {3.0, 0.0}, {3.0, 2.0}, {0.5, 2.0}}, true);
  scene.add({{-1.0, 0.0}, {1.0, 0.0}, {0.5, 2.0}, {-0.5, 2.0}});
  scene.setup.time_step = 0.002;
  scene.setup.waters = {level_at("lake", 10.0)};
  return scene;
}

/// Nine blocks of 1 m within fixed ones, under water. The one in the middle is excavated.
Scene wet_blocks() {
  Scene scene(1e9, 60.0);
  scene.rectangle({-1.0, -1.0}, 1.0, 5.0, 0.0, true);
  scene.rectangle({3.0, -1.0}, 1.0, 5.0, 0.0, true);
  scene.rectangle({0.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 3.0}, 3.0, 1.0, 0.0, true);
  for (const double y : {0.0, 1.0, 2.0}) {
    for (const double x : {0.0, 1.0, 2.0}) scene.rectangle({x, y}, 1.0, 1.0);
  }
  scene.setup.system.blocks[8].excavations = {0};
  scene.setup.excavations.push_back({"middle", {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}}});
  scene.setup.in_situ = block::InSituStress{.sxx = -1e6, .syy = -1e6};
  scene.setup.time_step = 0.002;
  scene.setup.waters = {level_at("table", 33.0)};
  return scene;
}

record::Stage settles(const char* name) {
  record::Stage s = stage(name, record::StageKind::settle);
  s.tolerance = 1e-7;
  return s;
}

/// N per thickness, on a block by its name.
Vec2 force_on(const record::RunRecord& record, const std::string& name) {
  for (const auto& [known, force] : record.water->forces) {
    if (known == name) return force;
  }
  ADD_FAILURE() << name;
  return {};
}

TEST(Water, ContactsBeginWithEffectiveStress) {
  Scene scene = wet_blocks();
  scene.setup.stages = {settles("in place")};
  LastContacts last;
  const record::RunRecord record = run(scene.setup, {}, last);
  EXPECT_LT(record.stages[0].damage.displacement_max, 1e-4);
  ASSERT_FALSE(last.contacts_.empty());
  double forces = 0.0, total = 0.0;
  for (const record::ContactRecord& c : last.contacts_) {
    const double head = 33.0 - c.position.y;
    EXPECT_NEAR(c.water_pressure, 1000.0 * g * head, 60.0) << c.position.y;
    forces += c.normal_force;
    total += (1e6 - c.water_pressure) * c.length;
  }
  EXPECT_NEAR(forces / total, 1.0, 0.02);
}

TEST(Water, DrainsIntoAnOpeningOrFillsIt) {
  for (const bool is_filled : {false, true}) {
    Scene scene = wet_blocks();
    scene.setup.excavations[0].is_filled = is_filled;
    scene.setup.stages = {settles("in place"), settles("open")};
    scene.setup.stages[1].excavate = {0};
    record::RunObserver nobody;
    const record::RunRecord record = run(scene.setup, {}, nobody);
    ASSERT_TRUE(record.water);
    EXPECT_EQ(record.water->drained, is_filled ? 0.0 : 4.0);
    // The block below the opening: buoyant where water stands in it, else pressed up by all of what is below.
    const double up = force_on(record, "water.b5").y;
    EXPECT_NEAR(up / (1000.0 * g * (is_filled ? 1.0 : 33.0)), 1.0, 1e-3);
  }
}

// What the rock did to the wall, and the water between both, is kept.
TEST(Water, NothingReleasedMovesNothing) {
  for (const bool is_filled : {false, true}) {
    Scene scene = wet_blocks();
    scene.setup.excavations[0].is_filled = is_filled;
    scene.setup.stages = {settles("in place"), settles("open")};
    scene.setup.stages[1].excavate = {0};
    scene.setup.stages[1].release = {{0, 0.0}};
    record::RunObserver nobody;
    const record::RunRecord record = run(scene.setup, {}, nobody);
    EXPECT_TRUE(record.stages[1].equilibrium_reached);
    EXPECT_LT(record.stages[1].damage.displacement_max, 1e-8);
  }
}

TEST(Water, ReleasedInPartsIsAsReleasedAtOnce) {
  Scene scene = wet_blocks();
  scene.setup.stages = {settles("in place"), settles("open")};
  scene.setup.stages[1].excavate = {0};
  record::RunObserver nobody;
  const double at_once = run(scene.setup, {}, nobody).stages[1].damage.displacement_max;
  scene.setup.stages[1].release = {{0, 1.0}};
  scene.setup.stages[1].release_steps = 4;
  const double in_parts = run(scene.setup, {}, nobody).stages[1].damage.displacement_max;
  EXPECT_GT(at_once, 1e-5);
  EXPECT_NEAR(in_parts / at_once, 1.0, 0.05);
}

// In a lake it falls as its weight under water makes it: joints that open are full of the lake.
TEST(Water, StaysInJointsThatOpenIntoIt) {
  Scene scene = wet_roof();
  scene.setup.stages = {stage("fall", record::StageKind::rest, 0.2)};
  record::RunObserver nobody;
  const record::RunRecord record = run(scene.setup, {}, nobody);
  EXPECT_EQ(record.water->drained, 0.0);
  EXPECT_NEAR(record.energy.kinetic / (0.5 * 2600.0 * 3.0 * std::pow(0.2 * g * 1.6 / 2.6, 2)), 1.0, 0.02);
  EXPECT_LT(record.energy.residual_ratio, 1e-6);
}

// A slope 5 % beyond its limit, with a joint for a tension crack, slides on as the crack opens.
TEST(Water, StaysInTheCrackOfASlope) {
  Scene scene(5e10, 57.8, 26e3 / g);
  const double x = 12.0 / std::tan(75.0 * degree) + 3.0, y = x * std::tan(30.0 * degree);
  scene.add({{0.0, -10.0}, {36.0, -10.0}, {36.0, 12.0}, {x, 12.0}, {x, y}, {0.0, 0.0}}, true);
  scene.add({{0.0, 0.0}, {x, y}, {x, 12.0}, {x - 3.0, 12.0}});
  scene.setup.waters = {{"full", loading::WaterTable({{0.0, 0.0}, {x, 12.0}}), 1000.0, {}}};
  scene.setup.time_step = 0.005;
  scene.setup.stages = {stage("slide", record::StageKind::rest, 2.0)};
  record::RunObserver nobody;
  const record::RunRecord record = run(scene.setup, {}, nobody);
  EXPECT_EQ(record.water->drained, 0.0);
  EXPECT_GT(record.stages[0].damage.displacement_max, 0.3);
}

// Above a drained opening it falls with g.
TEST(Water, LeavesJointsThatOpen) {
  Scene scene = wet_roof();
  scene.rectangle({-0.5, 2.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({-1.0, -1.0}, 2.0, 1.0);
  scene.setup.system.blocks[4].excavations = {0};
  scene.setup.excavations.push_back({"below", {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 0.0}, {-1.0, 0.0}}});
  scene.setup.stages = {stage("open", record::StageKind::settle),
                        stage("fall", record::StageKind::rest, 0.2)};
  scene.setup.stages[0].excavate = {0};
  record::RunObserver nobody;
  const record::RunRecord record = run(scene.setup, {}, nobody);
  EXPECT_GT(record.water->drained, 2.0 * std::sqrt(4.25));
  EXPECT_NEAR(record.energy.kinetic / (0.5 * 2600.0 * 3.0 * std::pow(0.2 * g, 2)), 1.0,
              0.05);  // wet, it would be 25
  EXPECT_LT(record.energy.residual_ratio, 1e-6);
}

// The heel of a wall lifts off. Its face had a corner there, and no joint.
TEST(Water, StaysAgainstAWallThatRocks) {
  Scene scene(1e9, 60.0);
  scene.rectangle({-10.0, -1.0}, 20.0, 1.0, 0.0, true);
  scene.rectangle({}, 2.0, 4.0);
  scene.setup.waters = {{"lake", loading::WaterTable({{0.0, 3.0}, {2.0, 0.0}}), 1000.0, {}}};
  scene.setup.properties[1].spin = -0.4;
  scene.setup.time_step = 0.002;
  scene.setup.stages = {stage("rock", record::StageKind::rest, 0.1)};
  record::RunObserver nobody;
  const record::RunRecord record = run(scene.setup, {}, nobody);
  EXPECT_EQ(record.water->drained, 0.0);
  EXPECT_NEAR(force_on(record, "water.b1").x / (0.5 * 1000.0 * g * 9.0), 1.0, 0.05);
  EXPECT_LT(record.energy.residual_ratio, 1e-3);
}

// Straight along each piece of an edge, and not along the edge.
TEST(Water, HasTheSameForceForAnyNumberOfContacts) {
  for (const int contacts : {2, 3, 4, 9}) {
    Scene scene(1e12, 60.0);
    scene.rectangle({-10.0, -1.0}, 20.0, 1.0, 0.0, true);
    scene.rectangle({}, 2.0, 4.0);
    scene.setup.waters = {{"lake", loading::WaterTable({{0.0, 2.0}, {1.0, 0.0}}), 1000.0, {}}};
    scene.setup.solver.face_contacts = contacts;
    scene.setup.time_step = 0.002;
    scene.setup.stages = {settles("stand")};
    record::RunObserver nobody;
    const Vec2 force = force_on(run(scene.setup, {}, nobody), "water.b1");
    EXPECT_NEAR(force.x / (0.5 * 1000.0 * g * 4.0), 1.0, 1e-4) << contacts;
    EXPECT_NEAR(force.y / (0.5 * 1000.0 * g * 2.0), 1.0, 1e-4) << contacts;
  }
}

TEST(Water, StagesChoose) {
  Scene scene = wet_blocks();
  scene.setup.waters.push_back(level_at("low", 2.0));
  scene.setup.stages = {settles("first"), settles("none"), settles("still none"), settles("low")};
  scene.setup.stages[1].water = -1;
  scene.setup.stages[3].water = 1;
  EXPECT_EQ(water_in(scene.setup, 0), 0);
  EXPECT_EQ(water_in(scene.setup, 2), -1);
  record::RunObserver nobody;
  const record::RunRecord record = run(scene.setup, {}, nobody);
  ASSERT_TRUE(record.water);
  EXPECT_EQ(record.water->name, "low");
  EXPECT_NEAR(record.water->largest_pressure, 1000.0 * g * 2.0, 1e-6);
  scene.setup.stages.resize(3);
  EXPECT_FALSE(run(scene.setup, {}, nobody).water);
}

TEST(Water, HasTheSameBitsForAnyThreadsAndAfterResuming) {
  Scene scene = wet_roof();
  scene.setup.stages = {stage("fall", record::StageKind::rest, 0.1),
                        stage("fall on", record::StageKind::rest, 0.1)};
  record::RunObserver nobody;
  const std::string hash = run(scene.setup, {}, nobody).state_hash;
  RunOptions options;
  options.threads = 3;
  EXPECT_EQ(run(scene.setup, options, nobody).state_hash, hash);
  Stopper after(60);
  EXPECT_EQ(resumed_run(scene.setup, after).state_hash, hash);
}

}  // namespace
}  // namespace keyblock::simulation
