#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <utility>

#include "../scene.h"
#include "core/index.h"
#include "overlap/overlap.h"
#include "simulation/damage.h"

namespace keyblock::simulation {
namespace {

/// Largest speed upwards after the first landing over the speed of impact, of a block dropped on a floor from many heights,
/// so that it meets the floor at many moments of a step.
double largest_rebound(double restitution) {
  double largest = 0.0;
  for (int k = 0; k < 12; ++k) {
    Scene scene(3e9, 30.0);
    scene.setup.solver.restitution = restitution;
    scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
    scene.rectangle({0.0, 1.0 + 0.003 * k}, 0.1, 0.1);
    Simulator s(scene);
    double fastest_down = 0.0, fastest_up = 0.0;
    for (int step = 0; step < 240; ++step) {
      s.run(0.002, 0.002);
      fastest_down = std::max(fastest_down, -s.velocity(1).y);
      fastest_up = std::max(fastest_up, s.velocity(1).y);
    }
    EXPECT_NEAR(fastest_down, std::sqrt(2.0 * 9.81 * (1.0 + 0.003 * k)), 0.05);
    EXPECT_LT(std::abs(s.residual()), 1e-3 * 26.0 * 9.81);
    largest = std::max(largest, fastest_up / fastest_down);
  }
  return largest;
}

TEST(Impact, ReboundsUpToTheRestitutionWhereTheStepDoesNotResolveIt) {
  EXPECT_LT(largest_rebound(0.5), 0.5);
  EXPECT_LT(largest_rebound(0.2), 0.2);
  EXPECT_GT(largest_rebound(1.0), 0.6);  // Shi's rule alone: by the moment within the step
}

/// What remains of the approach of two blocks, which meet at some moment of a step without gravity; and the share of momentum that is lost.
std::pair<double, double> part(double restitution, double young, double step, double gap) {
  Scene scene(young, 30.0);
  scene.setup.gravity = {0.0, 0.0};
  scene.setup.solver.restitution = restitution;
  scene.setup.solver.keeps_restitution = true;
  scene.rectangle({-1.0, 0.0}, 1.0, 1.0);
  scene.rectangle({gap, 0.25}, 0.5, 0.5);
  scene.setup.properties[0].velocity = {2.0, 0.0};
  scene.setup.properties[1].velocity = {-3.0, 0.0};
  Simulator s(scene);
  s.run(gap / 5.0 + 6.0 * step, step);
  const double momentum = s.velocity(0).x + 0.25 * s.velocity(1).x;
  EXPECT_LT(std::abs(s.residual()), 1e-3 * dynamics::kinetic_energy(s.model, s.state) + 1e-3 * 2600.0);
  return {(s.velocity(1).x - s.velocity(0).x) / 5.0, momentum / (2.0 - 0.75) - 1.0};
}

// Known: Newton's law of impact, and the balance of momentum. At any moment of the step, for soft and stiff blocks.
TEST(Impact, PartsWithTheRestitutionThatIsGiven) {
  for (const double e : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    for (const double step : {0.0002, 0.001, 0.002, 0.005}) {
      for (const double moment : {0.02, 0.3, 0.55, 0.97}) {
        for (const double young : {1e8, 5e10}) {
          const auto [parts, lost] = part(e, young, step, 5.0 * step * (3.0 + moment));
          EXPECT_NEAR(parts, e, 0.01) << step << ' ' << moment << ' ' << young;
          EXPECT_NEAR(lost, 0.0, 1e-6);
        }
      }
    }
  }
}

// Without gravity there is no weight that a speed could be measured by; the fastest block is the measure.
TEST(Impact, ReboundsUpToTheRestitutionWithoutGravity) {
  for (const double speed : {0.01, 5.0}) {
    for (int k = 0; k < 12; ++k) {
      Scene scene(3e9, 30.0);
      scene.setup.gravity = {0.0, 0.0};
      scene.setup.solver.restitution = 0.2;
      scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
      const int stone = scene.rectangle({0.0, 0.05 + 0.1 * speed * 0.002 * k}, 0.1, 0.1);
      scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {0.0, -speed};
      Simulator s(scene);
      double fastest_up = 0.0;
      for (int step = 0; step < 50 + static_cast<int>(0.05 / speed / 0.002); ++step) {
        s.run(0.002, 0.002);
        fastest_up = std::max(fastest_up, s.velocity(1).y);
      }
      EXPECT_LE(fastest_up, 0.2 * speed) << speed << ' ' << k;
      EXPECT_LT(std::abs(s.velocity(1).y), speed) << "it meets the floor";
    }
  }
}

// Corners of spinning blocks leave the straight way within a step, and edges turn away below them. Whatever is missed there
// would be found as penetration, and thrown out, in the next step.
TEST(Impact, SpinningBlocksGainNoEnergy) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < 40; ++k) {
    Scene scene(3e9, 35.0);
    scene.setup.gravity = {0.0, 0.0};
    for (const double side : {-1.0, 1.0}) {
      const int b = scene.rectangle({0.11 * side, 0.03 * uniform(random)}, 0.1, 0.06, 90.0 * uniform(random));
      BlockProperties& properties = scene.setup.properties[static_cast<std::size_t>(b)];
      properties.velocity = {-3.0 * side, uniform(random)};
      properties.spin = 150.0 * uniform(random);
    }
    Simulator s(scene);
    const double start = s.energy();
    s.run(0.2, 0.002);
    EXPECT_EQ(s.unconverged, 0) << k;
    EXPECT_LT(s.energy(), 1.001 * start) << k;
    EXPECT_LT(std::abs(s.residual()), 0.03 * start) << k;
  }
}

