#include "report/thinning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyblock::report {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ThinByStage, KeepsAllWhenFew) {
  const int stages[] = {0, 0, 0, 1};
  EXPECT_THAT(thin_by_stage(stages, 4), ElementsAre(0U, 1U, 2U, 3U));
  EXPECT_THAT(thin_by_stage({}, 4), IsEmpty());
}

TEST(ThinByStage, KeepsStartsAndEndsOfStagesBeyondTheLimit) {
  const int stages[] = {0, 0, 0, 1, 1, 1, 2};
  EXPECT_THAT(thin_by_stage(stages, 2), ElementsAre(0U, 2U, 3U, 5U, 6U));
}

TEST(ThinByStage, SpreadsTheOthersEvenly) {
  const std::vector<int> stages(1001, 0);
  const auto kept = thin_by_stage(stages, 101);
  EXPECT_LE(kept.size(), 101U);
  EXPECT_THAT(kept, Contains(1000U));
  for (std::size_t k = 1; k < kept.size(); ++k) EXPECT_LE(kept[k] - kept[k - 1], 12U);
}

TEST(ThinCurves, KeepsEndsAndExtremes) {
  Curves curves;
  curves.columns.resize(2);
  for (int i = 0; i < 10'000; ++i) {
    curves.x.push_back(0.1 * i);
    curves.columns[0].push_back(i == 4321 ? 50.0 : 0.0);
    curves.columns[1].push_back(i == 7654 ? -3.0 : i % 2);
  }
  curves.columns[0].back() = 0.25;
  const Curves thin = thin_curves(curves, 400);
  EXPECT_LE(thin.x.size(), 400U);
  EXPECT_THAT(thin.columns[0], SizeIs(thin.x.size()));
  EXPECT_TRUE(std::is_sorted(thin.x.begin(), thin.x.end()));
  EXPECT_EQ(thin.x.back(), curves.x.back());
  EXPECT_EQ(thin.columns[0].back(), 0.25);
  EXPECT_EQ(*std::max_element(thin.columns[0].begin(), thin.columns[0].end()), 50.0);
  EXPECT_EQ(*std::min_element(thin.columns[1].begin(), thin.columns[1].end()), -3.0);
  EXPECT_EQ(std::count(thin.columns[0].begin(), thin.columns[0].end(), 50.0), 1);
}

TEST(ThinCurves, PassesOverRowsWithoutAValue) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Curves curves;
  curves.columns.resize(2);
  for (int i = 0; i < 1000; ++i) {
    curves.x.push_back(i);
    curves.columns[0].push_back(i < 500 ? i : none);
    curves.columns[1].push_back(none);
  }
  const Curves thin = thin_curves(curves, 100);
  const std::vector<double>& column = thin.columns[0];
  const auto end = std::find_if(column.begin(), column.end(), [](double v) { return std::isnan(v); });
  EXPECT_EQ(end - column.begin(), 51);
  EXPECT_TRUE(std::is_sorted(column.begin(), end));
  EXPECT_EQ(end[-1], 499.0);
  EXPECT_TRUE(std::all_of(end, column.end(), [](double v) { return std::isnan(v); }));
  EXPECT_TRUE(std::isnan(thin.columns[1][50]));
}

TEST(ThinCurves, LeavesFewRowsAlone) {
  const Curves curves{{1.0, 2.0}, {{3.0, 4.0}}};
  EXPECT_EQ(thin_curves(curves, 4).columns[0], curves.columns[0]);
}

}  // namespace
}  // namespace keyblock::report
