#include "study/limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/checked_json.h"
#include "core/error.h"
#include "scenario/parse.h"
#include "study/limit_statistics.h"
#include "study/limit_words.h"

namespace keyblock::study {
namespace {

using record::Standing;
using testing::HasSubstr;
using Status = Bisection::Status;

RunResult run_with(double fallen, double moved, Standing standing) {
  RunResult run;
  run.key = "r0000-0123456789";
  run.stages.emplace_back();  // an earlier stage has no say
  run.stages.back().damage.fallen_area = 99.0;
  run.stages.back().standing = Standing::collapsed;
  StageMeasures& last = run.stages.emplace_back();
  last.damage.fallen_area = fallen;
  last.damage.displacement_max = moved;
  last.standing = standing;
  return run;
}

LimitRequest request_of(const LimitCriterion& criterion, const std::string& since = "") {
  LimitRequest request;
  request.key = "joints.friction";
  request.criterion = criterion;
  request.since = since;
  return request;
}

LimitResult result_of(const std::vector<Bisection::State>& states) {
  LimitResult result;
  result.request.key = "joints.friction";
  result.request.from = 40.0;
  result.request.criterion = limit_criterion("fallen", 0.5, 0.01);
  result.request.realizations = static_cast<int>(states.size());
  result.complete = true;
  for (std::size_t k = 0; k < states.size(); ++k)
    result.realizations.push_back({static_cast<int>(k), states[k], {}, {}});
  return result;
}

TEST(LimitCriterion, HoldsByTheLastStage) {
  const auto met = [](const char* name, std::optional<double> above, const RunResult& run) {
    return limit_trial(request_of(limit_criterion(name, above, 0.01)), 1.0, run).met;
  };
  const RunResult still = run_with(0.0, 0.01, Standing::stands);
  const RunResult fallen = run_with(0.4, 0.02, Standing::collapsed);
  EXPECT_FALSE(met("fallen", {}, still));
  EXPECT_TRUE(met("fallen", {}, fallen));
  EXPECT_FALSE(met("fallen", 0.4, fallen));
  EXPECT_FALSE(met("moved", {}, still));
  EXPECT_TRUE(met("moved", {}, fallen));
  EXPECT_FALSE(met("moved", 0.02, fallen));
  EXPECT_TRUE(met("displacement_max_m", 0.015, fallen));
  EXPECT_FALSE(met("collapsed", {}, still));
  for (const Standing standing : {Standing::collapsed, Standing::moves, Standing::unsettled})
    EXPECT_TRUE(met("collapsed", {}, run_with(0.0, 0.0, standing)));
}

TEST(LimitCriterion, WhatAStaticStageCallsMovingIsBeyondAnyDistance) {
  RunResult run = run_with(0.0, 1e-4, Standing::moves);
  run.stages.back().kind = record::StageKind::settle;
  const auto met = [&](const char* name, std::optional<double> above) {
    return limit_trial(request_of(limit_criterion(name, above, 0.01)), 1.0, run).met;
  };
  EXPECT_TRUE(met("moved", 5.0));
  EXPECT_TRUE(met("displacement_max_m", 5.0));
  EXPECT_FALSE(met("fallen", {}));
  // It slides a while, and is caught.
  run.stages.emplace_back();
  run.stages.back().kind = record::StageKind::rest;
  run.stages.back().damage.displacement_max = 0.4;
  EXPECT_TRUE(met("collapsed", {}));
  // A later static stage finds that it is held.
  run.stages.back().kind = record::StageKind::settle;
  EXPECT_FALSE(met("collapsed", {}));
}

TEST(LimitCriterion, RockingIsNoCollapse) {
  const RunResult run = run_with(0.0, 0.005, Standing::rocks);
  EXPECT_FALSE(limit_trial(request_of(limit_criterion("collapsed", {}, 0.01)), 1.0, run).met);
}

scenario::Scenario scenario_of(const std::string& more) {
  return scenario::parse_scenario_text(
      "[domain]\nx = [0, 20]\ny = [0, 20]\n[rock]\ndensity = 2600\nyoung = 1e9\npoisson = 0.2\n"
      "[joints]\nfriction = 30\n[time]\nstep = 0.01\n"
      "[[motion]]\nname = \"sine\"\nx = { amplitude = 1.0, frequency = 2.0, cycles = 1 }\n" +
          more,
      "s.toml", {}, scenario::StudyTable::leave_out);
}

TEST(LimitCriterion, IsThatOfTheModel) {
  const std::string
      hole = "[[excavation]]\nname = \"hole\"\nshape = \"circle\"\ncenter = [10, 10]\ndiameter = 4\n",
      cut =
          "[[excavation]]\nname = \"cut\"\nshape = \"polygon\"\n"
          "outer = [[0, 10], [8, 10], [12, 20], [0, 20]]\n",
      settle = "[[stage]]\nname = \"a\"\nkind = \"settle\"\n",
      shake = "[[stage]]\nname = \"b\"\nkind = \"shake\"\nmotion = \"sine\"\n",
      rest = "[[stage]]\nname = \"c\"\nkind = \"rest\"\nduration = 1.0\n";
  using Parts = std::vector<std::string>;
  for (const auto& [parts, model, criterion, waits] :
       {std::tuple{Parts{settle}, LimitModel::structure, "collapsed", false},
        {Parts{settle, shake}, LimitModel::structure, "collapsed", true},
        {Parts{settle, shake, rest}, LimitModel::structure, "collapsed", true},
        {Parts{settle, shake, rest, "until = \"still\"\n"}, LimitModel::structure, "collapsed", false},
        {Parts{cut, settle}, LimitModel::slope, "collapsed", false},
        {Parts{cut, settle, rest}, LimitModel::slope, "collapsed", false},
        {Parts{cut, settle, shake, rest}, LimitModel::slope, "moved", false},
        {Parts{hole, settle}, LimitModel::tunnel, "collapsed", false},
        {Parts{hole, settle, rest}, LimitModel::tunnel, "fallen", false},
        {Parts{hole, settle, shake}, LimitModel::tunnel, "fallen", false},
        {Parts{hole, cut, settle}, LimitModel::slope, "collapsed", false}}) {
    std::string text;
    for (const std::string& part : parts) text += part;
    const scenario::Scenario scenario = scenario_of(text);
    EXPECT_EQ(limit_model(scenario), model) << text;
    const LimitDefault& row = limit_default(scenario);
    EXPECT_STREQ(row.criterion, criterion) << text;
    EXPECT_EQ(needs_rest(limit_criterion(row.criterion, {}, 0.01), scenario), waits) << text;
  }
}

TEST(LimitCriterion, ScansKeysOfAMotion) {
  EXPECT_EQ(scan_of("stage.shaken.scale"), 8);
  EXPECT_EQ(scan_of("stage[1].scale"), 8);
  EXPECT_EQ(scan_of("motion.sine.x.amplitude"), 8);
  EXPECT_EQ(scan_of("joints.friction"), 1);
  EXPECT_EQ(scan_of("stage.cut.k_h"), 1);
}

TEST(LimitWords, TheAnswerIsASentenceWithUnits) {
  LimitResult result = result_of({{Status::found, 7812.5, 7031.25, {}, {{7812.5, 7031.25}}}});
  result.request.key = "excavation.tunnel.pressure";
  result.unit = "Pa";
  result.realizations[0].trials = {
      {7812.5, "r0000-a", 0.0, Standing::stands, false, "1"},
      {7031.25, "r0000-b", 0.7, Standing::fallen, true, "2", {1, 292, 7200.0, 7200.0, 1.5}}};
  EXPECT_EQ(
      answer_text(result),
      "The support pressure that “tunnel” needs is 7.42 kPa: at 7.81 kPa no rock falls, at 7.03 kPa fallen "
      "area is 0.7 m² and block 292 (7.2 kN/m) has fallen.");
  result.request.criterion = limit_criterion("collapsed", {}, 0.01);
  result.request.key = "stage.shaken.scale";
  result.request.from = 0.0;
  result.request.to = 8.0;
  result.unit = "";
  result.realizations[0] = {0, {Status::found, 4.0, 4.1, {}, {{4.0, 4.1}, {7.0, 6.9}}}, {}, {}};
  result.realizations[0].trials = {
      {4.0, "r0000-a", 0.0, Standing::stands, false, "1"},
      {4.1, "r0000-b", 0.7, Standing::collapsed, true, "2", {2, 1, 5e4, 3e4, 1.5}, "upper", 16.4}};
  EXPECT_EQ(
      answer_text(result),
      "The scale of the motion at the limit is 4.05 (PGA 16.2 m/s²): at 4 the blocks stand, at 4.1 2 blocks "
      "(50 "
      "kN/m) have fallen, the heaviest “upper” (30 kN/m). There are 2 limits: beyond the first the criterion "
      "ceases to hold at 6.95.");
  result.request.scan = 8;
  EXPECT_NE(answer_text(result).find(" The scan looked every 1: what holds in a narrower range is not seen"),
            std::string::npos);
}

TEST(LimitWords, WhereNothingFallsItIsSaidWhatMoves) {
  LimitResult result = result_of({{Status::met_at_none, 0.0, 0.0, {}}});
  result.realizations[0].trials = {
      {40.0, "r0000-a", 0.0, Standing::stands, false, "1"},
      {0.0, "r0000-b", 0.0, Standing::moves, false, "2", {1, 3, 693e3, 693e3, 0.1}}};
  result.realizations[0].moves = result.realizations[0].trials[1];
  result.unit = "°";
  EXPECT_EQ(not_met_hint(result), "at 0° already block 3 (693 kN/m) moves; --until collapsed asks for that");
  EXPECT_EQ(
      answer_text(result),
      "not met up to --to 0°. But at 0° already block 3 (693 kN/m) moves; --until collapsed asks for that.");
}

TEST(LimitCriterion, RefusesWhatItDoesNotKnow) {
  const auto message = [](const char* name, std::optional<double> above) -> std::string {
    try {
      limit_criterion(name, above, 0.01);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(
      message("falen", {}),
      HasSubstr("--until: found \"falen\"; expected fallen, moved, collapsed, gives_way or a measure"));
  EXPECT_THAT(message("falen", {}), HasSubstr("did you mean 'fallen'?"));
  EXPECT_THAT(message("collapsed", 1.0), HasSubstr("--above: found 1"));
}

// What moves has given way, before it falls: by a share of the block size, or by a length.
TEST(LimitCriterion, GivesWay) {
  RunResult run = run_with(0.0, 0.0, Standing::stands);
  run.block_size = 2.0;
  const auto met = [&](double moved, Standing standing, std::optional<double> above) {
    run.stages.back().damage.stage_displacement = moved;
    run.stages.back().standing = standing;
    return limit_trial(request_of(limit_criterion("gives_way", above, 0.01)), 1.0, run).met;
  };
  EXPECT_FALSE(met(0.0039, Standing::stands, {}));
  EXPECT_TRUE(met(0.0041, Standing::stands, {}));
  EXPECT_FALSE(met(0.0041, Standing::stands, 0.01));
  EXPECT_FALSE(met(0.0039, Standing::rocks, {}));
  for (const Standing standing :
       {Standing::collapsed, Standing::moves, Standing::unsettled, Standing::unstable})
    EXPECT_TRUE(met(0.0, standing, {}));
}

// What gravity brought down by the end of a stage does not count from there on.
TEST(LimitCriterion, CountsSinceAStage) {
  RunResult run = run_with(99.4, 0.0, Standing::collapsed);
  run.stages[0].name = "settled";
  const LimitCriterion criterion = limit_criterion("fallen", 0.5, 0.01);
  EXPECT_TRUE(limit_trial(request_of(criterion), 1.0, run).met);
  EXPECT_FALSE(limit_trial(request_of(criterion, "settled"), 1.0, run).met);
  EXPECT_NEAR(limit_trial(request_of(criterion, "settled"), 1.0, run).measure, 0.4, 1e-9);
}

/// Friction angles from 40° on downwards: one more than is searched, one less, and four that are found.
LimitResult six_limits() {
  return result_of({{Status::found, 20.0, 19.0, {}},
                    {Status::met_at_both, 0.0, 0.0, {}},
                    {Status::met_at_none, 0.0, 0.0, {}},
                    {Status::found, 12.0, 11.0, {}},
                    {Status::found, 31.0, 30.0, {}},
                    {Status::found, 22.0, 21.0, {}}});
}

TEST(Limit, QuantilesCountLimitsBeyondTheEndsAsThese) {
  LimitResult result = six_limits();
  EXPECT_EQ(result.median().limit.value, 20.5);
  EXPECT_FALSE(result.median().at_least || result.median().at_most);
  EXPECT_EQ(result.median().limit.low, 0.0);
  EXPECT_EQ(result.median().limit.high, 40.0);
  const auto quantiles = result.quantiles();
  ASSERT_EQ(quantiles.size(), 5u);
  EXPECT_EQ(quantiles[4].p, 0.95);
  EXPECT_NEAR(quantiles[4].limit.value, 30.5 + 0.75 * 9.5, 1e-12);
  EXPECT_TRUE(quantiles[4].at_least);  // a limit above 40 has a part in it
  EXPECT_FALSE(quantiles[4].at_most);
  EXPECT_TRUE(quantiles[0].at_most);
  EXPECT_EQ(quantiles[4].limit.high, HUGE_VAL);
  const std::string text = limit_text(result);
  EXPECT_THAT(text, HasSubstr("joints.friction until fallen area of more than 0.5 m²\n"));
  EXPECT_THAT(text, HasSubstr("realization 1: met at --from 40 already\n"));
  EXPECT_THAT(text, HasSubstr("realization 2: not met up to --to 0\n"));
  EXPECT_THAT(text, HasSubstr("limits of 4 of 6 realizations: median 20.5 (95 % interval ≤ 0 … ≥ 40)\n"));
  EXPECT_THAT(text, HasSubstr("95 % ≥ 37.625 ("));
  EXPECT_THAT(text, HasSubstr(" … ?)\n"));
  result.realizations[0].error = "a crash";
  EXPECT_EQ(result.median().limit.value, 21.5);
  EXPECT_EQ(result.median().limit.low, -HUGE_VAL);  // five are too few
}

TEST(Limit, AMedianOfLimitsBeyondAnEndIsABound) {
  const LimitResult above = result_of({{Status::met_at_both, 0.0, 0.0, {}},
                                       {Status::met_at_both, 0.0, 0.0, {}},
                                       {Status::found, 12.0, 11.0, {}}});
  EXPECT_THAT(limit_text(above), HasSubstr("median ≥ 40\n"));
  EXPECT_EQ(nlohmann::json::parse(limit_json(above)).at("median").at("bound"), "at least");
  // The middle one of three has no part in the others.
  const LimitResult middle = result_of({{Status::met_at_both, 0.0, 0.0, {}},
                                        {Status::met_at_none, 0.0, 0.0, {}},
                                        {Status::found, 12.0, 11.0, {}}});
  EXPECT_THAT(limit_text(middle), HasSubstr("median 11.5\n"));
  EXPECT_TRUE(nlohmann::json::parse(limit_json(middle)).at("median").at("bound").is_null());
  const LimitResult both =
      result_of({{Status::met_at_both, 0.0, 0.0, {}}, {Status::met_at_none, 0.0, 0.0, {}}});
  EXPECT_THAT(limit_text(both), HasSubstr("median ?\n"));
}

TEST(Limit, SharesGoFromOneEndToTheOther) {
  const std::vector<LimitShare> shares = six_limits().met_shares();
  std::vector<double> values, met;
  for (const LimitShare& step : shares) {
    values.push_back(step.value);
    met.push_back(6.0 * step.share.value);
    EXPECT_LT(step.share.low, step.share.value);
    EXPECT_GT(step.share.high, step.share.value);
  }
  EXPECT_THAT(values, testing::ElementsAre(40.0, 30.5, 21.5, 19.5, 11.5));
  EXPECT_THAT(met, testing::ElementsAre(1.0, 2.0, 3.0, 4.0, 5.0));
  LimitResult rising = result_of({{Status::found, 10.0, 11.0, {}}, {Status::found, 20.0, 21.0, {}}});
  std::swap(rising.request.from, rising.request.to);
  ASSERT_EQ(rising.met_shares().size(), 3u);
  EXPECT_EQ(rising.met_shares()[0].value, 0.0);
  EXPECT_EQ(rising.met_shares()[0].share.value, 0.0);
  EXPECT_EQ(rising.met_shares()[1].value, 10.5);
  EXPECT_EQ(rising.met_shares()[2].share.value, 1.0);
  EXPECT_TRUE(result_of({{Status::open, 0.0, 0.0, {}}}).met_shares().empty());
}

TEST(Limit, TableHasARowForEachRealization) {
  LimitResult result = result_of({{Status::found, 20.0, 19.0, {}}, {Status::met_at_none, 0.0, 0.0, {}}});
  result.realizations[0].trials = {{20.0, "r0000-a", 0.1, Standing::stands, false, "1"},
                                   {19.0, "r0000-b", 0.7, Standing::collapsed, true, "2"}};
  EXPECT_EQ(limit_csv(result),
            "realization,status,not_met,met,limit,runs,just_beyond\n"
            "0,found,20,19,19.5,2,runs/r0000-b\n"
            "1,met at no end,,,,0,\n");
}

TEST(Limit, JsonHasBracketsAndRuns) {
  LimitResult result = result_of({{Status::found, 20.0, 19.0, {}}});
  result.realizations[0].trials = {{20.0, "r0000-a", 0.1, Standing::stands, false, "1"},
                                   {19.0, "r0000-b", 0.7, Standing::collapsed, true, "2"}};
  const auto json = nlohmann::ordered_json::parse(limit_json(result));
  EXPECT_EQ(json.at("above"), 0.5);
  const auto& limit = json.at("realizations").at(0);
  EXPECT_EQ(limit.at("bracket").at("not_met"), 20.0);
  EXPECT_EQ(limit.at("bracket").at("met"), 19.0);
  EXPECT_EQ(limit.at("limit"), 19.5);
  EXPECT_EQ(limit.at("just_beyond"), "runs/r0000-b");
  EXPECT_EQ(limit.at("trials").at(1).at("standing"), "collapsed");
  EXPECT_TRUE(json.at("median").at("interval").is_null());
  EXPECT_TRUE(json.at("median").at("bound").is_null());
  EXPECT_TRUE(json.at("since").is_null());
  EXPECT_EQ(json.at("quantiles").at(2).at("value"), 19.5);
  EXPECT_TRUE(json.at("quantiles").at(2).at("low").is_null());
  EXPECT_EQ(json.at("met_share").at("value"), (std::vector<double>{40.0, 19.5}));
}

LimitResult factors(const std::vector<double>& values) {
  std::vector<Bisection::State> states;
  for (const double value : values) states.push_back({Status::found, value - 0.01, value + 0.01});
  LimitResult result = result_of(states);
  result.request.key = safety_key;
  result.request.from = 0.5;
  result.request.to = 2.0;
  return result;
}

/// By hand: mean 1.125, s = 0.15; t of 3 degrees of freedom 3.18245; Wilson of 1 of 4: 0.045587 … 0.699358.
TEST(LimitStatistics, HaveMeanAndProbabilityOfFailureWithIntervals) {
  LimitResult result = factors({0.975, 1.025, 1.225, 1.275});
  const LimitMean mean = mean_limit(result);
  EXPECT_NEAR(mean.mean.value, 1.125, 1e-12);
  EXPECT_NEAR(mean.standard_deviation, 0.147196, 1e-6);
  EXPECT_NEAR(mean.mean.high, 1.125 + 3.182446 * 0.147196 / 2.0, 1e-5);
  const auto failure = failure_share(result);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->below, 1U);
  EXPECT_NEAR(failure->share.low, 0.045587, 1e-6);
  EXPECT_NEAR(failure->share.high, 0.699358, 1e-6);
  result.realizations[3].state = {Status::met_at_none};
  EXPECT_TRUE(mean_limit(result).at_least);
  EXPECT_TRUE(std::isnan(mean_limit(result).mean.low));
  EXPECT_EQ(failure_share(result)->below, 1U);
  result.request.from = 1.1;
  EXPECT_FALSE(failure_share(result)) << "1 is beyond the search";
  result.request.key = "joints.friction";
  EXPECT_FALSE(failure_share(result));
}

TEST(LimitStatistics, KnowWhichStrengthsTheLimitsHangOn) {
  std::vector<double> values;
  for (int k = 0; k < 36; ++k) {
    const int row = k / 6;
    values.push_back(1.0 + 0.02 * (k % 6) + 0.001 * row);
  }
  LimitResult result = factors(values);
  for (int k = 0; k < 36; ++k)
    result.realizations[static_cast<std::size_t>(k)].strengths = {{"bedding.cohesion", k / 6},
                                                                  {"bedding.friction", k % 6}};
  const auto found = dependences(result);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].strength, "bedding.friction");
  EXPECT_GT(found[0].first_order.value, 0.99);
  EXPECT_LT(found[1].first_order.value, 0.1);
  EXPECT_EQ(strength_title("bedding.residual_friction"), "residual friction of “bedding”");
  const auto json = nlohmann::json::parse(limit_json(result));
  EXPECT_EQ(json["hangs_on"][0]["strength"], "bedding.friction");
  EXPECT_EQ(json["realizations"][7]["strengths"]["bedding.cohesion"], 1.0);
  EXPECT_THAT(limit_csv(result), HasSubstr(",just_beyond,bedding.cohesion,bedding.friction\n"));
  EXPECT_THAT(statistics_csv(result), HasSubstr("\nfirst-order index of bedding.friction,"));
}

}  // namespace
}  // namespace keyblock::study
