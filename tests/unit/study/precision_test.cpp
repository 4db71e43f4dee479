#include "study/precision.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "study/summaries.h"
#include "synthetic_study.h"

namespace keyblock::study {
namespace {

StudyData study_with(Precision precision) {
  StudyData study = testing::synthetic_study({.scales = {"1.0"}, .variants = false});
  study.precision = std::move(precision);
  return study;
}

// Narrow enough is what study.json says of the worst-known combination.
TEST(Precision, IsReachedWhenTheWidestIntervalIsNarrowEnough) {
  const StudyData study = study_with({"fallen_area_m2", 0.1, std::nullopt});
  double widest = 0.0, widest_share = 0.0;
  for (const Combination& c : summarize(study).combinations) {
    const statistics::Estimate mean = c.measures[1].description.mean;
    widest = std::max(widest, mean.high - mean.low);
    widest_share = std::max(widest_share, 0.5 * (mean.high - mean.low) / mean.value);
  }
  ASSERT_GT(widest, 0.0);
  EXPECT_TRUE(precise_enough(study_with({"fallen_area_m2", 1.001 * widest_share, std::nullopt})));
  EXPECT_FALSE(precise_enough(study_with({"fallen_area_m2", 0.999 * widest_share, std::nullopt})));
  EXPECT_TRUE(precise_enough(study_with({"fallen_area_m2", std::nullopt, 1.001 * widest})));
  EXPECT_FALSE(precise_enough(study_with({"fallen_area_m2", std::nullopt, 0.999 * widest})));
  // One of both is enough.
  EXPECT_TRUE(precise_enough(study_with({"fallen_area_m2", 1e-6, 1.001 * widest})));
}

TEST(Precision, IsNotReachedByFewOrNoRuns) {
  EXPECT_FALSE(precise_enough({}));
  StudyData study = study_with({"fallen_area_m2", 10.0, std::nullopt});
  EXPECT_TRUE(precise_enough(study));
  study.runs.resize(4);
  EXPECT_FALSE(precise_enough(study));
  study.runs.clear();
  EXPECT_FALSE(precise_enough(study));
}

TEST(Precision, OfAMeasureThatDoesNotExistIsAMistake) {
  EXPECT_THROW(precise_enough(study_with({"fallen", 0.1, std::nullopt})), std::invalid_argument);
}

}  // namespace
}  // namespace keyblock::study
