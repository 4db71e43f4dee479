// Joints whose strength falls with slip, in whole runs.
#include <gtest/gtest.h>

#include <cmath>

#include "../resumed_run.h"
#include "../scene.h"

namespace keyblock::simulation {
namespace {

/// A block on an incline of 30° that its peak strength holds, and its residual strength does not.
Scene held_by_peak_strength(double slip) {
  Scene scene(1e10, 40.0);
  scene.setup.joints.standard.residual = contact::JointProperties::Residual{20.0, 0.0, slip};
  const Vec2 along = direction(30.0), up{-along.y, along.x};
  scene.rectangle(-20.0 * along - up, 40.0, 1.0, 30.0, true);
  scene.rectangle({}, 1.0, 0.5, 30.0);
  return scene;
}

double worn(const Simulator& s) {
  double most = 0.0;
  for (const contact::JointPiece& piece : s.state.contacts.pieces) most = std::max(most, piece.worn);
  return most;
}

TEST(Weakening, PiecesAreOfJointsInPlaceAlone) {
  Scene scene = held_by_peak_strength(0.01);
  Simulator s(scene);
  EXPECT_EQ(s.state.contacts.pieces.size(), 2U);
  scene.setup.joints.standard.residual.reset();
  EXPECT_TRUE(Simulator(scene).state.contacts.pieces.empty());
}

TEST(Weakening, SlipThatDoesNotCountLeavesThePeak) {
  for (const double slip : {0.0, 0.01}) {
    for (const bool wears : {false, true}) {
      Simulator s(held_by_peak_strength(slip));
      s.model.joints_wear = wears;
      s.run(0.1, 0.005);
      const dynamics::Block& block = s.model.blocks[1];
      const Vec2 along = direction(30.0);
      for (int k = 0; k < 2; ++k)  // pushed down the slope, by more than the weakening slip
        s.state.velocity[block.first + static_cast<std::size_t>(k)] -=
            std::sqrt(block.area) * (k == 0 ? along.x : along.y);
      s.run(1.0, 0.005);
      EXPECT_EQ(worn(s) > 0.01, wears) << slip;
      EXPECT_EQ(norm(s.velocity(1)) > 0.5, wears) << slip;
    }
  }
}

// Two contacts, one at each end: the sum of |slip| of the block.
TEST(Weakening, PiecesAreWornByTheWayOfTheSlip) {
  Simulator s(held_by_peak_strength(10.0));
  s.run(0.1, 0.005);
  const Vec2 from = s.centroid(1), along = direction(30.0);
  const dynamics::Block& block = s.model.blocks[1];
  s.state.velocity[block.first] -= std::sqrt(block.area) * along.x;
  s.state.velocity[block.first + 1] -= std::sqrt(block.area) * along.y;
  s.run(1.0, 0.002);
  EXPECT_NEAR(worn(s) / norm(s.centroid(1) - from), 1.0, 1e-2);
}

// A tall block on a tilted plane whose joint has a stiffness of its own: its heel opens by millimetres, and has no cohesion there. Pressed contacts
// of the face give forces to those that are open, which are no reason to hold.
TEST(Weakening, CohesionEndsWhereAFaceHasOpened) {
  Scene scene(1e10, 15.0, 2500.0);
  scene.setup.joints.standard.cohesion = 1e5;
  scene.setup.joints.standard.residual = contact::JointProperties::Residual{15.0, 1e5, 0.0};
  scene.setup.joints.standard.normal_stiffness = 3e9;
  scene.setup.solver.face_contacts = 5;
  scene.setup.gravity = -9.81 * Vec2{-std::sin(20.0 * degree), std::cos(20.0 * degree)};
  scene.rectangle({-20.0, -1.0}, 50.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 4.0, 10.0);
  scene.setup.time_step = 0.002;
  scene.setup.stages.push_back(stage("settle", record::StageKind::settle));
  AllContacts observer;
  run(scene.setup, {}, observer);
  ASSERT_FALSE(observer.frames.empty());
  const double in_place = 1e-4 * std::sqrt(40.0);
  int open = 0;
  for (const record::ContactRecord& c : observer.frames.back().contacts) {
    if (c.gap <= in_place) continue;
    ++open;
    EXPECT_EQ(c.shear_force, 0.0) << c.position.x;
  }
  EXPECT_GT(open, 1);
}

TEST(Weakening, AResumedRunKnowsWhatIsWorn) {
  Scene scene = held_by_peak_strength(0.05);
  scene.setup.time_step = 0.005;
  scene.setup.properties[1].velocity = -0.4 * direction(30.0);
  for (const char* name : {"slide", "slide on"})
    scene.setup.stages.push_back(stage(name, record::StageKind::rest, 0.1));  // a checkpoint is at its end
  record::RunObserver nobody;
  Stopper after(25);
  EXPECT_EQ(resumed_run(scene.setup, after).state_hash, run(scene.setup, {}, nobody).state_hash);
}

}  // namespace
}  // namespace keyblock::simulation
