#include "scenario/inputs.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "../fresh_folder.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using testing::ElementsAre;
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

// A scenario of two blocks with a motion of these keys, and a file for it.
std::vector<loading::GroundMotion> motions_of(const std::string& keys, std::vector<std::string>& warnings,
                                              const std::string& content = "0 1 10\n0.5 2 20\n1.0 3 30\n") {
  const FreshFolder own;
  const std::filesystem::path file = own / "motion.txt";
  std::ofstream(file) << content;
  std::string text = keys;
  for (std::size_t at = text.find("FILE"); at != std::string::npos; at = text.find("FILE"))
    text.replace(at, 4, "file = '" + file.string() + "'");
  return read_motions(parse(two_blocks + "[[motion]]\nname = \"m\"\n" + text), warnings);
}

TEST(Motions, FilesAlongTheAxesNeedNoAzimuth) {
  std::vector<std::string> warnings;
  const auto both = motions_of(
      "x = { FILE, column = 2, unit = \"m/s2\" }\ny = { FILE, column = 3, unit = \"cm/s2\" }\n", warnings);
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_EQ(both.at(0).duration(), 1.0);
  EXPECT_EQ(both[0].at(0.5), (Vec2{2.0, 0.2}));
  const auto stepped =
      motions_of("x = { FILE, skip = 1, dt = 0.1, unit = \"g\" }\nwindow = [0.1, 0.5]\n", warnings);
  EXPECT_NEAR(stepped.at(0).duration(), 0.4, 1e-12);
  EXPECT_EQ(stepped[0].at(0.0).y, 0.0);
  EXPECT_EQ(stepped[0].at(0.0).x, 2.0 * loading::standard_gravity);
  const auto listed =
      motions_of("components = [{ FILE, column = 2, unit = \"gal\", azimuth = \"up\" }]\n", warnings);
  EXPECT_EQ(listed.at(0).at(1.0), (Vec2{0.0, 0.03}));
}

TEST(Motions, AFileInXWithOtherThingsIsRefused) {
  std::vector<std::string> warnings;
  const std::pair<const char*, const char*> wrong[] = {
      {"x = { FILE, column = 2 }\n", "the unit of the samples"},
      {"x = { FILE, unit = \"furlongs\" }\n", "a unit of acceleration"},
      {"x = { FILE, column = 2, channel = 1, unit = \"g\" }\n", "none of skip, column and dt"},
      {"x = { FILE, amplitude = 1.0, unit = \"g\" }\n", "no file"},
      {"x = { FILE, column = 2, unit = \"g\" }\ny = [[0, 1], [1, 1]]\n", "a file in both directions"},
      {"x = { amplitude = 1.0, frequency = 1.0, cycles = 1.0, dt = 0.1 }\n", "a file"},
      {"x = { FILE, column = 2, unit = \"g\" }\ncomponents = [{ FILE, azimuth = \"up\" }]\n",
       "no components"}};
  for (const auto& [keys, expected] : wrong) {
    try {
      motions_of(keys, warnings);
      ADD_FAILURE() << keys;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(expected)) << keys;
    }
  }
}

TEST(Motions, AVerticalRecordAlongXIsWarnedOf) {
  std::vector<std::string> warnings;
  motions_of("x = { FILE }\n", warnings, "time (s),up (g)\n0,1\n1,2\n");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("motion.m.x: the file calls this component \"up (g)\""));
}

TEST(Motions, AWindowThatStartsOrEndsWithAJumpIsTold) {
  const std::string record = "0 0\n1 10\n2 5\n3 -20\n4 0.5\n5 0\n";
  const std::string x = "x = { FILE, column = 2, unit = \"m/s2\" }\n";
  std::vector<std::string> warnings;
  motions_of(x, warnings, record);
  motions_of(x + "window = [0, 4]\n", warnings, record);
  EXPECT_THAT(warnings, IsEmpty());
  motions_of(x + "window = [1, 4]\n", warnings, record);
  motions_of(x + "window = [0, 2]\n", warnings, record);
  motions_of(x + "window = [1, 4]\nbaseline = \"taper\"\n", warnings, record);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_THAT(
      warnings[0],
      HasSubstr("motion.m.window: the motion starts with a jump of 10 m/s2, 50 % of its peak; baseline"));
  EXPECT_THAT(warnings[1], HasSubstr("ends with a jump of 5 m/s2, 50 %"));
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

// Two horizontal components, by their azimuths.
std::vector<std::string> warned_of_azimuths(const std::string& azimuths) {
  std::vector<std::string> warnings;
  motions_of(azimuths + "\n[section]\nazimuth = 90.0\n", warnings);
  return warnings;
}

TEST(Motions, HorizontalComponentsAreNormalToEachOther) {
  const auto warned = [](double one, double other) {
    return warned_of_azimuths(
        fmt::format("components = [{{ FILE, column = 2, unit = 'm/s2', azimuth = {} }}, {{ FILE, "
                    "column = 3, unit = 'm/s2', azimuth = {} }}]",
                    one, other));
  };
  EXPECT_THAT(warned(0.0, 90.0), IsEmpty());
  EXPECT_THAT(warned(350.0, 85.0), IsEmpty());
  EXPECT_THAT(warned(30.0, 300.0), IsEmpty());
  EXPECT_THAT(
      warned(0.0, 60.0),
      ElementsAre(HasSubstr("motion.m.components[1].azimuth: 60° (line 27) and the 0° of "
                            "motion.m.components[0].azimuth are 60° apart; the horizontal components of a "
                            "record are normal to each other, as 0° and 90° are")));
  EXPECT_THAT(warned(0.0, 180.0), ElementsAre(HasSubstr("are 180° apart")));
}

TEST(Motions, TheOnlyComponentIsAlongTheSection) {
  const auto warned = [](double azimuth) {
    return warned_of_azimuths(
        fmt::format("components = [{{ FILE, column = 2, unit = 'm/s2', azimuth = {} }}]", azimuth));
  };
  EXPECT_THAT(warned(270.0), IsEmpty());
  EXPECT_THAT(warned(45.0), IsEmpty());
  EXPECT_THAT(warned(10.0),
              ElementsAre(HasSubstr(
                  "motion.m.components[0].azimuth: the only horizontal component (line 27), at 10°, is "
                  "80° from the section of 90°; 17 % of it shakes the section")));
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
