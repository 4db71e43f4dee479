// Laws of joints that change between the steps of a running model.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "../scene.h"

namespace keyblock::simulation {
namespace {

/// A block of 1 m that rests on an incline of 25°, with a friction angle of 30°.
Scene resting_on_incline() {
  constexpr double alpha = 25.0;
  Scene scene(5e10, 30.0);
  const Vec2 along = direction(alpha), up{-along.y, along.x};
  const auto rectangle = [&](double from, double to, double below, double above, bool fixed) {
    scene.add({from * along + below * up, to * along + below * up, to * along + above * up,
               from * along + above * up},
              fixed);
  };
  rectangle(-20.0, 2.0, -1.0, 0.0, true);
  rectangle(0.0, 1.0, 0.0, 1.0, false);
  return scene;
}

std::vector<contact::JointLaw> laws_with(const Simulator& s, double friction, double stiffness = 1.0) {
  std::vector<contact::JointLaw> laws = s.model.laws;
  for (contact::JointLaw& law : laws) {
    law.friction_coefficient = std::tan(friction * degree);
    law.normal_stiffness *= stiffness;
  }
  return laws;
}

TEST(ChangedLaws, LetABlockSlideAsCoulombSays) {
  Simulator s(resting_on_incline());
  s.run(0.2, 0.001);
  EXPECT_LT(norm(s.velocity(1)), 1e-4);
  s.stepper.set_laws(laws_with(s, 20.0));
  s.run(0.5, 0.001);
  const double slope = 25.0 * degree,
               expected = 0.5 * g * (std::sin(slope) - std::tan(20.0 * degree) * std::cos(slope));
  EXPECT_NEAR(norm(s.velocity(1)) / expected, 1.0, 2e-3);
  s.stepper.set_laws(laws_with(s, 40.0));
  s.run(0.5, 0.001);
  EXPECT_LT(norm(s.velocity(1)), 1e-3);
  EXPECT_LT(std::abs(s.residual()), 1e-3 * s.state.ledger.friction);
}

TEST(ChangedLaws, TheSameLawsChangeNothing) {
  Simulator with(resting_on_incline()), without(resting_on_incline());
  with.run(0.05, 0.001);
  without.run(0.05, 0.001);
  with.stepper.set_laws(with.model.laws);
  without.stepper.forget_history();
  with.run(0.05, 0.001);
  without.run(0.05, 0.001);
  EXPECT_EQ(with.state.position, without.state.position);
  EXPECT_EQ(with.state.velocity, without.state.velocity);
}

TEST(ChangedLaws, SpringsThatGetSofterKeepTheirEnergy) {
  Scene scene = resting_on_incline();
  scene.setup.joints.standard.normal_stiffness = 1e10;
  Simulator s(scene);
  s.run(0.2, 0.001);
  const double stored = s.state.contact_energy;
  s.stepper.set_laws(laws_with(s, 30.0, 0.5));
  s.run(0.001, 0.001);
  EXPECT_LT(std::abs(s.residual()), 0.02 * stored);
  s.run(0.2, 0.001);
  EXPECT_LT(norm(s.velocity(1)), 1e-3);
}

TEST(ChangedLaws, AreAsManyAsBefore) {
  Simulator s(resting_on_incline());
  EXPECT_THROW(s.stepper.set_laws({}), std::invalid_argument);
}

}  // namespace
}  // namespace keyblock::simulation
