#include "study/run_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "record/damage_fields.h"
#include "study/plan.h"

namespace keyblock::study {
namespace {

using record::BlockStatus;
using record::StageKind;

RunResult sample_run() {
  RunResult run;
  run.key = "r0001-0123456789";
  run.realization = 1;
  run.values = {"0.1", "\"a\""};
  run.variant = "friction-";
  run.error = "step 3 \"failed\"";
  run.blocks = 12;
  run.steps = 34567890123;
  run.wall_time = 1.0 / 3.0;
  run.state_hash = "00ff";
  run.unconverged_steps = 2;
  run.max_overlap = 1e-300;
  run.energy_residual_ratio = std::nan("");
  StageMeasures stage{"first earthquake", StageKind::shake, 1.1, 0.2, 0.3, {}};
  stage.damage.fallen_blocks = 4;
  double value = 0.1;
  for (const auto& field : record::damage_fields) stage.damage.*field.number = value += 1.0 / 7.0;
  run.stages = {stage, {"rest", StageKind::rest, 0.0, 0.0, 0.0, {}}};
  run.fallen = {{3, "slab", 1, {0.1, -0.2}, 0.7, 1.0 / 7.0, 0.9, record::WallPart::right},
                {4, "", 1, {0.1, -0.2}, 0.7, 0.1, std::nan(""), record::WallPart::none}};
  run.map = {BlockStatus::in_place,  BlockStatus::in_place,  BlockStatus::fallen,
             BlockStatus::excavated, BlockStatus::excavated, BlockStatus::loosened};
  return run;
}

TEST(RunJson, IsReadToTheLastBit) {
  const RunResult run = sample_run();
  const std::string text = run_json(run, "abc");
  const RunResult read = read_run_json(text, "abc");
  EXPECT_EQ(run_json(read, "abc"), text);
  EXPECT_EQ(read.steps, run.steps);
  EXPECT_EQ(read.wall_time, run.wall_time);
  EXPECT_TRUE(std::isnan(read.energy_residual_ratio));
  EXPECT_EQ(read.stages[0].kind, StageKind::shake);
  EXPECT_EQ(read.stages[0].damage.closure_horizontal, run.stages[0].damage.closure_horizontal);
  EXPECT_EQ(read.fallen[0].centroid, run.fallen[0].centroid);
  EXPECT_EQ(read.fallen[0].weight, run.fallen[0].weight);
  EXPECT_EQ(read.fallen[0].part, run.fallen[0].part);
  EXPECT_TRUE(std::isnan(read.fallen[1].depth));
  EXPECT_EQ(read.map, run.map);
  EXPECT_EQ(read.error, run.error);
}

TEST(RunJson, MapIsShort) {
  RunResult run = sample_run();
  run.map.clear();
  const std::size_t without = run_json(run, "").size();
  run.map.assign(1000000, BlockStatus::in_place);
  const std::string text = run_json(run, "");
  EXPECT_LT(text.size(), without + 100);
  EXPECT_EQ(read_run_json(text, "").map.size(), 1000000U);
}

TEST(RunJson, EveryTruncationIsSeen) {
  const std::string text = run_json(sample_run(), "abc");
  for (std::size_t length = 0; length + 1 < text.size(); ++length)
    EXPECT_THROW(read_run_json(text.substr(0, length), "abc"), InputError) << length;
}

TEST(RunJson, EveryChangeIsSeen) {
  const std::string text = run_json(sample_run(), "abc");
  for (std::size_t k = 0; k + 1 < text.size(); ++k) {
    std::string changed = text;
    changed[k] = changed[k] == '7' ? '8' : '7';
    EXPECT_THROW(read_run_json(changed, "abc"), InputError) << k;
  }
}

TEST(RunJson, OfAnotherStudy) {
  EXPECT_THROW(read_run_json(run_json(sample_run(), "abc"), "abd"), InputError);
}

}  // namespace
}  // namespace keyblock::study
