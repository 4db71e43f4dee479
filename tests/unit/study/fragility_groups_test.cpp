#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "made_run.h"
#include "statistics/proportion.h"
#include "study/fragility_words.h"
#include "study/summaries.h"

namespace keyblock::study {
namespace {

// Motions are records of one curve, by their names.
TEST(FragilityGroups, KnowTheRecordsOfRuns) {
  StudyData study;
  study.axes = {{"stage.quake.motion", {"\"a\"", "\"b\""}}, {"stage.quake.scale", {"1", "2", "3"}}};
  study.levels = {{"any", "fallen_area_m2", 0.1}};
  for (int r = 0; r < 40; ++r) {
    for (int j = 0; j < 2; ++j) {
      for (int s = 0; s < 3; ++s) {
        const bool falls = (7 * r % 40) + 4 * j < 4 + 14 * s;
        study.runs.push_back(made_run(r,
                                      {study.axes[0].values[static_cast<std::size_t>(j)],
                                       study.axes[1].values[static_cast<std::size_t>(s)]},
                                      1.0 + s, falls ? 1.0 : 0.0));
        study.runs.back().stages[1].record = j == 0 ? "a" : "b";
      }
    }
  }
  const Summary summary = summarize(study);
  const statistics::FragilityCurve& curve = summary.fragility[0].curve;
  EXPECT_EQ(curve.records, 2U);
  EXPECT_EQ(curve.pairs, 80U);
  EXPECT_EQ(curve.refits.records.size(), 2U);
  EXPECT_EQ(for_which_records(curve),
            "over 2 records, which are few: the intervals are wide for that reason");
  for (RunResult& run : study.runs) run.stages[1].record = "a";
  const Summary one = summarize(study);
  EXPECT_EQ(for_which_records(one.fragility[0].curve), "for this record only");
  EXPECT_LT(one.fragility[0].curve.theta.high, curve.theta.high);
}

// An axis is one of shaking by what it does, not only by its name; curves go through all others apart.
TEST(FragilityGroups, FragilityGroupsDifferInShakingAlone) {
  StudyData study;
  study.axes = {{"joints.friction", {"30", "40"}}, {"motion.m.window", {"[0, 1]", "[0, 2]", "[0, 3]"}}};
  study.levels = {{"any", "fallen_area_m2", 0.1}, {"unknown", "no_such_measure", 0.1}};
  for (int r = 0; r < 40; ++r)
    for (const char* friction : {"30", "40"})
      for (int w = 0; w < 3; ++w)
        study.runs.push_back(made_run(r, {friction, study.axes[1].values[static_cast<std::size_t>(w)]},
                                      1.0 + w,
                                      (r * 7 % 40) < 8 + 10 * w + (friction[0] == '3' ? 5 : 0) ? 1.0 : 0.0));
  const Summary summary = summarize(study);
  EXPECT_EQ(summary.shaking_axis, (std::vector<bool>{false, true}));
  ASSERT_EQ(summary.fragility.size(), 6U);  // 1 level, 3 intensities, 2 groups
  const FragilityGroup& weak = summary.fragility[0];
  EXPECT_EQ(weak.values, (std::vector<std::string>{"30", ""}));
  EXPECT_EQ(weak.combinations, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(weak.curve.status, statistics::FragilityStatus::fitted);
  EXPECT_EQ(weak.curve.clusters, 40U);
  ASSERT_EQ(weak.points.size(), 3U);
  EXPECT_DOUBLE_EQ(weak.points[0].value, 13.0 / 40.0);
  EXPECT_LT(weak.curve.theta.value, summary.fragility[1].curve.theta.value);
  EXPECT_FALSE(weak.curve.intensity.empty());
  // PGV was zero everywhere: no curve, and it says why.
  EXPECT_EQ(summary.fragility[2].curve.status, statistics::FragilityStatus::no_data);
  EXPECT_EQ(summary.fragility[2].curve.at_rest.runs, 120.0);
}

// A curve goes through shakings of one rock: what changes both is no axis of shaking.
TEST(FragilityGroups, AnAxisThatChangesTheRockIsNoneOfShaking) {
  const auto shaking = [](Axis axis) {
    StudyData study;
    study.axes = {std::move(axis)};
    study.levels = {{"any", "fallen_area_m2", 0.1}};
    for (int r = 0; r < 4; ++r) {
      study.runs.push_back(made_run(r, {"1"}, 1.0, 0.0));
      study.runs.push_back(made_run(r, {"2"}, 2.0, 1.0));
    }
    const Summary summary = summarize(study);
    EXPECT_EQ(summary.fragility.empty(), !summary.shaking_axis[0]);
    return static_cast<bool>(summary.shaking_axis[0]);
  };
  EXPECT_TRUE(shaking({"stage.quake.duration", {"1", "2"}}));
  EXPECT_TRUE(shaking({"motion.'m'.x.amplitude", {"1", "2"}}));
  EXPECT_TRUE(shaking({"stage[1].scale", {"1", "2"}}));
  EXPECT_FALSE(shaking({"section.azimuth", {"1", "2"}}));
  EXPECT_FALSE(shaking({"stages.scale", {"1", "2"}}));
  EXPECT_TRUE(shaking({"stage.a.scale + stage.b.scale", {"1", "2"}, {"stage.a.scale", "stage.b.scale"}}));
  EXPECT_FALSE(shaking({"rock.order + stage.a.scale", {"1", "2"}, {"rock.order", "stage.a.scale"}}));
}

// Shaken twice at the same intensity, ten realizations are still ten.
TEST(FragilityGroups, PointsCountRealizationsNotRuns) {
  StudyData study;
  study.axes = {{"stage.quake.motion", {"'a'", "'b'", "'c'"}}};
  study.levels = {{"any", "fallen_area_m2", 0.1}};
  for (int r = 0; r < 10; ++r) {
    study.runs.push_back(made_run(r, {"'a'"}, 1.0, r < 5 ? 1.0 : 0.0));
    study.runs.push_back(made_run(r, {"'b'"}, 1.0, r < 5 ? 1.0 : 0.0));
    study.runs.push_back(made_run(r, {"'c'"}, 2.0, r < 8 ? 1.0 : 0.0));
  }
  const Summary summary = summarize(study);
  const FragilityGroup& group = summary.fragility.at(0);
  ASSERT_EQ(group.points.size(), 2U);
  EXPECT_EQ(group.curve.stripes[0].runs, 20.0);
  const statistics::Estimate ten = statistics::proportion(5, 10, study.confidence);
  EXPECT_DOUBLE_EQ(group.points[0].value, 0.5);
  EXPECT_DOUBLE_EQ(group.points[0].low, ten.low);
  EXPECT_DOUBLE_EQ(group.points[0].high, ten.high);
  EXPECT_DOUBLE_EQ(group.points[1].low, statistics::proportion(8, 10, study.confidence).low);
}

// Counted from the start, two of five realizations fall without any shaking; counted from the shaking on, none does.
TEST(FragilityGroups, WhatFallsBeforeTheShakingIsNoPointOfACurve) {
  std::vector<double> gravity;
  std::vector<std::array<double, 3>> added;
  for (int r = 0; r < 40; ++r) {
    gravity.push_back(r % 5 < 2 ? 2.0 : 0.0);
    added.push_back({r % 8 < 1 ? 2.0 : 0.0, r % 8 < 3 ? 2.0 : 0.0, r % 8 < 6 ? 2.0 : 0.0});
  }
  StudyData study = shaken(gravity, added);
  const FragilityGroup by_shaking = summarize(study).fragility.at(0);
  EXPECT_EQ(by_shaking.curve.status, statistics::FragilityStatus::fitted);
  EXPECT_EQ(by_shaking.curve.at_rest.runs, 0.0);
  EXPECT_EQ(why_no_curve(study, by_shaking), "");
  study.since = "";
  const FragilityGroup in_all = summarize(study).fragility.at(0);
  EXPECT_EQ(in_all.curve.status, statistics::FragilityStatus::exceeded_at_rest);
  EXPECT_EQ(in_all.curve.at_rest.runs, 40.0);
  EXPECT_EQ(in_all.points.size(), 3U);
  EXPECT_EQ(why_no_curve(study, in_all),
            "the level is exceeded without shaking in 16 of 40 cases, where a lognormal curve is zero");
}

// A curve over the square of an intensity is the same curve.
TEST(FragilityGroups, WhetherThereIsACurveDoesNotHangOnTheIntensity) {
  EXPECT_EQ(fragility_limits(intensities()[2]).widest_theta,
            std::pow(fragility_limits(intensities()[0]).widest_theta, 2));
  std::vector<std::array<double, 3>> added;
  for (int r = 0; r < 20; ++r) added.push_back({r < 1 ? 2.0 : 0.0, r < 4 ? 2.0 : 0.0, r < 9 ? 2.0 : 0.0});
  const Summary summary = summarize(shaken(std::vector<double>(20, 0.0), added));
  const auto &pga = summary.fragility.at(0).curve, &arias = summary.fragility.at(2).curve;
  EXPECT_NEAR(arias.theta.high / arias.theta.low, std::pow(pga.theta.high / pga.theta.low, 2), 1e-3);
  EXPECT_EQ(arias.status, pga.status);
}

TEST(FragilityGroups, ACurveThatIsNotThereSaysWhy) {
  const auto why = [](const std::array<double, 3>& k, std::size_t realizations = 20) {
    std::vector<std::array<double, 3>> added;
    for (std::size_t r = 0; r < realizations; ++r) {
      const auto x = static_cast<double>(r);
      added.push_back({x < k[0] ? 2.0 : 0.0, x < k[1] ? 2.0 : 0.0, x < k[2] ? 2.0 : 0.0});
    }
    const StudyData study = shaken(std::vector<double>(realizations, 0.0), added);
    return why_no_curve(study, summarize(study).fragility.at(0));
  };
  EXPECT_EQ(why({0, 0, 1}), "the level is exceeded at the strongest shaking only (1 of 20 runs at 6 m/s²)");
  EXPECT_EQ(why({19, 20, 20}),
            "every run exceeds the level, except at the weakest shaking (19 of 20 runs at 2 m/s²)");
  EXPECT_EQ(why({0, 7, 20}), "no run exceeds the level up to 2 m/s², and every run does from 6 m/s² on");
  EXPECT_EQ(why({0, 0, 0}), "no run exceeds the level");
  EXPECT_EQ(why({5, 5, 5}), "more shaking does not go with more damage");
  EXPECT_EQ(why({1, 2, 3}, 4), "4 realizations are too few for an interval of the median; 5 give one");
  EXPECT_THAT(why({9, 10, 12}), testing::MatchesRegex("the 95 % interval of the median θ spans .* … .* m/s²"
                                                      ", more than a factor of 4"));
}

}  // namespace
}  // namespace keyblock::study
