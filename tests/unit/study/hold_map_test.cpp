#include "study/hold_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace keyblock::study {
namespace {

using record::BlockStatus;
using CellTrials = std::vector<std::pair<double, const std::vector<BlockStatus>*>>;
using CellStates = std::vector<BlockStatus>;

constexpr BlockStatus stays = BlockStatus::in_place, loose = BlockStatus::loosened,
                      fell = BlockStatus::fallen, dug = BlockStatus::excavated;

// CellTrials come in any order; what holds again at a larger value has gone all the same.
TEST(HoldMap, IsTheLastTrialBeforeThatInWhichRockGoes) {
  const MapGrid grid{{10.0, 20.0}, 0.5, 5, 1};
  const CellStates at_1{stays, stays, loose, stays, dug}, at_2{stays, loose, loose, stays, dug},
      at_3{fell, stays, loose, stays, dug};
  const HoldMap map = hold_map(grid, {}, 1.0, CellTrials{{3.0, &at_3}, {1.0, &at_1}, {2.0, &at_2}});
  EXPECT_EQ(map.holds, (std::vector<std::optional<double>>{2.0, 1.0, {}, {}, {}}));
  EXPECT_EQ(map.lost, (std::vector<bool>{false, false, true, false, false}));
  EXPECT_EQ(hold_map_csv(map), "x_m,y_m,holds_to\n10.25,20.25,2\n10.75,20.25,1\n11.25,20.25,\n");
  EXPECT_FALSE(map.empty());
}

// A friction angle that falls: `from` is the larger end.
TEST(HoldMap, GoesFromTheEndAtWhichTheSearchBegins) {
  const MapGrid grid{{0.0, 0.0}, 1.0, 1, 1};
  const CellStates holds{stays}, goes{fell};
  const HoldMap map = hold_map(grid, {}, 45.0, CellTrials{{10.0, &goes}, {30.0, &holds}, {45.0, &holds}});
  EXPECT_EQ(map.holds.front(), 30.0);
}

TEST(HoldMap, IsEmptyWhereAllRockHolds) {
  const MapGrid grid{{0.0, 0.0}, 1.0, 1, 1};
  const CellStates holds{stays};
  const HoldMap map = hold_map(grid, {}, 1.0, CellTrials{{1.0, &holds}, {2.0, &holds}});
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(hold_map_svg(map, {}), "");
}

TEST(HoldMap, IsDrawnWithALegend) {
  const MapGrid grid{{0.0, 0.0}, 1.0, 2, 1};
  const CellStates before{stays, loose}, after{loose, loose};
  LimitResult result;
  result.request.from = 1.0;
  result.request.to = 2.0;
  const std::string svg = hold_map_svg(
      hold_map(grid, {{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}}, 1.0, CellTrials{{1.0, &before}, {2.0, &after}}),
      result);
  EXPECT_THAT(svg, testing::HasSubstr("holds to 1"));
  EXPECT_THAT(svg, testing::HasSubstr("goes at 1 already"));
}

}  // namespace
}  // namespace keyblock::study
