#include "scenario/far_rock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

/// Rock of a box on a half-space of itself, with one set of through-going joints 2 m apart.
std::string jointed_ground(double dip, const std::string& boundary,
                           const std::string& motion = "x = [[0, 0], [1, 1], [2, -1], [3, 0]]") {
  return "accept_warnings = [\"order-1\"]\n[section]\nazimuth = 90.0\n[domain]\nx = [0, 40]\ny = [-20, 0]\n"
         "[rock]\ndensity = 2500.0\nyoung = 4.8e9\npoisson = 0.2\nstate = \"plane-strain\"\n"
         "[joints]\nfriction = 30.0\nnormal_stiffness = 2.0e9\nshear_stiffness = 1.0e9\n"
         "[[joint_set]]\nname = \"set\"\ndip = " +
         std::to_string(dip) +
         "\ndip_direction = 90.0\nspacing = 2.0\nlength = 1000.0\ngap = 0.0\n[boundary]\n" + boundary +
         "\n[time]\nstep = 0.005\n[[motion]]\nname = \"quake\"\n" + motion +
         "\n[[stage]]\nname = \"settle\"\nkind = \"settle\"\n[[stage]]\nname = \"shake\"\nkind = "
         "\"shake\"\nmotion = \"quake\"\n";
}

simulation::RunSetup setup_of(const std::string& text) {
  return build_setup(parse_scenario_text(text, "ground.toml"), 0);
}

// Of rock with G = 2 GPa and level joints.
TEST(FarRock, IsSofterByItsJoints) {
  const double share = 1.0 / 2.0, nu = 0.2, young = 4.8e9;
  for (const double dip : {0.0, 90.0}) {
    const dynamics::RockLayer rock = setup_of(jointed_ground(dip, "")).boundary->layers.front();
    EXPECT_NEAR(1.0 / rock.shear, 1.0 / 2e9 + share / 1e9, 1e-15) << dip;
    const double upright = young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    if (dip > 0.0) continue;
    EXPECT_NEAR(1.0 / rock.upright, 1.0 / upright + share / 2e9, 1e-15);
  }
  // Joints at 45° feel a shear stress of the section as a pressure: they close and open by it.
  const double shear_compliance = 1.0 / 2e9 + share / 2e9;
  const dynamics::RockLayer inclined = setup_of(jointed_ground(45.0, "")).boundary->layers.front();
  EXPECT_GT(inclined.shear, 1.0 / shear_compliance);  // nothing moves sideways
  EXPECT_LT(inclined.shear, 2e9);
}

TEST(FarRock, IsAsTheKeysSay) {
  const simulation::RunSetup setup =
      setup_of(jointed_ground(0.0,
                              "density = 2700.0\nvs = 1500.0\nvp = 2800.0\n"
                              "column = [{ top = 0.0, density = 2000.0, vs = 300.0, vp = 600.0 },\n"
                              "{ top = -8.0, density = 2400.0, vs = 700.0, vp = 1300.0 }]"));
  const simulation::Boundary& boundary = *setup.boundary;
  EXPECT_EQ(boundary.dashpots, (Vec2{2700.0 * 1500.0, 2700.0 * 2800.0}));
  ASSERT_EQ(boundary.layers.size(), 2u);
  EXPECT_NEAR(boundary.layers[1].top + setup.system.origin.y, -8.0, 1e-12);
  EXPECT_DOUBLE_EQ(boundary.layers[1].shear, 2400.0 * 700.0 * 700.0);
  EXPECT_DOUBLE_EQ(boundary.layers[1].upright, 2400.0 * 1300.0 * 1300.0);
  EXPECT_FALSE(setup.frame);
  EXPECT_EQ(setup.solver.integrator, dynamics::TimeIntegration::generalized_alpha);
}

// What goes up in the rock is half of what an outcrop does.
TEST(FarRock, TakesMotionsToTheOutcrop) {
  const auto motion = [](const std::string& at) {
    return setup_of(jointed_ground(0.0, "", at + "x = [[0, 0], [1, 1], [2, -1], [3, 0]]")).motions.front();
  };
  EXPECT_EQ(motion("").at(1.0), (Vec2{1.0, 0.0}));
  EXPECT_EQ(motion("at = \"outcrop\"\n").at(1.0), (Vec2{1.0, 0.0}));
  EXPECT_EQ(motion("at = \"inside\"\n").at(1.0), (Vec2{2.0, 0.0}));
}

TEST(FarRock, WarnsOfWhatDoesNotFit) {
  using ::testing::Contains;
  using ::testing::HasSubstr;
  using ::testing::Not;
  const auto warnings = [](const std::string& boundary, const std::string& motion) {
    return setup_of(jointed_ground(0.0, boundary, motion)).warnings;
  };
  const std::string even = "x = [[0, 0], [1, 1], [2, -1], [3, 0]]", drifting = "x = [[0, 0], [1, 1], [2, 0]]",
                    fast = "x = { amplitude = 1.0, frequency = 20.0, cycles = 3 }",
                    upright = "y = { amplitude = 1.0, frequency = 2.0, cycles = 3 }";
  EXPECT_THAT(warnings("", even), Not(Contains(HasSubstr("velocity does not come back"))));
  EXPECT_THAT(warnings("", drifting), Contains(HasSubstr("velocity does not come back")));
  EXPECT_THAT(warnings("", fast), Contains(HasSubstr("m long, which is")));
  EXPECT_THAT(warnings("sides = \"viscous\"", even), Contains(HasSubstr("rock at rest beside a model")));
  EXPECT_THAT(warnings("sides = \"roller\"", even), Contains(HasSubstr("no shear wave goes up")));
  EXPECT_THAT(warnings("sides = \"roller\"", upright), Not(Contains(HasSubstr("no shear wave goes up"))));
}

}  // namespace
}  // namespace keyblock::scenario
