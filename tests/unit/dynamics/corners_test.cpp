// Tips and corners that meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../scene.h"
#include "overlap/overlap.h"
#include "simulation/damage.h"

namespace keyblock::simulation {
namespace {

// A slender tip that has slid past a sharp corner, down one face or beside it, is behind the other face too, but not in contact with it;
// nor is the corner with the far side of the tip. Nothing holds the stone without friction.
TEST(Contact, TipsThatHavePassedASharpCornerAreFree) {
  struct Place {
    double below, beside;  // m, of the tip: the corner, the face
  };
  for (const double sharp : {10.0, 25.0, 40.0}) {  // degrees, of the corner
    for (const Place place :
         {Place{0.004, 1e-6}, {0.007, 1e-6}, {0.01, 1e-6}, {0.01, 0.003}, {0.003, 0.003}}) {
      Scene scene(3e9, 0.0, 2270.0);
      const auto along = [](double angle) {
        return Vec2{std::sin(angle * degree), std::cos(angle * degree)};
      };
      scene.add({{0.0, 0.0}, -1.0 * along(sharp), {0.0, -1.0}}, true);
      const Vec2 tip{place.beside, -place.below};
      const int stone = scene.add({tip, tip + 0.5 * along(12.0), tip + 0.5 * along(2.0)});
      Simulator s(scene);
      s.run(0.06, 0.002);
      EXPECT_NEAR(s.velocity(stone).y, -0.06 * g, 1e-6) << sharp << " " << place.below;
      EXPECT_NEAR(s.spin(stone), 0.0, 1e-6) << sharp << " " << place.below;
    }
  }
}

// A stone lies with its tip on a bed, 2.5 mm before the tip of another, whose line and its own are a tie. A third one strikes it: in that
// step it goes where no velocity at the beginning says, and meets the other.
TEST(Contact, TipsThatAreStruckTowardsEachOtherMeet) {
  for (int k = -5; k <= 5; ++k) {
    Scene scene(3e9, 39.0, 2270.0);
    scene.add({{-1.0, 0.0}, {-1.0, -0.5}, {1.0, -0.5}, {1.0, 0.0}}, true);
    const Vec2 other{0.0, 0.00036 + 1e-5 * k}, tip{-0.00248, 1e-6};
    scene.add({other, other + Vec2{0.251, 0.017}, other + Vec2{0.0535, 0.1347}}, true);
    scene.add({tip, tip + Vec2{-0.068, 0.1038}, tip + Vec2{-0.1329, 0.057}});
    const double face = tip.x - 0.1329 - 1e-5;
    const int striker = scene.add({{face, 0.02}, {face, 0.3}, {face - 0.3, 0.3}, {face - 0.3, 0.02}});
    scene.setup.properties[static_cast<std::size_t>(striker)].velocity = {4.0, 0.0};
    Simulator s(scene);
    double deepest = 0.0;
    for (int step = 0; step < 10; ++step) {
      s.run(0.002, 0.002);
      const std::vector<Polygon> two{deformed_polygon(s.model, 1), deformed_polygon(s.model, 2)};
      deepest = std::max(deepest, overlap::largest_overlap(two).depth);
    }
    EXPECT_LT(deepest, 5e-4) << other.y;
  }
}

// Rock comes down with its tip on a sharp corner, and is pressed in by 3 to 4 mm: nearer to the far face of the corner than to the one that
// holds it. It is not let through.
TEST(Contact, TipsPressedDeepIntoASharpCornerAreHeld) {
  for (int k = 0; k < 10; ++k) {
    Scene scene(3e8, 39.0, 2270.0);
    scene.add({{0.0, 0.0}, {0.7, -0.06}, {0.7, 0.37}}, true);
    const Vec2 tip{0.0025 + 0.0005 * k, 0.012};
    const int stone = scene.add({tip, tip + Vec2{0.4, 1.5}, tip + Vec2{-0.4, 1.5}});
    scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {0.0, -9.6};
    Simulator s(scene);
    double deepest = 0.0, last = 0.0;
    for (int step = 0; step < 40; ++step) {
      s.run(0.002, 0.002);
      const std::vector<Polygon> two{deformed_polygon(s.model, 0), deformed_polygon(s.model, 1)};
      last = overlap::largest_overlap(two).depth;
      deepest = std::max(deepest, last);
    }
    EXPECT_LT(last, 1e-4) << tip.x;
    EXPECT_LT(deepest, 5e-3) << tip.x;
  }
}

// The tip of a slab meets the corner of a stone and pushes it along a bed, both at one place on it, until the stone runs into a wall within
// a step. All the while nothing tells which side of the stone the tip will pass; it does not go through.
TEST(Contact, TipsStayOutOfCornersThatTheyPush) {
  for (int k = 0; k < 8; ++k) {
    Scene scene(3e9, 39.0, 2270.0);
    scene.add({{-1.0, 0.0}, {-1.0, -0.5}, {1.0, -0.5}, {1.0, 0.0}}, true);
    const double left = 0.0051 + 0.0005 * k;  // m, of the way to the wall
    scene.add({{0.0756 + left, 0.1}, {0.0756 + left, 1e-4}, {0.5, 1e-4}, {0.5, 0.1}}, true);
    const int slab = scene.add({{-1e-6, 1e-6}, {-0.030, 0.113}, {-0.302, 0.266}});
    const int stone = scene.add({{0.0, 1e-6}, {0.0137, 0.0072}, {0.055, 0.0313}, {0.0753, 0.0035}});
    scene.setup.solver.restitution = 0.0;
    scene.setup.properties[static_cast<std::size_t>(slab)].velocity = {2.0, 0.0};
    scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {1.8, 0.0};
    Simulator s(scene);
    for (int step = 0; step < 10; ++step) {
      s.run(0.002, 0.002);
      std::vector<Polygon> all;
      for (std::size_t block = 0; block < 4; ++block) all.push_back(deformed_polygon(s.model, block));
      EXPECT_LT(overlap::largest_overlap(all).depth, 1e-4) << left << ", step " << step;
    }
  }
}

// Of four blocks about a crossing of joints, two that lie across from each other slide past each other along one joint. The faces on the
// other joint do not catch, however far the corners have gone.
TEST(Contact, BlocksAcrossFromEachOtherSlidePastTheirCorners) {
  for (const double lean : {-20.0, 0.0, 20.0}) {               // degrees, of the joint that opens
    for (const double passed : {0.0, 0.001, 0.0025, 0.006}) {  // m
      Scene scene(3e9, 0.0, 2270.0);
      const Vec2 up{std::sin(lean * degree), std::cos(lean * degree)}, right{1.0, 0.0};
      scene.add({{0.0, 0.0}, -1.0 * up, -1.0 * up + right, right}, true);
      const Vec2 corner = -1e-5 * right - passed * up;
      const int block =
          scene.add({corner, corner + 0.5 * up, corner + 0.5 * up - 0.5 * right, corner - 0.5 * right});
      scene.setup.gravity = -9.81 * up;
      Simulator s(scene);
      s.run(0.06, 0.002);
      EXPECT_NEAR(dot(s.velocity(block), up), -0.06 * 9.81, 1e-6) << lean << " " << passed;
      EXPECT_NEAR(s.spin(block), 0.0, 1e-6) << lean << " " << passed;
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