/// m, of the contact that penetrates most, by the geometry as it is; negative: none does.
double depth_by_geometry(Simulator& s) {
  double depth = -HUGE_VAL;
  for (const contact::Contact& c : s.stepper.find_contacts(s.state)) depth = std::max(depth, -c.gap);
  return depth;
}

// A pole that falls over its corner turns by 0.04 rad a step in the end, and the corner leaves the straight way that the step is linear in by
// 0.4 mm. Contacts know the gap that this leaves at the end of the step, which is not cut, and the pole falls as one on a hinge does, whether
// the floor stands still or is lifted.
TEST(Turn, IsKnownToContactsAtTheEndOfTheStep) {
  const double height = 1.0, width = 0.1, dt = 0.01;
  for (const double lift : {0.0, 0.5}) {  // m/s
    Scene scene(3e9, 80.0);
    scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
    scene.rectangle({0.0, 0.0}, width, height);
    scene.setup.properties[0].motion_y = loading::TimeTable({{0.0, 0.0}, {10.0, 10.0 * lift}});
    scene.setup.properties[1].velocity = {-0.5 * height, lift + 0.5 * width};
    scene.setup.properties[1].spin = 1.0;  // rad/s, about the corner at the origin
    Simulator s(scene);
    const double tolerance = 5e-5 * s.model.block_size, radius = 0.5 * std::hypot(height, width);
    int pressed = 0;
    double angle = 0.0, missed = 0.0, largest_error = 0.0;
    while (angle < 1.2) {
      const dynamics::StepReport report = s.stepper.advance(s.state, dt, nullptr);
      const double w = s.spin(1);
      EXPECT_EQ(report.substeps, 1) << angle;
      if (report.penetration > 0.0) {
        ++pressed;
        EXPECT_LT(std::abs(report.penetration - depth_by_geometry(s)), tolerance) << angle;
      }
      angle += w * dt;
      missed = std::max(missed, 0.5 * w * w * dt * dt * radius);
      // Hinged: ½ I (w² − w₀²) = m g (fall of the centroid), I = (4/3) m radius².
      const double fall = 0.5 * height - (s.centroid(1).y - lift * s.state.time),
                   expected = std::sqrt(1.0 + 1.5 * g * fall / (radius * radius));
      largest_error = std::max(largest_error, std::abs(w / expected - 1.0));
    }
    EXPECT_GT(pressed, 30);
    EXPECT_GT(missed, 10.0 * tolerance);
    EXPECT_LT(largest_error,
              0.025);  // by the length of the step: a third to three fifths of it with half the step
    EXPECT_LT(std::abs(s.residual()), 1e-3 * dynamics::kinetic_energy(s.model, s.state));
  }
}

