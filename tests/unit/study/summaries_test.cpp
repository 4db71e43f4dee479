#include "study/summaries.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/checked_json.h"
#include "made_run.h"
#include "record/damage_fields.h"
#include "statistics/proportion.h"
#include "study/study_json.h"
#include "synthetic_study.h"

namespace keyblock::study {
namespace {

StudyData small() {
  StudyData study;
  study.axes = {{"joints.friction", {"30", "40"}}};
  study.levels = {{"light", "fallen_area_m2", 1.0}};
  study.stage = "quake";
  const double fallen[] = {4.0, 0.0, 1.0, 2.0, 9.0};
  for (int r = 0; r < 5; ++r) study.runs.push_back(made_run(r, {"30"}, 2.0, fallen[r]));
  study.runs.push_back(made_run(0, {"40"}, 2.0, 0.5));
  study.runs.push_back(made_run(1, {"40"}, 2.0, 0.0));
  study.runs.back().error = "killed";
  return study;
}

TEST(Summaries, DescribeEachCombinationByHand) {
  const StudyData study = small();
  const Summary summary = summarize(study);
  ASSERT_EQ(summary.combinations.size(), 2U);
  const Combination& c = summary.combinations[0];
  EXPECT_EQ(c.values, (std::vector<std::string>{"30"}));
  const MeasureSummary& fallen = c.measures[*find_measure("fallen_area_m2")];
  EXPECT_EQ(fallen.description.n, 5U);
  EXPECT_DOUBLE_EQ(fallen.description.mean.value, 3.2);
  EXPECT_DOUBLE_EQ(fallen.description.quantiles[2].value, 2.0);
  EXPECT_LT(fallen.description.mean.low, 3.2);
  EXPECT_GT(fallen.description.mean.high, 3.2);
  EXPECT_EQ(study.runs[*c.worst].realization, 4);
  EXPECT_EQ(study.runs[*c.median].realization, 3);
  EXPECT_EQ(c.levels[0].exceeded, 3U);  // 1.0 is not above 1.0
  EXPECT_DOUBLE_EQ(c.levels[0].probability.value, 0.6);
  // The running mean goes by realization: 4, 2, 5/3, 7/4, 16/5.
  EXPECT_DOUBLE_EQ(fallen.running.mean[3].value, 1.75);
  const Combination& other = summary.combinations[1];
  EXPECT_EQ(other.runs.size(), 1U);
  EXPECT_EQ(other.failed, 1U);
  EXPECT_EQ(summary.done, 6U);
  EXPECT_EQ(summary.failed, 1U);
  EXPECT_FALSE(summary.shaking_axis[0]);
  EXPECT_TRUE(summary.fragility.empty());
}

TEST(Summaries, AStudyWithoutRunsIsOne) {
  StudyData study;
  EXPECT_TRUE(summarize(study).combinations.empty());
  study.runs.resize(1);
  study.runs[0].error = "no memory";
  const Summary summary = summarize(study);
  ASSERT_EQ(summary.combinations.size(), 1U);
  EXPECT_EQ(summary.combinations[0].measures[0].description.n, 0U);
  EXPECT_FALSE(summary.combinations[0].worst.has_value());
}

TEST(Summaries, TheStrongestShakingUpToTheMeasuredStageCounts) {
  StudyData study = small();
  RunResult& run = study.runs[0];
  StageMeasures second = run.stages[1];
  second.name = "second quake";
  second.pga = 5.0;
  run.stages.push_back(second);
  EXPECT_EQ(measured(study, run).intensity[0], 2.0);
  study.stage = "";
  EXPECT_EQ(measured(study, run).intensity[0], 5.0);
  study.stage = "none such";
  EXPECT_FALSE(measured(study, run).damage);
}

TEST(Summaries, MeasuresMayBeginLater) {
  StudyData study = small();
  RunResult& run = study.runs[0];  // nothing in the quiet, 4 m² in the quake
  run.stages[0].damage.fallen_area = 1.5;
  run.stages[0].damage.fallen_blocks = 2;
  run.stages[1].damage.fallen_blocks = 3;
  run.stages[0].pga = 7.0;  // before it counts
  study.since = run.stages[0].name;
  const Measured added = measured(study, run);
  ASSERT_TRUE(added.damage);
  EXPECT_DOUBLE_EQ(added.damage->fallen_area, 2.5);
  EXPECT_EQ(added.damage->fallen_blocks, 1);
  EXPECT_EQ(added.intensity[0], 2.0);
  study.since = "none such";
  EXPECT_FALSE(measured(study, run).damage);
}

// The largest block fell before the quake, from the left; a smaller one in it, from the crown; another later.
TEST(Summaries, ExtremesAreOfWhatFellBetween) {
  using record::WallPart;
  StudyData study = small();
  RunResult& run = study.runs[0];
  run.stages.push_back(run.stages.back());
  run.stages.back().name = "after";
  run.fallen = {{4, "", 0, {}, 3.0, 75e3, 1.5, WallPart::left},
                {5, "", 1, {}, 0.4, 10e3, 0.9, WallPart::crown},
                {6, "", 2, {}, 2.0, 50e3, 2.5, WallPart::crown}};
  run.stages[0].damage.fallen_weight = 75e3;
  run.stages[1].damage.fallen_weight = 85e3;
  for (StageMeasures& stage : run.stages) stage.damage.largest_fallen_area = 3.0;
  study.since = "excavated";
  study.stage = "quake";
  const record::Damage damage = *measured(study, run).damage;
  EXPECT_DOUBLE_EQ(damage.fallen_weight, 10e3);
  EXPECT_DOUBLE_EQ(damage.largest_fallen_area, 0.4);
  EXPECT_DOUBLE_EQ(damage.largest_fallen_weight, 10e3);
  EXPECT_DOUBLE_EQ(damage.fallen_depth, 0.9);
  EXPECT_DOUBLE_EQ(damage.fallen_depth_crown, 0.9);
  EXPECT_EQ(damage.fallen_depth_left, 0.0);
}

TEST(Summaries, WhatTheShakingAddsIsToldFromWhatWasThereBefore) {
  StudyData study = shaken({3.0, 2.0, 0.0, 0.0}, {{0, 0, 0}, {0, 0, 1.5}, {0, 1.5, 2}, {0.4, 0.5, 0.6}});
  for (const char* since : {"excavated", ""}) {
    study.since = since;
    const Summary summary = summarize(study);
    const Combination& c = summary.combinations[2];
    ASSERT_TRUE(c.before && c.added);
    EXPECT_EQ(c.before->levels[0].exceeded, 2U);
    EXPECT_EQ(c.added->levels[0].exceeded, 2U);
    EXPECT_EQ(c.levels[0].exceeded, study.since.empty() ? 3U : 2U);
    EXPECT_EQ(c.before->levels[0].probability.high, statistics::proportion(2, 4, 0.95).high);
    const std::size_t area = *find_measure("fallen_area_m2");
    EXPECT_DOUBLE_EQ(c.before->measures[area].mean.value, 1.25);
    EXPECT_DOUBLE_EQ(c.added->measures[area].mean.value, 4.1 / 4.0);
  }
  for (RunResult& run : study.runs)
    for (StageMeasures& stage : run.stages)
      stage.damage.fallen_blocks = stage.damage.fallen_area > 0.0 ? 1 : 0;
  const Combination c = summarize(study).combinations[2];
  EXPECT_EQ(c.falls.exceeded, 4U);
  EXPECT_EQ(c.before->falls.exceeded, 2U);
  EXPECT_EQ(c.added->falls.exceeded, 2U);
  EXPECT_EQ(c.falls.n, 4U);
  study.since = study.before = "";
  EXPECT_FALSE(summarize(study).combinations[2].before);
}

// Gravity alone brings down 1.2 m² of the first rock mass, in the time of the shaking; the second has no control run.
TEST(Summaries, WhatComesDownWithoutShakingIsTakenOff) {
  StudyData study = shaken({0.5, 0.0}, {{{1.2, 1.2, 3.0}}, {{0.0, 2.0, 2.0}}});
  study.control = true;
  study.runs.push_back(made_run(0, {"0"}, 0.0, 1.7, "unshaken"));
  study.runs.back().stages[0].damage.fallen_area = 0.5;
  study.runs.back().fallen = {{4, "", 1, {}, 1.2, 3e4, 0.7, record::WallPart::crown}};
  study.runs[2].fallen = {{4, "", 1, {}, 1.2, 3e4, 0.7, record::WallPart::crown},
                          {9, "", 1, {}, 0.4, 1e4, 0.3, record::WallPart::crown}};
  study.control_of = {6, 6, 6, -1, -1, -1, -1};
  const Summary summary = summarize(study);
  EXPECT_EQ(measured(study, study.runs[0]).damage->fallen_area, 0.0);
  EXPECT_DOUBLE_EQ(measured(study, study.runs[2]).damage->fallen_area, 1.8);
  EXPECT_DOUBLE_EQ(measured(study, study.runs[2]).damage->largest_fallen_area, 0.4);
  ASSERT_EQ(summary.combinations.size(), 3U);
  for (const Combination& c : summary.combinations) EXPECT_EQ(c.runs.size(), 1U);
  EXPECT_EQ(summary.combinations[0].levels[0].exceeded, 0U);
  EXPECT_EQ(summary.combinations[2].levels[0].exceeded, 1U);
  EXPECT_EQ(summary.combination_of[6], -1);
  EXPECT_EQ(summary.failed, 3U);
  EXPECT_EQ(summary.control.realizations, 1U);
  EXPECT_EQ(summary.control.falling, 1U);
}

TEST(Summaries, MarginalIsWhatAVariantChangesByMuch) {
  StudyData study;
  study.axes = {{"rock.order", {"1"}}};
  study.marginal = MarginalCheck{3.0, 0.5};
  const auto add = [&](int r, double own, std::vector<double> others) {
    study.runs.push_back(made_run(r, {"1"}, 1.0, own));
    const char* names[] = {"friction-", "friction+", "released"};
    for (std::size_t k = 0; k < others.size(); ++k)
      study.runs.push_back(made_run(r, {"1"}, 1.0, others[k], names[k]));
  };
  add(0, 1.0, {1.9, 0.6, 1.0});   // by 47 % of the larger
  add(1, 1.0, {1.0, 0.45, 1.0});  // by 55 %
  add(2, 0.0, {0.008});           // all of it, but hardly anything
  add(3, 0.0, {0.2});
  add(4, 3.0, {});
  const Summary summary = summarize(study);
  std::vector<Marginal> own;
  for (std::size_t r = 0; r < study.runs.size(); ++r)
    if (study.runs[r].variant.empty()) own.push_back(summary.marginal[r]);
  EXPECT_EQ(own, (std::vector<Marginal>{Marginal::no, Marginal::yes, Marginal::no, Marginal::yes,
                                        Marginal::unknown}));
  EXPECT_EQ(summary.combinations[0].checked, 4U);
  EXPECT_EQ(summary.combinations[0].marginal, 2U);
  // Variants are no realizations of their own.
  EXPECT_EQ(summary.combinations[0].runs.size(), 5U);
  EXPECT_EQ(summary.combinations[0].measures[0].description.n, 5U);
}

// "no" is said only when all that was planned to be tried was tried.
TEST(Summaries, NotMarginalOnlyWhenAllVariantsWereMeasured) {
  StudyData study;
  study.axes = {{"rock.order", {"1"}}};
  study.marginal = MarginalCheck{3.0, 0.5};
  study.variants = {"friction-", "friction+", "released"};
  const auto add = [&](int r, double friction_plus, bool released) {
    study.runs.push_back(made_run(r, {"1"}, 1.0, 1.0));
    study.runs.push_back(made_run(r, {"1"}, 1.0, 1.0, "friction-"));
    study.runs.push_back(made_run(r, {"1"}, 1.0, friction_plus, "friction+"));
    if (released) study.runs.push_back(made_run(r, {"1"}, 1.0, 1.0, "released"));
  };
  add(0, 1.0, true);
  add(1, 1.0, false);  // missing
  add(2, 1.0, true);   // failed
  study.runs.back().error = "killed";
  add(3, 9.0, false);
  const Summary summary = summarize(study);
  std::vector<Marginal> own;
  for (std::size_t r = 0; r < study.runs.size(); ++r)
    if (study.runs[r].variant.empty()) own.push_back(summary.marginal[r]);
  EXPECT_EQ(own, (std::vector<Marginal>{Marginal::no, Marginal::unknown, Marginal::unknown, Marginal::yes}));
  EXPECT_EQ(summary.combinations[0].checked, 2U);
}

// What is taken off leaves no noise: equal gains are equal, and have no spread.
TEST(Summaries, EqualDifferencesAreOneValue) {
  StudyData study;
  study.axes = {{"rock.order", {"1"}}};
  study.since = "excavated";
  study.stage = "quake";
  for (int r = 0; r < 6; ++r) {
    RunResult run = made_run(r, {"1"}, 1.0, 0.0);
    run.stages[0].damage.fallen_area = 0.1 + 0.7 * r;
    run.stages[1].damage.fallen_area = run.stages[0].damage.fallen_area + 1.1;
    study.runs.push_back(run);
  }
  const Summary summary = summarize(study);
  const MeasureSummary& fallen = summary.combinations[0].measures[*find_measure("fallen_area_m2")];
  EXPECT_EQ(fallen.exceedance.value, (std::vector<double>{1.1}));
  EXPECT_EQ(fallen.description.mean.value, 1.1);
  EXPECT_EQ(fallen.description.standard_deviation.value, 0.0);
  EXPECT_EQ(fallen.description.standard_deviation.high, 0.0);
  EXPECT_EQ(fallen.running.mean.back().low, fallen.running.mean.back().high);
}

/// Fallen area is 2 · friction + cohesion, of strengths that go up and down apart from each other.
TEST(Summaries, TellWhatTheMeasureOfALevelHangsOn) {
  StudyData study;
  study.axes = {{"stage.quake.scale", {"1"}}};
  study.levels = {{"light", "fallen_area_m2", 1.0}, {"heavy", "fallen_area_m2", 9.0}};
  study.stage = "quake";
  for (int k = 0; k < 49; ++k) {
    const int row = k / 7;
    const double friction = k % 7, cohesion = row;
    study.runs.push_back(made_run(k, {"1"}, 2.0, 2.0 * friction + cohesion));
    study.runs.back().strengths = {
        {"set.cohesion", cohesion}, {"set.friction", friction}, {"set.tension", 4.0}};
  }
  const Summary summary = summarize(study);
  ASSERT_EQ(summary.combinations.at(0).hangs_on.size(), 1U) << "once for each measure";
  const auto& found = summary.combinations[0].hangs_on[0].dependences;
  ASSERT_EQ(found.size(), 2U) << "what is the same in all runs is left out";
  EXPECT_EQ(found[0].strength, "set.friction");
  EXPECT_NEAR(found[0].first_order.value, 0.8, 0.03);
  EXPECT_LT(found[1].first_order.value, 0.3);
  const auto json = nlohmann::json::parse(study_json(study, summary));
  EXPECT_EQ(json["combinations"][0]["hangs_on"][0]["measure"], "fallen_area_m2");
  EXPECT_EQ(json["combinations"][0]["hangs_on"][1]["strength"], "set.cohesion");
  EXPECT_NE(runs_csv(study, summary).find(",set.cohesion,set.friction,set.tension\n"), std::string::npos);
}

TEST(Summaries, MapsCountRunsByCell) {
  using record::BlockStatus;
  StudyData study = small();
  study.grid = {{0.0, 0.0}, 1.0, 2, 1};
  study.runs[0].map = {BlockStatus::fallen, BlockStatus::excavated};
  study.runs[1].map = {BlockStatus::loosened, BlockStatus::excavated};
  study.runs[2].map = {BlockStatus::in_place, BlockStatus::excavated};
  const Summary summary = summarize(study);
  EXPECT_EQ(summary.combinations[0].mapped, 3U);
  EXPECT_EQ(summary.combinations[0].fallen, (std::vector<int>{1, -1}));
  EXPECT_EQ(summary.combinations[0].disturbed, (std::vector<int>{2, -1}));
}

TEST(Summaries, CombinationsFollowTheAxes) {
  const StudyData study = made_up::synthetic_study();
  const Summary summary = summarize(study);
  ASSERT_EQ(summary.combinations.size(), 8U);
  EXPECT_EQ(summary.combinations[0].values, (std::vector<std::string>{"0.2", "1"}));
  EXPECT_EQ(summary.combinations[1].values, (std::vector<std::string>{"0.2", "2"}));
  EXPECT_EQ(summary.combinations[7].values, (std::vector<std::string>{"1.0", "2"}));
  EXPECT_EQ(summary.shaking_axis, (std::vector<bool>{true, false}));
  // Stronger shaking, more damage; order 2, less.
  const std::size_t area = *find_measure("fallen_area_m2");
  const auto mean = [&](std::size_t c) {
    return summary.combinations[c].measures[area].description.mean.value;
  };
  EXPECT_GT(mean(6), mean(0));
  EXPECT_GT(mean(6), mean(7));
}

// A wall point on a fallen block: of that run closure is not known.
TEST(Summarize, RunsWithoutAMeasureAreNoPartOfItsSample) {
  StudyData study = made_up::synthetic_study({.realizations = 8});
  study.levels = {{"closed", "closure_vertical_m", 0.0}};
  const std::size_t m = *find_measure("closure_vertical_m");
  const Summary before = summarize(study);
  study.runs[0].stages.back().damage.closure_vertical = std::nan("");
  const Summary summary = summarize(study);
  const Combination& c = summary.combinations[static_cast<std::size_t>(summary.combination_of[0])];
  const Combination& whole = before.combinations[static_cast<std::size_t>(summary.combination_of[0])];
  EXPECT_EQ(c.measures[m].description.n, whole.measures[m].description.n - 1);
  EXPECT_TRUE(std::isfinite(c.measures[m].description.mean.value));
  EXPECT_EQ(c.measures[m].running.n.back(), whole.measures[m].running.n.back() - 1);
  EXPECT_EQ(c.measures[0].description.n, whole.measures[0].description.n);
  EXPECT_EQ(c.levels[0].exceeded, whole.levels[0].exceeded - 1);
  EXPECT_EQ(c.levels[0].probability.value, 1.0);
  double points = 0.0, points_before = 0.0;
  for (const auto& stripe : summary.fragility[0].curve.stripes) points += stripe.runs;
  for (const auto& stripe : before.fragility[0].curve.stripes) points_before += stripe.runs;
  EXPECT_EQ(points, points_before - 1.0);
}

TEST(Measures, AreThoseOfTheSummary) {
  ASSERT_EQ(measures().size(), record::damage_names().size());
  EXPECT_EQ(measures()[0].name, "fallen_blocks");
  EXPECT_EQ(find_measure("largest_utilization"), measures().size() - 1);
  EXPECT_FALSE(find_measure("fallen").has_value());
}

TEST(Measures, PlainValuesLoseTheirQuotes) {
  EXPECT_EQ(plain_value("0.5"), "0.5");
  EXPECT_EQ(plain_value("\"weak rock\""), "weak rock");
  EXPECT_EQ(plain_value("'C:\\x'"), "C:\\x");
  EXPECT_EQ(plain_value(R"("a\"b")"), R"("a\"b")");
  EXPECT_EQ(plain_value("[1, 2]"), "[1, 2]");
}

}  // namespace
}  // namespace keyblock::study
