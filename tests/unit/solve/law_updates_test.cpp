#include "solve/law_updates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../one_step.h"
#include "solve/open_close.h"

namespace keyblock::dynamics {
namespace {

using simulation::Scene;
using simulation::Simulator;

/// A block of 1 m × 0.5 m on a floor.
Scene block_on_floor(double cohesion = 0.0, double tension = 0.0) {
  Scene scene(1e9, 30.0);
  scene.setup.joints.standard.cohesion = cohesion;
  scene.setup.joints.standard.tension = tension;
  scene.rectangle({-2.0, -1.0}, 6.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  return scene;
}

/// The next step of a scene, solved with laws as they are at its start.
struct Solved {
  explicit Solved(Simulator& s)
      : solver(linalg::make_block_cholesky(linalg::Precision::full)), step(s, *solver) {
    laws.begin();
    minimize();
  }
  void minimize() {
    const StepSystem system = step.system();
    const double enough = 1e-6 * system.options.tolerance;
    StepMatrix matrix;
    Newton newton;
    newton.begin(system);
    step.iterate.place(system);
    step.iterate.find_gradient(system);
    for (int k = 0; k < 60 && step.iterate.out_of_balance(system) > enough; ++k) {
      matrix.assemble(system);
      if (!solver->factor() || !newton.solve(system, step.iterate, true, step.result)) break;
      if (!newton.go_along(system, step.iterate, enough, true, step.result)) break;
    }
  }
  [[nodiscard]] SpringArray& springs() { return step.problem.springs(); }

  std::unique_ptr<linalg::BlockSolver> solver;
  OneStep step;
  LawUpdates laws;
};

/// N, how far the bounds of all contacts are from those of the normal forces at hand.
double bound_error(Solved& solved) {
  double error = 0.0;
  for (std::size_t c = 0; c < solved.step.contacts.size(); ++c)
    error += std::abs(solved.springs().bound[c] - solved.springs().strength(c, solved.springs().bearing(c)));
  return error;
}

TEST(LawUpdates, BringBoundsToTheNormalForcesOfTheStep) {
  Simulator s(block_on_floor());
  s.run(0.1, 0.005);
  s.state.velocity[s.model.blocks[1].first] += 0.5;
  Solved solved(s);
  for (std::size_t c = 0; c < solved.springs().size(); ++c)
    solved.springs().set_bound(c,
                               0.5 * solved.springs().bound[c]);  // as if the block had weighed half as much
  solved.minimize();
  const double weight = 2600.0 * 0.5 * simulation::g;
  ASSERT_GT(bound_error(solved), 0.1 * weight);
  int updates = 0;
  while (updates < 20 && solved.laws.update_bounds(solved.step.system(), solved.step.iterate, 1e-6)) {
    solved.minimize();
    ++updates;
  }
  EXPECT_GT(updates, 0);
  EXPECT_LT(updates, 20);
  EXPECT_LT(bound_error(solved), 1e-5 * weight);
}

TEST(LawUpdates, LeaveBoundsThatFit) {
  Simulator s(block_on_floor());
  s.run(0.5, 0.005);
  Solved solved(s);
  EXPECT_FALSE(solved.laws.update_bounds(solved.step.system(), solved.step.iterate, 1e-3));
}

TEST(LawUpdates, BreakBondsThatArePulledBeyondTheirTension) {
  for (const auto& [speed, breaks] : {std::pair{0.001, false}, {1.0, true}}) {  // m/s, upwards
    Simulator s(block_on_floor(1e6, 1e5));
    s.run(0.05, 0.005);
    s.state.velocity[s.model.blocks[1].first + 1] += speed;
    Solved solved(s);
    ASSERT_TRUE(solved.step.problem.facts().may_break);
    EXPECT_EQ(solved.laws.break_bonds(solved.step.system(), solved.step.iterate), breaks) << speed;
    for (std::size_t c = 0; c < solved.step.contacts.size(); ++c) {
      EXPECT_EQ(solved.step.contacts[c].memory.bonded, !breaks) << speed;
      EXPECT_EQ(solved.springs().is_tensile(c), !breaks) << speed;
    }
    EXPECT_FALSE(breaks && solved.laws.break_bonds(solved.step.system(), solved.step.iterate));
  }
}

// A bond that slips has nothing left of its cohesion, or what its joint keeps.
TEST(LawUpdates, BreakBondsThatAreSheared) {
  for (const bool keeps : {false, true}) {
    Scene scene = block_on_floor(1e4);
    if (keeps) scene.setup.joints.standard.residual = contact::JointProperties::Residual{20.0, 4e3, 0.0};
    Simulator s(scene);
    s.run(0.05, 0.005);
    s.state.velocity[s.model.blocks[1].first] += 2.0;
    Solved solved(s);
    ASSERT_TRUE(solved.laws.break_bonds(solved.step.system(), solved.step.iterate));
    for (std::size_t c = 0; c < solved.step.contacts.size(); ++c) {
      const contact::Contact& contact = solved.step.contacts[c];
      EXPECT_EQ(contact.memory.bonded, keeps);
      EXPECT_NEAR(solved.springs().constant[c], keeps ? 4e3 * contact.length : 0.0, 1e-6);
      EXPECT_NEAR(solved.springs().friction[c], std::tan((keeps ? 20.0 : 30.0) * simulation::degree), 1e-12);
    }
    EXPECT_FALSE(solved.laws.break_bonds(solved.step.system(), solved.step.iterate));
  }
}

/// A block on an incline of so many degrees, friction 30°.
Scene incline(double angle) {
  Scene scene(1e9, 30.0);
  const Vec2 along = simulation::direction(angle), up{-along.y, along.x};
  scene.rectangle(-20.0 * along - up, 40.0, 1.0, angle, true);
  scene.rectangle({}, 1.0, 0.5, angle);
  return scene;
}

/// It slides up until it comes to rest in the next step.
struct SlidingUp : Simulator {
  explicit SlidingUp(double angle) : Simulator(incline(angle)) {
    const Vec2 along = simulation::direction(angle);
    const Block& block = model.blocks[1];
    state.velocity[block.first] = std::sqrt(block.area) * along.x;
    state.velocity[block.first + 1] = std::sqrt(block.area) * along.y;
    for (int k = 0; k < 1000 && dot(velocity(1), along) > 0.03; ++k) run(0.002, 0.002);
  }
};

// On a slope that is steeper than friction a block that comes to rest slides back at once: its springs hold from the start of the step,
// so that friction turns with it. On a flat one it stays where its velocity ends.
TEST(LawUpdates, TurnSpringsOfBlocksThatDoNotStayWhereTheyComeToRest) {
  for (const auto& [angle, turns] : {std::pair{45.0, true}, {5.0, false}}) {
    SlidingUp s(angle);
    Solved solved(s);
    ASSERT_NE(solved.springs().slipped[0], 0.0) << angle;
    EXPECT_EQ(solved.laws.reverse_sliding(solved.step.system(), solved.step.iterate, 1e-3), turns) << angle;
    for (std::size_t c = 0; c < solved.step.contacts.size(); ++c)
      EXPECT_EQ(solved.springs().slipped[c] == 0.0, turns) << angle;
  }
}

}  // namespace
}  // namespace keyblock::dynamics