/// Blocks of 1 m that are bonded into one body, in the same rotation about the origin, 10 kPa of stress or so.
Simulator spinning_body(std::span<const Vec2> corners, double spin, double strength, int order) {
  Scene scene(1e10, 30.0, 2500.0);
  scene.setup.gravity = {0.0, 0.0};
  scene.setup.joints.standard.cohesion = scene.setup.joints.standard.tension = strength;
  for (const Vec2 corner : corners) {
    const Vec2 centre = corner + Vec2{0.5, 0.5};
    BlockProperties& properties =
        scene.setup.properties[at(scene.rectangle(corner, 1.0, 1.0, 0.0, false, order))];
    properties.velocity = spin * Vec2{-centre.y, centre.x};
    properties.spin = spin;
  }
  return Simulator(scene);
}

// Two blocks with half of a face in common: each step turns what the joint has beside its middle, always the same way.
TEST(Turn, BondedBlocksDoNotCreep) {
  for (const int order : {1, 3}) {
    const Vec2 corners[] = {{-1.0, -0.75}, {0.0, -0.25}};
    Simulator s = spinning_body(corners, 2.0 * std::numbers::pi, 1e9, order);
    const double start = s.energy();
    s.run(2.0, 0.001);
    const Vec2 apart = s.centroid(1) - s.centroid(0);
    EXPECT_NEAR(norm(apart), std::hypot(1.0, 0.5), 5e-5) << order;
    EXPECT_LT(std::abs(s.residual()), 0.02 * start) << order;
    for (const contact::Memory& memory : s.state.contacts.memory) EXPECT_TRUE(memory.bonded);
  }
}

// Bonds of four blocks in which joints do not cross carry 11 kPa: creep along one joint would tear another.
TEST(Turn, ABodyOfBondedBlocksStaysWhole) {
  const Vec2 corners[] = {{-1.0, -1.0}, {0.0, -1.0}, {-0.75, 0.0}, {0.25, 0.0}};
  Simulator s = spinning_body(corners, 3.0, 1e5, 1);
  s.run(3.0, 0.002);
  for (const contact::Memory& memory : s.state.contacts.memory) EXPECT_TRUE(memory.bonded);
  for (const dynamics::ContactForce& force : s.stepper.forces()) EXPECT_LT(std::abs(force.normal), 2e4);
}

