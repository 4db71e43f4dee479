#include "study/until.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/distributions.h"

namespace keyblock::study {
namespace {

/// A study of one axis with two values; the fallen area of every run.
struct Sample {
  Plan plan;
  std::vector<RunResult> runs;

  void add(int realization, const std::string& value, double area) {
    plan.runs.push_back({"", realization, {{value}}, "", true});
    RunResult& run = runs.emplace_back();
    run.stages.push_back({"after", record::StageKind::rest, 0.0, 0.0, 0.0, {}});
    run.stages.back().damage.fallen_area = area;
  }
  std::optional<int> enough(std::size_t known) const {
    std::vector<const RunResult*> results;
    for (std::size_t k = 0; k < runs.size(); ++k) results.push_back(k < known ? &runs[k] : nullptr);
    return enough_realizations(plan, results);
  }
  std::optional<int> enough() const { return enough(runs.size()); }
  std::string lacking(std::size_t known) const {
    std::vector<const RunResult*> results;
    for (std::size_t k = 0; k < runs.size(); ++k) results.push_back(k < known ? &runs[k] : nullptr);
    return lacking_precision(plan, results);
  }
};

Sample sample() {
  Sample s;
  s.plan.stage = "after";
  s.plan.until = scenario::UntilSpec{"fallen_area_m2", std::nullopt, 1.0, 2, 100};
  return s;
}

// Values ± 1 in turn: with N of them, N even, s = √(N/(N − 1)).
TEST(EnoughRealizations, FollowsTheIntervalOfTheMean) {
  Sample s = sample();
  for (int k = 0; k < 60; ++k) s.add(k, "1", 5.0 + (k % 2 == 0 ? 1.0 : -1.0));
  const auto width = [](int n) { return 2.0 * statistics::student_t(0.95, n - 1) / std::sqrt(n - 1.0); };
  int expected = 2;
  while (width(expected) > 1.0) expected += 2;
  ASSERT_TRUE(s.enough());
  EXPECT_NEAR(*s.enough(), expected, 1);  // an odd number may do as well
  const int found = *s.enough();
  // What comes later has no say; what is missing before ends the search.
  EXPECT_EQ(s.enough(static_cast<std::size_t>(found)), found);
  EXPECT_FALSE(s.enough(static_cast<std::size_t>(found - 1)));
  s.plan.until->minimum = found + 3;
  EXPECT_EQ(s.enough(), found + 3);
}

// A run without the measure is no value.
TEST(EnoughRealizations, RunsWithoutTheMeasureDoNotCount) {
  Sample s = sample();
  for (int k = 0; k < 60; ++k) s.add(k, "1", 5.0 + (k % 2 == 0 ? 1.0 : -1.0));
  const auto whole = s.enough();
  ASSERT_TRUE(whole);
  s.runs[3].stages.back().damage.fallen_area = std::nan("");
  ASSERT_TRUE(s.enough());
  EXPECT_GE(*s.enough(), *whole);
  EXPECT_LE(*s.enough(), *whole + 3);
}

TEST(EnoughRealizations, EveryCombinationMustBeNarrow) {
  Sample s = sample();
  for (int k = 0; k < 20; ++k) {
    s.add(k, "1", 5.0);
    s.add(k, "2", 5.0 + (k < 2 ? 20.0 * k : 0.0));
  }
  EXPECT_FALSE(s.enough());
  s.plan.until->width = 8.0;
  ASSERT_TRUE(s.enough());
  EXPECT_GT(*s.enough(), 5);
}

TEST(EnoughRealizations, RelativeToTheMean) {
  Sample s = sample();
  s.plan.until->width.reset();
  s.plan.until->half_width = 0.01;
  for (int k = 0; k < 5; ++k) s.add(k, "1", 5.0 + 0.001 * k);
  EXPECT_EQ(s.enough(), 2);
}

// That nothing has fallen yet is no precision of a mean; an absolute width is reached all the same.
TEST(EnoughRealizations, NoShareOfTheMeanWithoutVariation) {
  for (const double area : {0.0, 5.0}) {
    Sample s = sample();
    s.plan.until->width.reset();
    s.plan.until->half_width = 0.5;
    for (int k = 0; k < 8; ++k) s.add(k, "1", area);
    EXPECT_FALSE(s.enough());
    s.add(8, "1", area + 0.001);
    EXPECT_EQ(s.enough().has_value(), area > 0.0);
    s.plan.until->width = 1.0;
    EXPECT_EQ(s.enough(), 2);
  }
}

// Five values 4, 0, 1, 2, 9: mean 3.2, s = 3.564, t = 2.776: ± 4.425.
TEST(EnoughRealizations, IsThatOfStudentsInterval) {
  Sample s = sample();
  const double areas[] = {4.0, 0.0, 1.0, 2.0, 9.0};
  for (int k = 0; k < 5; ++k) s.add(k, "1", areas[k]);
  const auto reached = [&](std::optional<double> half_width, std::optional<double> width) {
    s.plan.until = scenario::UntilSpec{"fallen_area_m2", half_width, width, 5, 100};
    return s.enough().has_value();
  };
  EXPECT_TRUE(reached(4.43 / 3.2, std::nullopt));
  EXPECT_FALSE(reached(4.42 / 3.2, std::nullopt));
  EXPECT_TRUE(reached(std::nullopt, 8.86));
  EXPECT_FALSE(reached(std::nullopt, 8.84));
  EXPECT_TRUE(reached(0.001, 8.86));  // one of both is enough
  s.plan.until->minimum = 6;
  EXPECT_FALSE(s.enough());
  // A combination that is planned, but has no results, or none but failed ones, is not known.
  s.plan.until->minimum = 5;
  for (int k = 0; k < 5; ++k) s.add(k, "2", areas[k]);
  EXPECT_EQ(s.enough(), 5);
  EXPECT_FALSE(s.enough(5));
  for (std::size_t k = 5; k < 10; ++k) s.runs[k].error = "killed";
  EXPECT_FALSE(s.enough());
}

TEST(EnoughRealizations, FailedRunsAndVariantsHaveNoSay) {
  Sample s = sample();
  for (int k = 0; k < 4; ++k) {
    s.add(k, "1", 5.0);
    s.add(k, "1", 100.0 * k);
    s.plan.runs.back().variant = "released";
  }
  EXPECT_EQ(s.enough(), 2);
  s.runs[2].error = "killed";
  EXPECT_EQ(s.enough(), 3);
  s.plan.until.reset();
  EXPECT_FALSE(s.enough());
}

// Two values x ± d: a half width of d √2 √(1/2) t = d t, t the quantile of one degree of freedom.
TEST(LackingPrecision, IsThatOfTheWidestInterval) {
  Sample s = sample();
  s.plan.axes = {{{"rock.order"}, {{"1"}, {"2"}, {"3"}}}};
  s.plan.until->half_width = 0.1;
  s.plan.until->maximum = 2;
  for (int k = 0; k < 2; ++k) {
    s.add(k, "1", 5.0);
    s.add(k, "2", 5.0 + (k == 0 ? 1.0 : -1.0));
    s.add(k, "3", 4.0 + (k == 0 ? 0.5 : -0.5));
  }
  EXPECT_EQ(
      s.lacking(6),
      "2 of 3 combinations; fallen_area_m2 at rock.order = 2: 5 ± 12.71, a half width of 2.54 of the mean "
      "(asked for: half_width = 0.1 or width = 1)");
  EXPECT_EQ(s.lacking(5), "");  // it has not come to its end
  s.plan.until->width = 100.0;
  EXPECT_EQ(s.lacking(6), "");
  s.plan.until->width.reset();
  EXPECT_EQ(s.lacking(6),
            "3 of 3 combinations; fallen_area_m2 at rock.order = 1: all values are 5 (asked for: half_width "
            "= 0.1)");
}

}  // namespace
}  // namespace keyblock::study
