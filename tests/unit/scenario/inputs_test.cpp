#include "scenario/inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(Motions, TheRecordOfTheTunnelIsProjected) {
  const Scenario s = parse_scenario(examples / "01-tunnel.toml");
  std::vector<std::string> warnings;
  const auto motions = read_motions(s, warnings);
  EXPECT_THAT(warnings, IsEmpty());
  ASSERT_EQ(motions.size(), 1U);
  EXPECT_DOUBLE_EQ(motions[0].duration(), 20.0);
  double largest_x = 0.0, largest_y = 0.0;
  for (const Vec2 a : motions[0].accelerations()) {
    largest_x = std::max(largest_x, std::abs(a.x));
    largest_y = std::max(largest_y, std::abs(a.y));
  }
  EXPECT_NEAR(largest_y, 0.48347, 1e-9);
  EXPECT_GT(largest_x, 0.5);
  EXPECT_LT(largest_x, 1.0441 * std::cos(15.0 * std::numbers::pi / 180.0) +
                           0.70437 * std::sin(15.0 * std::numbers::pi / 180.0));
}

TEST(Motions, MistakesStandWhereTheyAreMade) {
  std::vector<std::string> warnings;
  const Scenario s = parse_scenario(examples / "01-tunnel.toml", {"motion.shafter-1989.window=[5, 100]"});
  try {
    read_motions(s, warnings);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1U);
    EXPECT_EQ(error.diagnostics()[0].key, "motion.shafter-1989.window");
    EXPECT_EQ(error.diagnostics()[0].where.file, "--set motion.shafter-1989.window=[5, 100]");
  }
}

TEST(Motions, OtherDirectionsThanTheFileSaysAreWarnedOf) {
  std::vector<std::string> warnings;
  read_motions(parse_scenario(examples / "01-tunnel.toml", {"motion.0.components.0.azimuth=300"}), warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0],
              HasSubstr("motion.shafter-1989.components[0].azimuth is 300°; the file says 360°"));
}

TEST(Motions, TheSameRecordTwiceIsWarnedOf) {
  const auto warned = [](const std::string& more) {
    std::vector<std::string> warnings;
    const std::string file = "file = '" + (examples / "motions/0111a.smc").string() + "'";
    const std::string components = "components = [{ " + file + " }, { " + file + more + " }]\n";
    read_motions(parse(two_blocks + "[section]\nazimuth = 90.0\n[[motion]]\nname = \"m\"\n" + components),
                 warnings);
    return warnings;
  };
  const auto same =
      HasSubstr("motion.m.components[1]: the same record as motion.m.components[0]; both are added up");
  EXPECT_THAT(warned(""), testing::ElementsAre(same));
  EXPECT_THAT(warned(", channel = 1"), testing::ElementsAre(same));
}

TEST(Motions, OfSeveralComponentsOneMustBeChosen) {
  const std::string text = two_blocks + R"(
[section]
azimuth = 90.0
[[motion]]
name = "three"
components = [{ file = "../motions/excerpt.V2" }]
)";
  const auto read = [&](const std::vector<std::string>& overrides) -> std::string {
    std::vector<std::string> warnings;
    try {
      read_motions(parse(text, overrides), warnings);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(read({}), HasSubstr("expected channel = the number of one of them"));
  EXPECT_EQ(read({"motion.three.components[0].channel=1"}), "");
  EXPECT_THAT(read({"motion.three.components[0].channel=99"}),
              HasSubstr("motion.three.components[0].channel: found the integer 99"));
}

TEST(CheckInputs, MistakesOfAllFilesComeTogether) {
  const Scenario s = parse(jointed_domain + R"(
[[trace_map]]
file = "../motions/README.md"
[[motion]]
name = "record"
components = [{ file = "../motions/README.md", azimuth = 0 }]
)");
  try {
    check_inputs(s);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_GE(error.diagnostics().size(), 2U);
  }
}

}  // namespace
}  // namespace keyblock::scenario
