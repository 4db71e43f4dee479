#include "study/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_run.h"

namespace keyblock::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> lines(const StudyData& study) {
  return findings(study, summarize(study));
}

TEST(Findings, TellGravityFromTheShaking) {
  StudyData study = shaken({3.0, 2.0, 0.0, 0.0}, {{0, 0, 0}, {0, 0, 1.5}, {0, 1.5, 2}, {0, 0, 0}});
  EXPECT_THAT(lines(study),
              ElementsAre("light: fallen_area_m2 > 1; stage.quake.scale = 1: 2 of 4 (15 … 85 %) realizations "
                          "before the shaking, "
                          "0 of 4 (0 … 49 %) by what the shaking adds",
                          HasSubstr("1 of 4 (5 … 70 %) by what the shaking adds"),
                          HasSubstr("2 of 4 (15 … 85 %) by what the shaking adds"),
                          StartsWith("curve of light over PGA: none, as 4 realizations are too few")));
  study.since = "";
  EXPECT_THAT(
      lines(study)[2],
      HasSubstr(": 3 of 4 (30 … 95 %) realizations in all, 2 of 4 (15 … 85 %) before the shaking, 2 of 4"));
  study.since = study.before = "excavated";
  study.at_shaking = false;
  EXPECT_THAT(
      lines(study)[2],
      HasSubstr("realizations until the end of \"excavated\", 2 of 4 (15 … 85 %) by what comes after"));
  study.since = study.before = "";
  EXPECT_THAT(lines(study)[2],
              StartsWith("light: fallen_area_m2 > 1; stage.quake.scale = 3: 3 of 4 (30 … 95 %) "));
}

TEST(Findings, GiveTheMedianOfACurve) {
  std::vector<std::array<double, 3>> added;
  for (int r = 0; r < 40; ++r) added.push_back({r < 4 ? 2.0 : 0.0, r < 14 ? 2.0 : 0.0, r < 30 ? 2.0 : 0.0});
  const StudyData study = shaken(std::vector<double>(40, 0.0), added);
  EXPECT_THAT(lines(study).back(),
              testing::MatchesRegex("curve of light over PGA: median θ 4.* \\(.* … .*\\) m/s², β 0.* \\(.* … "
                                    ".*\\), for this record only"));
}

TEST(Findings, NameRunsWhoseEnergiesDoNotBalance) {
  StudyData study = shaken({3.0, 2.0, 0.0, 0.0}, {{0, 0, 0}, {0, 0, 1.5}, {0, 1.5, 2}, {0, 0, 0}});
  const std::size_t count = lines(study).size();
  study.runs[1].energy_residual_ratio = 0.02;
  ASSERT_EQ(lines(study).size(), count + 1);
  EXPECT_THAT(lines(study).back(), StartsWith("1 of "));
  EXPECT_THAT(lines(study).back(),
              HasSubstr("runs: the balance of energies misses more than 1 %, " + study.runs[1].key));
  study.runs[2].energy_residual_ratio = 0.03;
  EXPECT_THAT(lines(study).back(), HasSubstr(" and others; see runs.csv"));
}

}  // namespace
}  // namespace keyblock::study
