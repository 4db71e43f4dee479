// Stones that roll while they are pressed deep into soft joints.
#include <gtest/gtest.h>

#include <cmath>

#include "../scene.h"

namespace keyblock::simulation {
namespace {

constexpr double stiffness = 1.75e8;  // Pa/m

/// A stone with so many corners, about 1 m wide, that comes down on a floor of 2 m with 8 m/s, moves along it and spins.
struct Stone {
  Stone(int corners, int order, double spin) : scene(1e9, 20.0, 3000.0) {
    scene.setup.joints.standard.normal_stiffness = stiffness;
    scene.rectangle({-30.0, -2.0}, 60.0, 2.0, 0.0, true);
    Ring ring;
    for (int k = 0; k < corners; ++k)
      ring.push_back(Vec2{0.0, 0.7} + 0.55 * direction(360.0 / corners * (k + 0.3)));
    scene.add(ring, false, order);
    scene.setup.properties.back().velocity = {-6.0, -8.0};
    scene.setup.properties.back().spin = spin;
  }
  Scene scene;
};

struct Rolled {
  double lowest = HUGE_VAL, deepest = 0.0;  // m
  long across_gaps = 0, unconverged = 0;
  double residual = 0.0;  // over the energy at the start
};

Rolled roll(const Scene& scene, double dt) {
  Simulator s(scene);
  Rolled rolled;
  for (int k = 0; k < std::lround(2.0 / dt); ++k) {
    const dynamics::StepReport report = s.stepper.advance(s.state, dt, nullptr);
    rolled.lowest = std::min(rolled.lowest, s.centroid(1).y);
    rolled.deepest = std::max(rolled.deepest, report.audit.deepest.distance);
    rolled.across_gaps += report.audit.across_gaps;
    rolled.unconverged += !report.converged;
  }
  rolled.residual = std::abs(s.residual()) / s.initial_energy;
  return rolled;
}

/// A corner has the least length of joint of a contact. The spring takes what falls with the stone: half k x² = half m v² + m g x.
double explained(const Simulator& s, double speed) {
  const double mass = 3000.0 * s.model.blocks[1].area,
               k = stiffness * contact::Tolerances(s.model.block_size).least_length, weight = mass * g / k;
  return weight + std::sqrt(weight * weight + mass * speed * speed / k);
}

TEST(Rolling, StonesDoNotPassAFloorOnSoftJoints) {
  for (const int corners : {3, 4, 5, 6, 9}) {
    for (const int order : {1, 2}) {
      for (const double spin : {0.0, 12.0}) {
        const Stone stone(corners, order, spin);
        const double most = explained(Simulator(stone.scene), std::hypot(8.0, 0.55 * spin));
        for (const double dt : {0.01, 0.005, 0.002}) {
          SCOPED_TRACE(testing::Message()
                       << corners << " corners, order " << order << ", " << spin << " rad/s, " << dt << " s");
          const Rolled rolled = roll(stone.scene, dt);
          EXPECT_GT(rolled.lowest, 0.0);
          EXPECT_LT(rolled.deepest, most);
          EXPECT_EQ(rolled.across_gaps, 0);
          EXPECT_EQ(rolled.unconverged, 0);
          EXPECT_LT(rolled.residual, 0.01);
        }
      }
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