// The same pole in steps of 0.06 s, which are cut where it turns by too much. One in which it does so only in its second half is cut there
// alone.
TEST(Turn, CutsOnlyThePartsOfAStepThatAreTooLong) {
  Scene scene(3e9, 80.0);
  scene.rectangle({-1.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 0.1, 1.0);
  scene.setup.properties[1].velocity = {-0.5, 0.05};
  scene.setup.properties[1].spin = 1.0;  // rad/s, about the corner at the origin
  Simulator s(scene);
  const double dt = 0.06;
  int cut_in_three = 0;
  for (int step = 0; step < 13; ++step) {
    const dynamics::StepReport report = s.stepper.advance(s.state, dt, nullptr);
    // Parts of dt/2, of dt/2 and twice dt/4, or more of them.
    if (report.substeps <= 3) {
      EXPECT_EQ(report.shortest, report.substeps == 3 ? dt / 4.0 : dt / report.substeps);
    }
    cut_in_three += report.substeps == 3;
  }
  EXPECT_GE(cut_in_three, 1);
}

/// m, true overlap of the stone, block 2, with its bed, block 1.
double overlap_with_bed(const Simulator& s) {
  const std::vector<Polygon> two{deformed_polygon(s.model, 1), deformed_polygon(s.model, 2)};
  return overlap::largest_overlap(two).depth;
}

// A slender stone that strikes with one corner turns by 20° a step: the corner that comes next is not the nearest when the step
// begins. It used to go through the bed.
// A corner that presses is held however deep soft joints let it in, and comes back out.
TEST(Impact, SoftJointsHoldWhatFalls) {
  for (const double stiffness : {3e8, 1e9, 1e10}) {
    for (const double turned : {0.0, 10.0, 45.0}) {
      for (const double dt : {0.002, 0.0005}) {
        Scene scene(1e10, 30.0);
        scene.setup.joints.standard.normal_stiffness = stiffness;
        scene.rectangle({-20.0, -3.0}, 40.0, 3.0, 0.0, true);
        const int block = scene.rectangle({0.0, 1.6}, 1.0, 1.0, turned);
        Simulator s(scene);
        s.run(1.5, dt);
        EXPECT_GT(s.centroid(block).y, 0.3) << stiffness << ", " << turned << ", " << dt;
        EXPECT_LT(s.centroid(block).y, 2.0) << stiffness << ", " << turned << ", " << dt;
      }
    }
  }
}

TEST(Impact, CornersOfSpinningStonesDoNotGoThrough) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  double fastest = 0.0;
  for (int k = 0; k < 60; ++k) {
    Scene scene(3e9, 39.0, 2270.0);
    scene.rectangle({-1.2, -1.0}, 2.4, 0.4, 0.0, true);
    scene.add({{-1.0, -0.6},
               {1.0, -0.6},
               {1.0, 0.35},
               {0.5, 0.09},
               {0.17, 0.01},
               {-0.17, 0.01},
               {-0.5, 0.09},
               {-1.0, 0.35}});
    const double angle = 40.0 * uniform(random);
    const int stone = scene.rectangle({0.3 * uniform(random), 0.3 + 0.01 * uniform(random)}, 0.13,
                                      0.02 + 0.01 * uniform(random), angle);
    BlockProperties& properties = scene.setup.properties[static_cast<std::size_t>(stone)];
    properties.velocity = {uniform(random), -10.0};
    properties.spin = 10.0 * uniform(random);
    Simulator s(scene);
    for (int step = 0; step < 80; ++step) {
      s.run(0.002, 0.002);
      fastest = std::max(fastest, std::abs(s.spin(stone)));
      ASSERT_LT(overlap_with_bed(s), 5e-4) << "stone " << k << ", step " << step;
    }
    EXPECT_EQ(s.unconverged, 0) << k;
  }
  EXPECT_GT(fastest, 100.0);  // rad/s
}

/// What becomes of a sharp corner that slides at 4 m/s over the joint between two blocks of one flush face.
struct Slide {
  double overlap = 0.0;       ///< m, the largest there was
  double slowest = HUGE_VAL;  ///< m/s, along the face
};

/// ahead: m, from the tip to the joint at the start; opening: degrees, between the lower side of the wedge and the face. Either the
/// wedge moves or the face does.
Slide slide_over_joint(double ahead, double opening, bool face_moves) {
  const double speed = 4.0;  // m/s
  Scene scene(3e9, 0.0, 2270.0);
  for (const double left : {-1.0, 0.0}) {
    const int bed = scene.rectangle({left, -1.0}, 1.0, 1.0, 0.0, true);
    if (face_moves) {
      scene.setup.properties[static_cast<std::size_t>(bed)].motion_x =
          loading::TimeTable({{0.0, 0.0}, {1.0, -speed}});
    }
  }
  const auto from_tip = [&](double length, double angle) {
    return Vec2{-ahead, 1e-6} + length * Vec2{-std::cos(angle * degree), std::sin(angle * degree)};
  };
  const int wedge = scene.add({from_tip(0.0, 0.0), from_tip(0.25, opening + 34.0), from_tip(0.4, opening)});
  if (!face_moves) scene.setup.properties[static_cast<std::size_t>(wedge)].velocity = {speed, 0.0};
  Simulator s(scene);
  Slide slide;
  for (int step = 0; step < 8; ++step) {
    s.run(0.002, 0.002);
    for (int bed = 0; bed < 2; ++bed) {
      const std::vector<Polygon> two{deformed_polygon(s.model, static_cast<std::size_t>(bed)),
                                     deformed_polygon(s.model, static_cast<std::size_t>(wedge))};
      slide.overlap = std::max(slide.overlap, overlap::largest_overlap(two).depth);
    }
    slide.slowest = std::min(slide.slowest, s.velocity(wedge).x + (face_moves ? speed : 0.0));
  }
  return slide;
}

