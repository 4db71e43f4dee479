#include "contact/law.h"

#include <gtest/gtest.h>

#include <random>

namespace keyblock::contact {
namespace {

std::vector<Spring::Constants> constants() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Spring::Constants> all;
  for (int k = 0; k < 64; ++k) {
    all.push_back({2.0 + uniform(random), 1.5 + uniform(random), k % 3 == 0 ? 0.0 : 0.5,
                   k % 3 == 0 ? 0.0 : 0.3, uniform(random), 0.2 * uniform(random), k % 5 == 0 ? 0.0 : 0.4,
                   k % 7 == 0});
  }
  return all;
}

std::vector<Spring> springs() {
  std::vector<Spring> all;
  for (const Spring::Constants& c : constants()) all.emplace_back(c);
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
        // Slip that the stretch does not have takes its share of the work.
        for (const double slipped : {-0.3, 0.2}) {
          const Spring::Balance more = s.balance(y, w, slipped);
          EXPECT_GE(more.friction, b.friction);
          EXPECT_NEAR(more.friction + more.numerical, b.friction + b.numerical + s.shear_force(w) * slipped,
                      1e-12);
        }
      }
    }
  }
}

TEST(Spring, SeveralAtOnceAreThoseOneByOne) {
  const std::vector<Spring::Constants> all = constants();
  for (std::size_t first = 0; first < all.size(); first += lane_count) {
    SpringLanes::Constants together;
    for (int k = 0; k < lane_count; ++k) {
      const Spring::Constants& c = all[first + static_cast<std::size_t>(k)];
      together.normal_stiffness[k] = c.normal_stiffness;
      together.shear_stiffness[k] = c.shear_stiffness;
      together.normal_damping[k] = c.normal_damping;
      together.shear_damping[k] = c.shear_damping;
      together.depth[k] = c.depth;
      together.shear[k] = c.shear;
      together.bound[k] = c.bound;
      together.tensile[k] = c.tensile ? -1 : 0;
    }
    const SpringLanes springs(together);
    for (double y : {-0.7, 0.2}) {
      for (double w : {-0.8, 0.05}) {
        const SpringLanes::Balance balance = springs.balance(broadcast(y), broadcast(w));
        for (int k = 0; k < lane_count; ++k) {
          const Spring one(all[first + static_cast<std::size_t>(k)]);
          const Spring::Balance of_one = one.balance(y, w);
          EXPECT_EQ(springs.normal_force(broadcast(y))[k], one.normal_force(y));
          EXPECT_EQ(springs.shear_force(broadcast(w))[k], one.shear_force(w));
          EXPECT_EQ(springs.closed(broadcast(y))[k] != 0, one.closed(y));
          EXPECT_EQ(springs.locked(broadcast(w))[k] != 0, one.locked(w));
          EXPECT_EQ(balance.stored[k], of_one.stored);
          EXPECT_EQ(balance.friction[k], of_one.friction);
          EXPECT_EQ(balance.damping[k], of_one.damping);
          EXPECT_EQ(balance.numerical[k], of_one.numerical);
        }
      }
    }
  }
}

}  // namespace
}  // namespace keyblock::contact
