#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "../fresh_folder.h"
#include "core/error.h"
#include "scenario/inputs.h"
#include "scenario/parse.h"
#include "study/plan.h"
#include "study/rotation.h"

namespace keyblock::study {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// The gallery with a suite of records that are sines: the first of 1 m/s², each 10 % stronger than the one before.
class SuiteStudy : public testing::Test {
 protected:
  static constexpr int records = 8;

  SuiteStudy() {
    std::ofstream list(folder_ / "suite.csv");
    list << "name,h1,h2,azimuth1,azimuth2,event\n";
    for (int k = 0; k < records; ++k) {
      for (const char* component : {"h1", "h2"}) write_record(k, component);
      list << fmt::format("R{0},R{0}h1.txt,R{0}h2.txt,0,90,E{0}\n", k);
    }
    std::ifstream gallery(std::filesystem::path(KEYBLOCK_TEST_DATA) / "study/gallery.toml");
    std::ostringstream text;
    text << gallery.rdbuf();
    std::string scenario = text.str();
    scenario.replace(scenario.find("[[motion]]"), scenario.find("[[stage]]") - scenario.find("[[motion]]"),
                     "[[suite]]\nname = \"few\"\nfile = \"suite.csv\"\n");
    scenario.replace(scenario.find("motion = \"sine\""), 15, "motion = \"few\"");
    scenario.resize(scenario.find("[study]"));
    std::ofstream(folder_ / "s.toml")
        << scenario << "[study]\nrealizations = 10\n[[study.shaking]]\nsuite = \"few\"\n"
        << "levels = [1.0, 2.0]\n";
  }

  /// 2 s; the second component shakes half as much.
  void write_record(int k, const std::string& component) {
    std::ofstream file(folder_ / fmt::format("R{}{}.txt", k, component));
    file << "time (s), acceleration (m/s2)\n";
    const double amplitude = (component == "h1" ? 1.0 : 0.5) * std::pow(1.1, k);
    for (int i = 0; i <= 200; ++i)
      file << fmt::format("{:.2f}, {:.9f}\n", 0.01 * i, amplitude * std::sin(std::numbers::pi * 0.02 * i));
  }

