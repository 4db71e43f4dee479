#include "results/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "results/csv.h"
#include "sample_run.h"

namespace keyblock::results {
namespace {

using nlohmann::json;

TEST(Summary, HasEveryFieldOfTheContract) {
  SampleRun sample;
  const json summary = json::parse(summary_json(sample.model, sample.run()));
  for (const char* key : {"title",       "version",       "seed",
                          "realization", "warnings",      "closure_is_lower_bound",
                          "blocks",      "vertices",      "dof",
                          "joints",      "area",          "merged_slivers",
                          "steps",       "step_size",     "wall_time_s",
                          "ms_per_step", "threads",       "state_hash",
                          "open_close",  "max_overlap_m", "max_area_change",
                          "energy",      "stages",        "boundary",
                          "damping"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  for (const char* key : {"blocks", "excavated", "domain"}) EXPECT_TRUE(summary["area"].contains(key)) << key;
  for (const char* key : {"mean_iterations", "max_iterations", "retried_steps", "unconverged_steps"}) {
    EXPECT_TRUE(summary["open_close"].contains(key)) << key;
  }
  for (const char* key :
       {"kinetic", "strain", "gravity", "contact", "friction", "input", "numerical", "residual_ratio"}) {
    EXPECT_TRUE(summary["energy"].contains(key)) << key;
  }
  ASSERT_EQ(summary["stages"].size(), 2U);
  for (const json& stage : summary["stages"]) {
    for (const char* key : {"name", "kind", "steps", "duration", "pga_m_s2", "pgv_m_s", "arias_m_s",
                            "equilibrium", "damage", "fallen", "standing", "largest_speed_m_s"}) {
      EXPECT_TRUE(stage.contains(key)) << key;
    }
    for (const char* key : {"reached", "worst_residual_ratio", "moving_blocks"}) {
      EXPECT_TRUE(stage["equilibrium"].contains(key)) << key;
    }
    for (const char* key : {"area_m2", "weight_n_m", "depth_m", "wall"}) {
      EXPECT_TRUE(stage["fallen"][0].contains(key)) << key;
    }
    for (const char* key : {"fallen_blocks",          "fallen_area_m2",
                            "fallen_weight_n_m",      "largest_block_pressure_pa",
                            "largest_fallen_area_m2", "largest_fallen_weight_n_m",
                            "fallen_depth_m",         "fallen_depth_crown_m",
                            "fallen_depth_left_m",    "fallen_depth_right_m",
                            "fallen_depth_invert_m",  "opening_filled_ratio",
                            "loosened_area_m2",       "slip_max_m",
                            "slip_max_ever_m",        "slip_mean_m",
                            "slipped_length_m",       "slipped_length_ever_m",
                            "opening_max_m",          "opening_max_ever_m",
                            "opened_length_m",        "opened_length_ever_m",
                            "closure_vertical_m",     "closure_horizontal_m"}) {
      EXPECT_TRUE(stage["damage"].contains(key)) << key;
    }
  }
}

TEST(Summary, NumbersComeBackToTheLastBit) {
  SampleRun sample;
  const auto run = sample.run();
  const json summary = json::parse(summary_json(sample.model, run));
  EXPECT_EQ(summary["seed"].get<std::uint64_t>(), sample.model.seed);
  EXPECT_EQ(summary["title"], sample.model.title);
  EXPECT_EQ(summary["step_size"].get<double>(), sample.model.step_size);
  EXPECT_EQ(summary["contact_checks"]["across_gaps"], run.contact_checks.across_gaps);
  EXPECT_TRUE(summary["errors"].empty());
  EXPECT_EQ(summary["max_overlap_m"].get<double>(), run.max_overlap.depth);
  const json& overlap = summary["max_overlap_at"];
  EXPECT_EQ(overlap["blocks"], json({0, 2}));
  EXPECT_EQ(overlap["x"], sample.model.origin.x + run.max_overlap.where.x);
  EXPECT_EQ(overlap["y"], sample.model.origin.y + run.max_overlap.where.y);
  EXPECT_EQ(overlap["stage"], run.max_overlap.stage);
  EXPECT_EQ(overlap["time_s"], run.max_overlap.time);
  EXPECT_EQ(summary["energy"]["numerical"].get<double>(), run.energy.numerical);
  EXPECT_EQ(summary["stages"][0]["damage"]["closure_horizontal_m"].get<double>(), 1e-17);
  EXPECT_EQ(summary["ms_per_step"].get<double>(), 1e3 * run.wall_time / 30.0);
  EXPECT_EQ(summary["stages"][0]["equilibrium"]["moving_blocks"], 1);
  const auto& release = summary["stages"][0]["release"][1];
  EXPECT_EQ(release["excavation"], sample.model.excavation_names[0]);
  EXPECT_EQ(release["released"], 0.4);
  EXPECT_EQ(release["crown_m"], 2e-3);
  EXPECT_TRUE(release["springline_m"].is_null());
  EXPECT_EQ(release["step"], 9);
  EXPECT_EQ(summary["stages"][0]["equilibrium"]["moving"][0]["block"], 2);
  EXPECT_EQ(summary["stages"][0]["equilibrium"]["moving"][0]["carried"], 0.7);
  EXPECT_EQ(summary["stages"][0]["equilibrium"]["moving"][0]["movement"], "partly held");
  EXPECT_EQ(summary["stages"][0]["equilibrium"]["verdict"], "1 block moving");
  EXPECT_EQ(summary["stages"][0]["equilibrium"]["largest_way_m"], 0.25);
  EXPECT_TRUE(summary["stages"][1]["equilibrium"]["reached"].is_null());
  EXPECT_EQ(summary["stages"][1]["kind"], "shake");
}

TEST(Summary, TheFrameDoesNotCount) {
  SampleRun sample;
  const json before = json::parse(summary_json(sample.model, sample.run()));
  const int first = static_cast<int>(sample.model.vertices.size());
  sample.model.vertices.insert(sample.model.vertices.end(), {{-1, -1}, {9, -1}, {9, 9}, {-1, 9}});
  sample.model.edge_label.resize(sample.model.vertices.size(), {cutting::EdgeKind::domain, 0});
  sample.model.blocks.push_back({"frame", 1, true, 100.0, 0.0, {}, {4, 4}, {first, first + 4}});
  const json after = json::parse(summary_json(sample.model, sample.run()));
  EXPECT_EQ(after["blocks"], 3);
  EXPECT_EQ(after["vertices"], 14);
  EXPECT_EQ(after["area"], before["area"]);
}

// The block in both excavations goes with the first; the one in the second alone stays, as that is never opened.
TEST(Summary, AreasOfWhatWasExcavated) {
  SampleRun sample;
  const json summary = json::parse(summary_json(sample.model, sample.run()));
  EXPECT_EQ(summary["area"]["excavated"], 15.0);
  EXPECT_EQ(summary["area"]["blocks"], 1.0);
  EXPECT_EQ(summary["area"]["domain"], 16.0);
}

TEST(Summary, WhatIsNoNumberIsNull) {
  SampleRun sample;
  auto run = sample.run();
  run.max_overlap.depth = std::nan("");
  run.energy.input = HUGE_VAL;
  run.steps = 0;
  const json summary = json::parse(summary_json(sample.model, run));
  EXPECT_TRUE(summary["max_overlap_m"].is_null());
  EXPECT_TRUE(summary["energy"]["input"].is_null());
  EXPECT_EQ(summary["ms_per_step"], 0.0);
}

TEST(HistoriesCsv, HeaderAndRows) {
  SampleRun sample;
  const std::vector<record::HistoryRow> rows{sample.history(1), sample.history(2)};
  const std::string text = histories_csv(sample.model, rows);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], testing::StartsWith("time,crown.ux,crown.uy,crown.vx,crown.vy,crown.sxx,crown.syy,"
                                            "crown.sxy,crown.ax,crown.ay,\"a/b, \"\"c\"\".ux\""));
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= lines[2].size();) {
    const std::size_t end = std::min(lines[2].find(',', begin), lines[2].size());
    values.push_back(std::strtod(lines[2].c_str() + begin, nullptr));
    begin = end + 1;
  }
  EXPECT_THAT(lines[0], testing::EndsWith(",load cell.force,load cell.elongation"));
  EXPECT_THAT(lines[1], testing::EndsWith(",,"));  // it is not there yet
  ASSERT_EQ(values.size(), 21U);
  EXPECT_EQ(values[0], rows[1].time);
  EXPECT_EQ(values[1], rows[1].points[0].ux);
  EXPECT_EQ(values[10], rows[1].points[1].ux);
  EXPECT_EQ(values[15], 1e300);
  EXPECT_EQ(values[18], rows[1].points[1].ay);
  record::ModelRecord one;
  one.history_names = {"p"};
  EXPECT_EQ(histories_csv(one, {}), "time,p.ux,p.uy,p.vx,p.vy,p.sxx,p.syy,p.sxy,p.ax,p.ay\n");
}

}  // namespace
}  // namespace keyblock::results
