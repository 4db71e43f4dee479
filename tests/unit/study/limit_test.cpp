#include "study/limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/checked_json.h"
#include "core/error.h"

namespace keyblock::study {
namespace {

using simulation::Standing;
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

TEST(LimitCriterion, HoldsByTheLastStage) {
  const auto met = [](const char* name, std::optional<double> above, const RunResult& run) {
    return limit_trial(limit_criterion(name, above, 0.01), 1.0, run).met;
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

TEST(LimitCriterion, RefusesWhatItDoesNotKnow) {
  const auto message = [](const char* name, std::optional<double> above) -> std::string {
    try {
      limit_criterion(name, above, 0.01);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("falen", {}),
              HasSubstr("--until: found \"falen\"; expected fallen, moved, collapsed or a measure"));
  EXPECT_THAT(message("falen", {}), HasSubstr("did you mean 'fallen'?"));
  EXPECT_THAT(message("collapsed", 1.0), HasSubstr("--above: found 1"));
}

LimitResult result_of(const std::vector<Bisection::State>& states) {
  LimitResult result;
  result.request = {"joints.friction",
                    40.0,
                    0.0,
                    limit_criterion("fallen", 0.5, 0.01),
                    0.02,
                    static_cast<int>(states.size())};
  result.complete = true;
  for (std::size_t k = 0; k < states.size(); ++k)
    result.realizations.push_back({static_cast<int>(k), states[k], {}, {}});
  return result;
}

TEST(Limit, MedianCountsLimitsBeyondTheEndsAsThese) {
  LimitResult result = result_of({{Status::found, 20.0, 19.0, {}},
                                  {Status::met_at_both, 0.0, 0.0, {}},
                                  {Status::met_at_none, 0.0, 0.0, {}},
                                  {Status::found, 12.0, 11.0, {}},
                                  {Status::found, 31.0, 30.0, {}}});
  EXPECT_EQ(result.median().value, 19.5);
  EXPECT_GE(result.median().low, 0.0);
  EXPECT_LE(result.median().high, 40.0);
  EXPECT_LT(result.median().low, result.median().high);
  const std::string text = limit_text(result);
  EXPECT_THAT(text, HasSubstr("joints.friction until fallen area of more than 0.5 m²\n"));
  EXPECT_THAT(text, HasSubstr("realization 1: met at --from 40 already\n"));
  EXPECT_THAT(text, HasSubstr("realization 2: not met up to --to 0\n"));
  EXPECT_THAT(text, HasSubstr("limits of 3 of 5 realizations: median 19.5 (95 % interval "));
  result.realizations[0].error = "a crash";
  EXPECT_EQ(result.median().value, 0.5 * (11.5 + 30.5));
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
}

}  // namespace
}  // namespace keyblock::study
