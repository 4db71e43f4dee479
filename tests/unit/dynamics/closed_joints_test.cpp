#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../scene.h"

namespace keyblock::simulation {
namespace {

/// A wedge that strikes two or more blocks at their joint.
struct Strike {
  double young = 1e9;      // Pa
  double stiffness = 0.0;  // Pa/m, of joints; 0: by the solver's penalty
  double step = 0.0005;    // s
  double speed = 8.0;      // m/s
  double opening = 50.0;   // degrees, of the wedge
  double leaning = 90.0;   // degrees, of its bisector
  double way = 90.0;       // degrees, that it comes from
  Vec2 aim{};              // of its tip
};

/// Adds the wedge, block b, with its tip 30 mm off.
void add_wedge(Scene& scene, const Strike& strike) {
  const Vec2 tip = strike.aim + 0.03 * direction(strike.way);
  const int wedge = scene.add({tip, tip + 0.8 * direction(strike.leaning - 0.5 * strike.opening),
                               tip + 0.8 * direction(strike.leaning + 0.5 * strike.opening)});
  scene.setup.properties[static_cast<std::size_t>(wedge)].velocity = -strike.speed * direction(strike.way);
  scene.setup.joints.standard.normal_stiffness = strike.stiffness;
}

/// Onto the joint between two flush blocks, open by so much, m.
double overlap_at_flush_joint(const Strike& strike, double open = 0.0) {
  Scene scene(strike.young, 30.0);
  scene.rectangle({-3.0 - open, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, -1.0}, 3.0, 1.0, 0.0, true);
  add_wedge(scene, strike);
  return largest_overlap_of(scene, strike.step);
}

/// Into the corner between a floor and a wall that stands on it.
double overlap_at_wall(const Strike& strike) {
  Scene scene(strike.young, 30.0);
  scene.rectangle({-2.0, -1.0}, 6.0, 1.0, 0.0, true);
  scene.rectangle({-2.0, 0.0}, 2.0, 4.0, 0.0, true);
  add_wedge(scene, strike);
  return largest_overlap_of(scene, strike.step);
}

// What a tip is pressed into the faces beside a closed joint made it go along the sides within the joint: up to 0.7 m deep.
TEST(ClosedJoint, KeepsOutTipsThatStrikeIt) {
  for (const double young : {1e9, 3e9, 3e10}) {
    for (const double step : {0.002, 0.0005, 0.0002}) {
      for (const double leaning : {70.0, 90.0, 110.0}) {
        for (const double beside : {-0.0035, -0.0005, 0.001, 0.002}) {
          const double depth = overlap_at_flush_joint(
              {.young = young, .step = step, .leaning = leaning, .aim = {beside, 0.0}});
          EXPECT_LT(depth, 0.005) << young << " " << step << " " << leaning << " " << beside;
        }
      }
    }
  }
}

// A joint that is open by less than the zone in which corners compete has no room for a tip either.
TEST(ClosedJoint, KeepsOutTipsWhereItIsALittleOpen) {
  for (const double open : {0.0005, 0.001, 0.002}) {
    for (const double stiffness : {0.0, 1e10}) {
      for (const double step : {0.002, 0.0005, 0.0002}) {
        for (const double leaning : {60.0, 70.0, 90.0, 110.0, 120.0}) {
          for (const double beside : {-0.0035, -0.002, -0.0005, 0.001, 0.002}) {
            const double depth = overlap_at_flush_joint({.young = 3e9,
                                                         .stiffness = stiffness,
                                                         .step = step,
                                                         .speed = 4.0,
                                                         .leaning = leaning,
                                                         .aim = {beside, 0.0}},
                                                        open);
            EXPECT_LT(depth, 0.01) << open << " " << stiffness << " " << step << " " << leaning << " "
                                   << beside;
          }
        }
      }
    }
  }
}

TEST(ClosedJoint, KeepsOutTipsThatRunIntoACorner) {
  for (const double young : {1e9, 3e9, 3e10}) {
    for (const double step : {0.002, 0.0005, 0.0002}) {
      for (const double leaning : {26.0, 30.0, 45.0, 60.0}) {
        for (const double aside : {-0.002, 0.0, 0.002}) {
          const double depth = overlap_at_wall({.young = young,
                                                .step = step,
                                                .speed = 5.0,
                                                .leaning = leaning,
                                                .way = leaning,
                                                .aim = {0.0, aside}});
          EXPECT_LT(depth, 0.005) << young << " " << step << " " << leaning << " " << aside;
        }
      }
    }
  }
}

// Where a joint comes out at a small angle, a block ends so thin that what strikes it is within that zone of the joint below: it went
// through. Distances as in a tunnel, where a stone fell on its floor.
TEST(ClosedJoint, ThinEndsOfBlocksKeepOutWhatStrikesThem) {
  for (const double speed : {1.0, 4.0, 10.0}) {
    for (const double beside : {0.003, 0.004, 0.006, 0.01, 0.03}) {
      for (const double above : {0.00002, 0.0005, 0.005, 0.01, 0.03}) {
        Scene scene(3e9, 39.0);
        scene.add({{-0.5, -0.5}, {0.3, -0.5}, {0.2006, -0.0175}, {0.0, 0.0}, {-0.5, -0.0827}}, true);
        scene.add({{0.0, 0.0}, {0.2006, -0.0175}, {0.181, 0.0347}, {0.1098, 0.0181}}, true);
        scene.rectangle({10.0, 10.0}, 1.0, 1.0);  // for the lengths of contact
        const Vec2 tip{beside, 0.165 * beside + above};
        const int stone = scene.add(
            {tip, tip + Vec2{-0.0478, 0.1184}, tip + Vec2{-0.1222, 0.0139}, tip + Vec2{-0.072, 0.0102}});
        scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {0.0, -speed};
        EXPECT_LT(largest_overlap_of(scene, 0.002), 0.002) << speed << " " << beside << " " << above;
      }
    }
  }
}

// The end is less than 0.1 mm thick where the tip comes down on it.
TEST(ClosedJoint, ThinEndsKeepOutWhatStrikesTheirVeryTip) {
  for (const double beside : {0.0002, 0.0006, 0.001, 0.002}) {
    for (const double angle : {1.0, 3.2, 8.0}) {
      Scene scene(1.1e10, 30.0);
      scene.add({{-0.5, -0.5}, {0.5, -0.5}, {0.5, -0.05}, {0.0, 0.0}, {-0.5, -0.0827}}, true);
      const Vec2 end{0.5 * std::cos(angle * degree), 0.5 * std::sin(angle * degree)};
      scene.add({{0.0, 0.0}, {0.5, -0.05}, end}, true);
      scene.rectangle({10.0, 10.0}, 0.9, 0.9);  // for the lengths of contact
      const Vec2 tip{beside, 0.0009 + 0.06 * beside};
      const int stone = scene.add({tip, tip + Vec2{-0.3818, 0.6924}, tip + Vec2{-0.7903, 0.0245}});
      scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {2.1, -3.7};
      EXPECT_LT(largest_overlap_of(scene, 0.0005), 0.002) << beside << " " << angle;
    }
  }
}

// A tip that has slid along a face past its end, into the mouth of a joint that has room for it, lies behind the face beyond, but has not
// come in by that; and its own face, at 4° or 5° to those of both blocks, rests on the corner, also where the tip comes to lie on the other
// block.
TEST(ClosedJoint, HoldsTipsInItsMouth) {
  for (const Vec2 corner :
       {Vec2{-0.0023, 0.0}, Vec2{-0.0035, 0.0}, Vec2{-0.002, -0.0018}}) {  // of the block beyond
    for (const double past : {0.0005, 0.001, 0.0015, 0.0025, 0.004}) {
      for (const double gap : {0.00005, 0.0003, 0.003}) {
        for (const double own : {4.0, 4.9}) {               // degrees, of its face
          for (const double sinking : {2.0, 6.0, 120.0}) {  // degrees, of its way against that
            for (const double speed : {2.0, 4.0}) {
              Scene scene(6e9, 30.0);
              const Vec2 down = direction(corner.y < 0.0 ? -80.0 : -120.0);
              scene.add({{0.0, 0.0}, 2.0 * down, 2.0 * down + Vec2{2.0, 0.0}, {2.0, 0.0}}, true);
              scene.add({corner, corner + Vec2{-1.0, 0.0}, corner + 2.0 * down + Vec2{-1.0, 0.0},
                         corner + 2.0 * down},
                        true);
              scene.rectangle({10.0, 10.0}, 0.9, 0.9);  // for the lengths of contact
              const Vec2 tip = gap * direction(own + 90.0) - past * direction(own);
              const int wedge =
                  scene.add({tip, tip + 0.5 * direction(own), tip + 0.5 * direction(own + 28.0)});
              scene.setup.properties[static_cast<std::size_t>(wedge)].velocity =
                  -speed * direction(own + sinking);
              EXPECT_LT(largest_overlap_of(scene, 0.002), 0.002)
                  << corner.x << " " << corner.y << " " << past << " " << gap << " " << own << " " << sinking
                  << " " << speed;
            }
          }
        }
      }
    }
  }
}

// A tip that has come into the mouth of an open joint is pinched as the joint closes: up to 1.2 mm deep where what holds it counted as
// covered by a closed joint.
TEST(ClosedJoint, PinchesTipsThatItClosesOn) {
  for (const double depth : {0.0012, 0.0018, 0.0024, 0.003}) {
    for (const double closed : {0.0009, 0.0012, 0.0015, 0.0018}) {  // m, as far as the tip lets it
      for (const double level :
           {-0.0003, -0.00005, 0.00005, 0.0003}) {  // of the corner of the block that closes it
        for (const double own : {80.0, 85.0, 89.0}) {
          for (const double speed : {0.05, 0.2, 0.5, 2.0}) {
            const double other = std::atan2(depth + level, closed) / degree;
            if (other > own - 10.0) continue;
            Scene scene(3e9, 39.0);
            scene.add({{0.0, 0.0}, 0.5 * direction(110.0), {-0.6, 0.5}, {-0.6, -1.6}, {0.0, -1.6}}, true);
            const Vec2 tip{0.0, -depth}, corner{closed + 0.0015, level};
            const int wedge = scene.add({tip, tip + 0.3 * direction(other), tip + 0.3 * direction(own)});
            const int closing = scene.add({corner, corner + Vec2{0.0, -1.6}, corner + Vec2{0.6, -1.6}});
            scene.setup.properties[static_cast<std::size_t>(wedge)].velocity = {-0.02, -0.1};
            scene.setup.properties[static_cast<std::size_t>(closing)].velocity = {-speed, 0.0};
            EXPECT_LT(largest_overlap_of(scene, 0.002), 0.0004)
                << depth << " " << closed << " " << level << " " << own << " " << speed;
          }
        }
      }
    }
  }
}

// Tips pressed in deeper than the zone in which corners compete are beyond the end of the wall, and nearer to the sides within the joint.
TEST(ClosedJoint, KeepsOutTipsThatSoftJointsLetIn) {
  for (const double step : {0.002, 0.0005, 0.0002}) {
    for (const double speed : {2.0, 4.0}) {
      for (const double leaning : {60.0, 90.0, 100.0}) {
        for (const double beside : {-0.002, 0.0005}) {
          const double depth = overlap_at_flush_joint({.young = 3e9,
                                                       .stiffness = 1e10,
                                                       .step = step,
                                                       .speed = speed,
                                                       .leaning = leaning,
                                                       .way = 80.0,
                                                       .aim = {beside, 0.0}});
          EXPECT_LT(depth, 0.01) << step << " " << speed << " " << leaning << " " << beside;
        }
      }
      for (const double leaning : {30.0, 45.0, 60.0}) {
        const double depth = overlap_at_wall({.young = 3e9,
                                              .stiffness = 1e10,
                                              .step = step,
                                              .speed = speed,
                                              .leaning = leaning,
                                              .way = leaning});
        EXPECT_LT(depth, 0.01) << step << " " << speed << " " << leaning;
      }
    }
  }
}

// Joints of 1 GPa/m give way by more than the zone in which corners compete: a tip stays with the face that has held it, and where it slides
// over the joint the next face takes over what held it. The blow takes less than 8 mm. Not so in four of 216 scenes (23 to 35 mm), in which
// the tip slides to and fro over the joint (decision 0008).
TEST(ClosedJoint, KeepsOutTipsThatVerySoftJointsLetIn) {
  int deep = 0;
  double deepest = 0.0;
  for (const double open : {0.0, 0.0007}) {
    for (const double step : {0.0007, 0.0003}) {
      for (const double speed : {0.6, 2.0}) {
        for (const double leaning : {70.0, 95.0, 115.0}) {
          for (const double way : {77.0, 103.0, 120.0}) {
            for (const double beside : {-0.003, -0.001, 0.002}) {
              const double depth = overlap_at_flush_joint({.young = 4e9,
                                                           .stiffness = 1e9,
                                                           .step = step,
                                                           .speed = speed,
                                                           .leaning = leaning,
                                                           .way = way,
                                                           .aim = {beside, 0.0}},
                                                          open);
              deep += depth > 0.008 ? 1 : 0;
              deepest = std::max(deepest, depth);
            }
          }
        }
      }
    }
  }
  EXPECT_LE(deep, 4);
  EXPECT_LT(deepest, 0.04);
}

}  // namespace
}  // namespace keyblock::simulation
