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
    run.stages.push_back({"after", simulation::StageKind::rest, 0.0, 0.0, 0.0, {}});
    run.stages.back().damage.fallen_area = area;
  }
  std::optional<int> enough(std::size_t known) const {
    std::vector<const RunResult*> results;
    for (std::size_t k = 0; k < runs.size(); ++k) results.push_back(k < known ? &runs[k] : nullptr);
    return enough_realizations(plan, results);
  }
  std::optional<int> enough() const { return enough(runs.size()); }
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
  for (int k = 0; k < 5; ++k) s.add(k, "1", 0.0);
  EXPECT_EQ(s.enough(), 2);  // nothing ever falls
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

}  // namespace
}  // namespace keyblock::study
