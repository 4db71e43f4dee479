#include "study/risk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../fresh_folder.h"
#include "core/error.h"
#include "core/read_file.h"
#include "made_run.h"

namespace keyblock::study {
namespace {

using testing::HasSubstr;

/// Forty rock masses at 2, 4 and 6 m/s² under one record: 4, 14 and 30 of them lose more than 1 m².
StudyData forty(double area = 2.0) {
  std::vector<std::array<double, 3>> added;
  for (int r = 0; r < 40; ++r)
    added.push_back({r < 4 ? area : 0.0, r < 14 ? area : 0.0, r < 30 ? area : 0.0});
  return shaken(std::vector<double>(40, 0.0), added);
}

class RiskOfAStudy : public testing::Test {
 protected:
  /// λ = 0.01 x^−2.5 from 1e-3 to 1e5 m/s².
  RiskSettings settings(double factor = 1.0) {
    const std::filesystem::path file = folder_ / ("hazard" + std::to_string(factor) + ".csv");
    std::ofstream out(file);
    out.precision(17);
    for (int i = -3; i <= 5; ++i)
      out << std::pow(10.0, i) << " " << factor * 0.01 * std::pow(10.0, -2.5 * i) << "\n";
    RiskSettings made;
    made.lifetime = 100.0;
    made.hazards = {{file, {.intensity = "PGA", .unit = "m/s2"}, "section", 1.0}};
    return made;
  }

  FreshFolder folder_;
};

TEST_F(RiskOfAStudy, IsThatOfItsCurve) {
  const StudyData study = forty();
  const Summary summary = summarize(study);
  const Risk risk = find_risk(study, summary, settings(), "");
  ASSERT_EQ(risk.levels.size(), 1U);
  const LevelRisk& level = risk.levels[0];
  const statistics::FragilityCurve& curve = summary.fragility[level.group].curve;
  const double beta = curve.beta.value;
  const double closed = 0.01 * std::pow(curve.theta.value, -2.5) * std::exp(0.5 * 6.25 * beta * beta);
  EXPECT_NEAR(level.rate.value / closed, 1.0, 1e-5);
  EXPECT_LT(level.rate.low, level.rate.value);
  EXPECT_GT(level.rate.high, level.rate.value);
  EXPECT_NEAR(level.annual, closed, 1e-5 * closed + closed * closed);
  EXPECT_TRUE(std::isnan(level.lifetime));  // one record: the split is not known
  EXPECT_NEAR(level.lifetime_poisson, -std::expm1(-100.0 * level.rate.value), 1e-12);
  EXPECT_LT(level.x16, level.x50);
  EXPECT_LT(level.x50, level.x84);
  EXPECT_GT(level.points_high, level.points_low);
  EXPECT_THAT(risk_lines(study, summary, risk)[0], HasSubstr("for this record only"));
  ASSERT_EQ(risk.expected.size(), 2U);
  EXPECT_EQ(risk.expected[0].measure, "fallen_area_m2");
  EXPECT_GT(risk.expected[0].value.value, 0.0);
}

TEST_F(RiskOfAStudy, OfSeveralCurvesIsTheirMean) {
  const StudyData study = forty();
  const Summary summary = summarize(study);
  RiskSettings two = settings();
  two.hazards.push_back(settings(3.0).hazards[0]);
  two.hazards[0].weight = 3.0;
  two.sections = 10.0;
  const LevelRisk one = find_risk(study, summary, settings(), "light").levels[0];
  const LevelRisk both = find_risk(study, summary, two, "light").levels[0];
  EXPECT_NEAR(both.rate.value / one.rate.value, 0.75 + 0.25 * 3.0, 1e-9);
  ASSERT_EQ(both.by_hazard.size(), 2U);
  EXPECT_NEAR(both.by_hazard[1] / both.by_hazard[0], 3.0, 1e-9);
  EXPECT_EQ(both.sections_low, both.rate.value);
  EXPECT_GT(both.sections_high, 2.0 * both.rate.value);
  EXPECT_LT(both.sections_high, 10.0 * both.rate.value);
}

TEST_F(RiskOfAStudy, WithoutExceedanceIsAnUpperLimit) {
  const StudyData study = forty(0.5);
  const Summary summary = summarize(study);
  const Risk risk = find_risk(study, summary, settings(), "");
  EXPECT_EQ(risk.levels[0].status, RiskStatus::upper_limit);
  EXPECT_TRUE(std::isnan(risk.levels[0].rate.value));
  EXPECT_GT(risk.levels[0].rate.high, 0.01 * std::pow(6.0, -2.5));
  EXPECT_THAT(risk_lines(study, summary, risk)[0], HasSubstr("less than once in"));
}

TEST_F(RiskOfAStudy, RefusesAnotherIntensity) {
  const StudyData study = forty();
  const Summary summary = summarize(study);
  const auto refusal = [&](const RiskSettings& asked, const std::string& level) -> std::string {
    try {
      find_risk(study, summary, asked, level);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  RiskSettings other = settings();
  other.hazards[0].component = "rotd50";  // which these runs do not have
  EXPECT_THAT(refusal(other, ""), HasSubstr("component rotd50"));
  other.hazards[0].component = "larger";
  EXPECT_THAT(refusal(other, ""), HasSubstr("found a hazard of PGA, component larger"));
  EXPECT_THAT(refusal(settings(), "heavy"), HasSubstr("found \"heavy\"; expected light"));
  other = settings();
  other.hazards.push_back(settings(2.0).hazards[0]);
  other.hazards[1].component = "rotd50";
  EXPECT_THAT(refusal(other, ""), HasSubstr("curves of one intensity and component"));
}

TEST_F(RiskOfAStudy, IsInItsFiles) {
  const StudyData study = forty();
  const Summary summary = summarize(study);
  const Risk risk = find_risk(study, summary, settings(), "");
  const auto json = nlohmann::json::parse(risk_json(study, summary, risk));
  EXPECT_EQ(json["levels"][0]["level"], "light");
  EXPECT_EQ(json["levels"][0]["rate"]["value"], risk.levels[0].rate.value);
  EXPECT_TRUE(json["levels"][0]["lifetime"].is_null());
  EXPECT_EQ(json["hazard"][0]["component"], "section");
  const std::string csv = risk_csv(study, summary, risk);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
}

TEST(RiskSettings, AreThoseOfTheGuide) {
  const std::string text = read_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs/risk.md");
  const std::size_t begin = text.find("```toml\n") + 8;
  FreshFolder folder;
  std::ofstream(folder / "risk.toml") << text.substr(begin, text.find("```", begin) - begin);
  for (const char* file : {"hazard_curve-mean-PGA_12.csv", "pga.csv"}) std::ofstream(folder / file) << "0";
  const RiskSettings settings = read_risk_settings(folder / "risk.toml");
  EXPECT_EQ(settings.lifetime, 100.0);
  EXPECT_EQ(settings.sections, 10.0);
  ASSERT_EQ(settings.hazards.size(), 2U);
  EXPECT_EQ(settings.hazards[0].options.site->second, 47.37);
  EXPECT_EQ(settings.hazards[1].options.unit, "g");
  EXPECT_EQ(settings.hazards[1].weight, 0.5);
  std::ofstream(folder / "wrong.toml")
      << "lifetime = -1\nfoo = 1\n[[hazard]]\nfile = \"none.csv\"\ncomponent = \"x\"\n";
  try {
    read_risk_settings(folder / "wrong.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().size(), 4U);
    EXPECT_THAT(error.what(), HasSubstr("wrong.toml:1:"));
  }
}

}  // namespace
}  // namespace keyblock::study