  Plan plan(const std::vector<std::string>& overrides = {}, std::vector<std::string>* warnings = nullptr) {
    return make_plan(folder_ / "s.toml", overrides, "1.2.3", warnings);
  }
  std::string refusal(const std::vector<std::string>& overrides) {
    try {
      plan(overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  }
  FreshFolder folder_;
};

// Two of eight records each, in rotation: 01 12 23 34 45 56 67 70, then with another distance.
TEST_F(SuiteStudy, RockMassesMeetRecordsInRotation) {
  const Plan all = plan();
  std::vector<std::set<std::string>> met(10);
  for (const PlannedRun& run : all.runs)
    if (run.variant.empty())
      met[static_cast<std::size_t>(run.realization)].insert(run.values[0][0].substr(6, 1));
  const std::vector<std::set<std::string>> expected{{"0", "1"}, {"1", "2"}, {"2", "3"}, {"3", "4"},
                                                    {"4", "5"}, {"5", "6"}, {"6", "7"}, {"7", "0"},
                                                    {"0", "2"}, {"1", "3"}};
  EXPECT_EQ(met, expected);
  // Two records at two levels, and a control run.
  EXPECT_EQ(all.runs.size(), 10U * 5U);
  EXPECT_TRUE(all.control);
  const Plan few = plan({"study.realizations=4"});
  for (std::size_t k = 0; k < few.runs.size(); ++k) EXPECT_EQ(few.runs[k].key, all.runs[k].key);
}

// Every record of a stripe has the same intensity: the scales are in the ratio of the records. The RotD50 of (a, a/2) in phase is that of their length
// √1.25 a times cos 45°.
TEST_F(SuiteStudy, RecordsComeToTheLevels) {
  const double rotd50 = std::sqrt(1.25) * std::sqrt(0.5);
  for (const PlannedRun& run : plan().runs) {
    if (!run.variant.empty()) continue;
    const double record = std::stod(run.values[0][0].substr(6, 1)), scale = std::stod(run.values[0][1]);
    const double level = scale * std::pow(1.1, record) * rotd50;
    EXPECT_NEAR(level, level < 1.5 ? 1.0 : 2.0, 0.01);
  }
  const auto first_scale = [&](const std::vector<std::string>& overrides) {
    return std::stod(plan(overrides).axes[0].values[0][1]);
  };
  EXPECT_NEAR(first_scale({"study.shaking.0.component='larger'"}), 1.0, 1e-6);
  EXPECT_NEAR(first_scale({"study.shaking.0.component='geometric-mean'"}), std::sqrt(2.0), 1e-6);
  // The section lies along 90°, as the second component does.
  EXPECT_NEAR(first_scale({"study.shaking.0.component='section'"}), 2.0, 1e-6);
  // Arias intensity goes with the square.
  const double one = first_scale({"study.shaking.0.intensity='IA'", "study.shaking.0.levels=[0.1, 0.4]"}),
               four = first_scale({"study.shaking.0.intensity='IA'", "study.shaking.0.levels=[0.4]"});
  EXPECT_NEAR(four / one, 2.0, 1e-9);
}

// One control run for all records and levels, of the longest record.
TEST_F(SuiteStudy, EachRockMassHasOneControlRun) {
  const Plan all = plan();
  std::map<int, std::set<std::string>> controls;
  for (const PlannedRun& run : all.runs)
    if (run.variant.empty()) controls[run.realization].insert(run.control);
  for (const auto& [realization, keys] : controls) EXPECT_EQ(keys.size(), 1U) << realization;
  EXPECT_EQ(std::ranges::count(all.runs, "unshaken", &PlannedRun::variant), 10);
  EXPECT_FALSE(plan({"study.control=false"}).control);
}

// Levels in rotation: each pair has one of two, and both are met by every record.
TEST_F(SuiteStudy, PairsHaveSomeOfTheLevels) {
  const Plan all =
      plan({"study.realizations=16", "study.shaking.0.levels_per_record=1", "study.control=false"});
  EXPECT_EQ(all.runs.size(), 16U * 2U);
  std::map<std::string, std::set<std::string>> scales;
  for (const PlannedRun& run : all.runs) scales[run.values[0][0]].insert(run.values[0][1]);
  EXPECT_EQ(scales.size(), 8U);
  for (const auto& [record, levels] : scales) EXPECT_EQ(levels.size(), 2U) << record;
}

TEST(Rotation, LevelsAreMetEvenly) {
  for (const std::size_t c : {1U, 2U, 3U}) {
    std::vector<int> met(5);
    for (std::size_t i = 0; i < 40; ++i)
      for (std::size_t level = 0; level < 5; ++level) met[level] += takes_level(i, 1, 8, level, 5, c) ? 1 : 0;
    for (const int n : met) EXPECT_EQ(n, 8 * static_cast<int>(c));
  }
}

// A run has its own record alone, and random orientation is a matter of realization and record.
TEST_F(SuiteStudy, RunsReadTheirRecordAlone) {
  const auto scenario_of = [&](std::vector<std::string> overrides) {
    const ScenarioText source = read_scenario_text(folder_ / "s.toml", {});
    overrides.emplace_back("suite.few.orientation='random'");
    return scenario::parse_scenario_text(source.text, source.file, overrides,
                                         scenario::StudyTable::leave_out);
  };
  const auto third = scenario_of({"stage.shaken.motion='few/R3'"});
  ASSERT_EQ(third.motions.size(), 1U);
  EXPECT_EQ(third.motions[0].name, "few/R3");
  EXPECT_EQ(third.stages[2].motion, 0);
  EXPECT_EQ(scenario::input_paths(third).size(), 3U);  // the list and two components
  std::vector<std::string> unused;
  const auto peak = [&](const scenario::Scenario& s, int realization) {
    return scenario::read_motions(s, unused, realization)[0].peak();
  };
  EXPECT_EQ(peak(third, 1), peak(third, 1));
  EXPECT_NE(peak(third, 1), peak(third, 2));
  EXPECT_NE(peak(third, 1) / std::pow(1.1, 3), peak(scenario_of({}), 1));
}

TEST_F(SuiteStudy, RefusesWhatIsWrong) {
  EXPECT_THAT(refusal({"study.shaking.0.levels=[100.0]"}), HasSubstr("a factor of 126 on the record 'R0'"));
  EXPECT_THAT(refusal({"study.shaking.0.levels=[2.0, 1.0]"}), HasSubstr("ascending numbers"));
  EXPECT_THAT(refusal({"study.shaking.0.intensity='RSD595'"}), HasSubstr("SA(T)"));
  EXPECT_THAT(refusal({"study.shaking.0.component='rotd75'"}), HasSubstr("rotd100"));
  EXPECT_THAT(refusal({"study.shaking.0.intensity='CAV'", "study.shaking.0.component='section'"}),
              HasSubstr("PGA, PGV or IA"));
  EXPECT_THAT(refusal({"study.shaking.0.per_realization=9"}), HasSubstr("at most 8"));
  EXPECT_THAT(refusal({"study.shaking.0.suite='many'"}), HasSubstr("few"));
  EXPECT_THAT(refusal({"stage.shaken.motion='few/R9'"}), HasSubstr("few/R"));
  std::vector<std::string> warnings;
  plan({"study.shaking.0.levels=[5.0]"}, &warnings);
  EXPECT_THAT(warnings, Contains(HasSubstr("factors below 0.2 or above 5 on R0, R1, R2")));
}

}  // namespace
}  // namespace keyblock::study
