#include "contact/law.h"

#include <gtest/gtest.h>

#include <random>

namespace keyblock::contact {
namespace {

std::vector<Spring> springs() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Spring> all;
  for (int k = 0; k < 60; ++k) {
    all.emplace_back(Spring::Constants{2.0 + uniform(random), 1.5 + uniform(random), k % 3 == 0 ? 0.0 : 0.5,
                                       k % 3 == 0 ? 0.0 : 0.3, uniform(random), 0.2 * uniform(random),
                                       k % 5 == 0 ? 0.0 : 0.4, k % 7 == 0});
  }
  return all;
}

TEST(Spring, ForcesAreTheSlopesOfAConvexPotential) {
  const double h = 1e-6;
  for (const Spring& s : springs()) {
    for (double y : {-0.7, -0.1, 0.2, 0.9}) {
      for (double w : {-0.8, -0.05, 0.1, 0.6}) {
        EXPECT_NEAR((s.potential(y + h, w) - s.potential(y - h, w)) / (2 * h), s.normal_force(y), 1e-6);
        EXPECT_NEAR((s.potential(y, w + h) - s.potential(y, w - h)) / (2 * h), s.shear_force(w), 1e-6);
        EXPECT_GE(s.potential(y + 0.3, w - 0.2) + s.potential(y - 0.3, w + 0.2),
                  2.0 * s.potential(y, w) - 1e-12);
        EXPECT_LE(std::abs(s.shear_force(w)), s.bound() + 1e-15);
      }
    }
  }
}

TEST(Spring, EnergyIsAccountedForAndNothingIsGained) {
  for (const Spring& s : springs()) {
    for (double y : {-0.7, 0.2, 0.9}) {
      for (double w : {-0.8, 0.1, 0.6}) {
        const Spring::Balance b = s.balance(y, w);
        EXPECT_GE(b.friction, 0.0);
        EXPECT_GE(b.stored, 0.0);
        const double work = -s.normal_force(y) * (y - s.depth()) - s.shear_force(w) * (w - s.shear());
        // What was stored is given back, or is lost to friction, dashpot and the step's end-of-step forces.
        if (s.locked(s.shear())) {
          EXPECT_NEAR(s.stored_at_start(), b.stored + work + b.friction + b.damping + b.numerical, 1e-12);
        }
        EXPECT_GE(b.friction + b.damping + b.numerical, -1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace keyblock::contact
