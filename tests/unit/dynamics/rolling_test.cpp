// Stones that roll while they are pressed deep into soft joints.
#include <gtest/gtest.h>

#include <cmath>

#include "../scene.h"
#include "dynamics/intrusions.h"

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

/// N per thickness, of all contacts that share the pressure of faces.
double force_of_faces(const contact::CandidateList& list) {
  double sum = 0.0;
  for (const contact::Memory& memory : list.memory) sum += memory.in_face ? memory.normal_force : 0.0;
  return sum;
}

/// N per thickness: how much less a vertex of the stone presses, at the end of the step or where it comes to lie, than the spring of a corner at its depth in the floor, where the step that
/// has met it may have let it in by Intrusions::most_share.
double lacking_force(const Simulator& s) {
  const contact::Surface& surface = s.model.surface;
  const contact::CandidateList& list = s.state.contacts;
  const double k = stiffness * contact::Tolerances(s.model.block_size).least_length,
               met = dynamics::Intrusions::most_share * std::sqrt(s.model.blocks[1].area);
  const double of_faces = force_of_faces(list);
  double lacking = 0.0;
  for (int v = surface.block_begin[1]; v < surface.block_begin[2]; ++v) {
    const double depth = -surface.position[at(v)].y;
    double force = 0.0;
    for (std::size_t c = 0; c < list.tracked.size(); ++c) {
      const contact::Memory& memory = list.memory[c];
      if (list.pairs[at(list.tracked[c])].vertex != v) continue;
      // Contacts beside it bear a part of what presses on it.
      force = memory.in_face ? of_faces
                             : std::max(memory.normal_force, memory.stiffness * (depth - memory.offset));
    }
    if (depth > met) lacking = std::max(lacking, k * (depth - met) - force);
  }
  return lacking;
}

struct Rolled {
  double lowest = HUGE_VAL, deepest = 0.0;  // m
  long across_gaps = 0, unconverged = 0;
  double lacking = 0.0;   // N per thickness
  double residual = 0.0;  // over the energy at the start
};

Rolled roll(const Scene& scene, double dt) {
  Simulator s(scene);
  Rolled rolled;
  for (int k = 0; k < std::lround(2.0 / dt); ++k) {
    const dynamics::StepReport report = s.stepper.advance(s.state, dt, nullptr);
    rolled.lowest = std::min(rolled.lowest, s.centroid(1).y);
    rolled.deepest = std::max(rolled.deepest, report.audit.deepest.distance);
    rolled.lacking = std::max(rolled.lacking, lacking_force(s));
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
          EXPECT_LT(rolled.lacking, 1.0);
          EXPECT_EQ(rolled.across_gaps, 0);
          EXPECT_EQ(rolled.unconverged, 0);
          EXPECT_LT(rolled.residual, 0.01);
        }
      }
    }
  }
}

// A stone of order 6 falls on one that lies on a floor: its edge comes down on a corner of the other, and each of them turns into the other.
// The corners at the ends of that edge lie in the other stone by then.
TEST(Rolling, StonesDoNotPassEachOtherOnSoftJoints) {
  for (const double dt : {0.01, 0.005, 0.002, 0.001}) {
    SCOPED_TRACE(testing::Message() << dt << " s");
    Scene scene(9.351e8, 20.0, 3243.0);
    scene.setup.joints.standard.normal_stiffness = stiffness;
    scene.rectangle({-20.0, -2.0}, 40.0, 2.0, 0.0, true);
    scene.add({{-1.4131, 0.304},
               {-1.4721, 0.4913},
               {-1.6975, 0.777},
               {-1.9264, 0.7675},
               {-2.1751, 0.6851},
               {-2.3149, 0.323},
               {-2.0041, 0.0829},
               {-1.8451, 0.0298},
               {-1.584, 0.0763}});
    scene.setup.properties.back().velocity = {1.337, 0.0312};
    scene.setup.properties.back().spin = -3.645;
    scene.add({{-1.4901, 1.1193},
               {-1.5406, 0.6687},
               {-1.3447, 0.2671},
               {-1.0323, 0.1495},
               {-0.6201, 0.102},
               {-0.3932, 0.6595},
               {-0.5504, 0.9458},
               {-0.6914, 1.293}},
              false, 6);
    scene.setup.properties.back().velocity = {-7.443, -9.387};
    scene.setup.properties.back().spin = 0.919;
    Simulator s(scene);
    double nearest = HUGE_VAL;
    long across_gaps = 0, unconverged = 0;
    for (int k = 0; k < std::lround(0.5 / dt); ++k) {
      const dynamics::StepReport report = s.stepper.advance(s.state, dt, nullptr);
      nearest = std::min(nearest, norm(s.centroid(2) - s.centroid(1)));
      across_gaps += report.audit.across_gaps;
      unconverged += !report.converged;
    }
    // They are 0.92 m apart at the start. What one corner takes of the upper stone, with the speed of both: x = v sqrt(m/k).
    const double k = stiffness * contact::Tolerances(s.model.block_size).least_length;
    EXPECT_GT(nearest, 0.92 - std::hypot(8.78, 9.418) * std::sqrt(3243.0 * s.model.blocks[2].area / k));
    EXPECT_GT(norm(s.centroid(2) - s.centroid(1)), 1.2) << "they have parted";
    EXPECT_EQ(across_gaps, 0);
    EXPECT_EQ(unconverged, 0);
  }
}

}  // namespace
}  // namespace keyblock::simulation