// Where the blocks of a face meet, the line that a fast corner meets next is that of the other block's face, and not its side.
TEST(Impact, FastCornersSlideOverFlushJoints) {
  for (const bool face_moves : {false, true}) {
    for (const double opening : {1.0, 5.0, 20.0}) {
      for (int k = 0; k < 32; ++k) {
        const double ahead = 0.02 + 0.00025 * k;
        const Slide slide = slide_over_joint(ahead, opening, face_moves);
        EXPECT_LT(slide.overlap, 2e-4) << opening << " " << ahead << " " << face_moves;
        EXPECT_GT(slide.slowest, 3.99) << opening << " " << ahead << " " << face_moves;
      }
    }
  }
}

// Blocks that may move far in a step have corners meet that are far apart, and the lines of faces that come down flat are as good as one:
// only one end of what they share was held.
TEST(Impact, FacesThatComeDownFastAreHeldAtBothEnds) {
  for (const double shared : {0.016, 0.03, 0.05}) {
    for (const double speed : {6.0, 9.0, 12.0}) {
      for (const double aside : {-0.3, 0.0, 0.3}) {
        for (const double above : {0.006, 0.010, 0.014, 0.018}) {
          Scene scene(3e9, 0.0);
          scene.rectangle({0.0, -1.0}, 1.0, 1.0, 0.0, true);
          scene.rectangle({10.0, 10.0}, 0.9, 0.9);  // for the lengths of contact
          const Vec2 corner{shared, above};
          const int stone = scene.add(
              {corner, corner + Vec2{0.1, 0.2}, corner + Vec2{-0.2, 0.2}, corner + Vec2{-0.3, 0.0}});
          scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {aside * speed, -speed};
          EXPECT_LT(largest_overlap_of(scene, 0.002), 0.002)
              << shared << " " << speed << " " << aside << " " << above;
        }
      }
    }
  }
}

// A stone of which a face comes down on a corner of the bed, with its tip beyond. The stone turns the tip away from the bed, so that
// the line that the tip could come to by the other turn does not keep the face out of the corner.
TEST(Impact, FacesComeDownOnCornersBesideTheTip) {
  for (int k = -7; k <= 8; ++k) {
    Scene scene(3e9, 39.0, 2270.0);
    scene.add({{0.0, 0.0}, {-0.13, -0.19}, {0.0, -0.56}, {0.95, -0.58}, {0.19, -0.143}, {0.0455, -0.0377}},
              true);
    const double shift = 0.0005 * k;
    const int stone = scene.add({{0.0098 + shift, -0.0046},
                                 {0.0343 + shift, 0.1311},
                                 {0.0475 + shift, 0.1838},
                                 {-0.1212 + shift, 0.08}});
    BlockProperties& properties = scene.setup.properties[static_cast<std::size_t>(stone)];
    properties.velocity = {2.34, -8.17};
    properties.spin = 9.8;
    Simulator s(scene);
    for (int step = 0; step < 10; ++step) {
      s.run(0.002, 0.002);
      const std::vector<Polygon> two{deformed_polygon(s.model, 0), deformed_polygon(s.model, 1)};
      const double depth = overlap::largest_overlap(two).depth;
      EXPECT_LT(depth, 3e-4) << shift << ", step " << step;
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
