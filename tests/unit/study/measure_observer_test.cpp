#include "study/measure_observer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyblock::study {
namespace {

using record::BlockStatus;
using testing::Each;
using testing::ElementsAre;

void add_block(record::ModelRecord& model, const std::vector<std::vector<Vec2>>& rings) {
  record::ModelRecord::Block block;
  block.area = 2.0;
  block.centroid = {0.25, 0.5};
  for (const auto& ring : rings) {
    block.ring_start.push_back(static_cast<int>(model.vertices.size()));
    model.vertices.insert(model.vertices.end(), ring.begin(), ring.end());
  }
  block.ring_start.push_back(static_cast<int>(model.vertices.size()));
  model.blocks.push_back(block);
}

std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// A 4 × 4 block with a hole of 2 × 2, in which a smaller one lies; and a frame around, which does not count.
record::ModelRecord nested() {
  record::ModelRecord model;
  model.origin = {100.0, 50.0};
  add_block(model, {rectangle(0, 0, 4, 4), rectangle(1, 1, 3, 3)});
  add_block(model, {rectangle(1, 1, 2, 3)});
  add_block(model, {rectangle(-1, -1, 5, 5)});
  return model;
}

TEST(BlocksOfCells, HolesAndNeighbours) {
  const MapGrid grid{{100.0, 50.0}, 1.0, 5, 4};
  EXPECT_THAT(blocks_of_cells(grid, nested(), 2), ElementsAre(0, 0, 0, 0, -1,   //
                                                              0, 1, -1, 0, -1,  //
                                                              0, 1, -1, 0, -1,  //
                                                              0, 0, 0, 0, -1));
}

TEST(BlocksOfCells, OutsideOfTheGrid) {
  EXPECT_THAT(blocks_of_cells({{200.0, 50.0}, 1.0, 3, 3}, nested(), 2), Each(-1));
  EXPECT_TRUE(blocks_of_cells({}, nested(), 2).empty());
}

// Every cell lies in one block at most, and the cells of a block cover its area.
TEST(BlocksOfCells, CoverTheAreaOfATriangle) {
  record::ModelRecord model;
  add_block(model, {{{0.1, 0.2}, {7.3, 1.1}, {2.2, 8.4}}});
  const double area = 0.5 * ((7.3 - 0.1) * (8.4 - 0.2) - (2.2 - 0.1) * (1.1 - 0.2));
  const auto cells = blocks_of_cells({{0.0, 0.0}, 0.02, 400, 450}, model, 1);
  const auto inside = std::count(cells.begin(), cells.end(), 0);
  EXPECT_NEAR(static_cast<double>(inside) * 0.02 * 0.02, area, 0.05);
}

record::StageRecord stage(const std::string& name) {
  record::StageRecord record;
  record.stage.name = name;
  return record;
}

TEST(MeasureObserver, TheStageInWhichABlockFell) {
  RunResult result;
  MeasureObserver observer(result, {{100.0, 50.0}, 1.0, 5, 4}, 2, 0.01);
  const auto go = [&](int index, BlockStatus a, BlockStatus b, bool interrupted = false) {
    record::Frame frame;
    frame.status = {BlockStatus::fallen, BlockStatus::fallen, BlockStatus::in_place};  // for a moment
    observer.frame(frame);
    frame.status = {a, b, BlockStatus::in_place};
    observer.frame(frame);
    record::StageRecord record = stage("s" + std::to_string(index));
    for (int k = 0; k < 2; ++k) {
      if ((k == 0 ? a : b) == BlockStatus::fallen)
        record.fallen.push_back({k, 2.0, 500.0, 0.5 + k, record::WallPart::left});
    }
    record.interrupted = interrupted;
    record.pgv = 0.25 * index;
    observer.stage_end(index, record);
  };
  observer.begin(nested());
  go(0, BlockStatus::in_place, BlockStatus::fallen);
  go(1, BlockStatus::fallen, BlockStatus::loosened);
  go(2, BlockStatus::fallen, BlockStatus::fallen);
  go(3, BlockStatus::fallen, BlockStatus::fallen, true);
  record::RunRecord run;
  run.steps = 99;
  run.open_close.unconverged_steps = 3;
  observer.end(run);
  ASSERT_EQ(result.fallen.size(), 2U);
  EXPECT_EQ(result.fallen[0].stage, 1);
  EXPECT_EQ(result.fallen[1].stage, 2);
  EXPECT_EQ(result.fallen[1].area, 2.0);
  EXPECT_EQ(result.fallen[1].weight, 500.0);
  EXPECT_EQ(result.fallen[1].depth, 1.5);
  EXPECT_EQ(result.fallen[1].part, record::WallPart::left);
  EXPECT_EQ(result.fallen[0].centroid, (Vec2{100.25, 50.5}));
  EXPECT_EQ(result.blocks, 2);
  EXPECT_EQ(result.steps, 99);
  EXPECT_EQ(result.unconverged_steps, 3);
  ASSERT_EQ(result.stages.size(), 3U);
  EXPECT_EQ(result.stages[2].pgv, 0.5);
  EXPECT_EQ(result.map[0], BlockStatus::fallen);
  EXPECT_EQ(result.map[4], BlockStatus::in_place);  // where no block is
  EXPECT_EQ(result.map.size(), 20U);
}

}  // namespace
}  // namespace keyblock::study
