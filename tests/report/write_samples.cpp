#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "../unit/report/synthetic_run.h"
#include "record/damage_fields.h"
#include "report/report.h"

namespace {

/// What results::read_run finds of a run that was killed.
void forget_end(keyblock::results::RunData& data) {
  const double unknown = std::nan("");
  keyblock::record::RunRecord& run = data.run;
  keyblock::record::StageRecord& last = run.stages.back();
  const keyblock::record::Damage known = last.damage;
  for (const auto& field : keyblock::record::damage_fields) last.damage.*field.number = unknown;
  last.damage.fallen_area = known.fallen_area;
  last.damage.loosened_area = known.loosened_area;
  last.wall_time = last.worst_residual_ratio = unknown;
  run.wall_time = run.max_overlap.depth = run.max_area_change = unknown;
  run.max_overlap.block_a = -1;
  run.state_hash.clear();
  run.open_close = {};
  data.cut_off = true;
}

/// Moves a block up by so much, m, from the shaking on.
void move_block(keyblock::results::RunData& data, std::size_t block, float up) {
  const auto& start = data.model.blocks[block].ring_start;
  for (auto& frame : data.frames) {
    if (frame.stage < 2) continue;
    for (int v = start.front(); v < start.back(); ++v)
      frame.displacement[static_cast<std::size_t>(v)][1] += up;
  }
}

/// Puts an anchor of 100 kN/m in with the second stage, to 80 % of that in the last frame; and the base of the model, without a limit.
void add_elements(keyblock::results::RunData& data) {
  using keyblock::record::ElementState;
  keyblock::record::ModelRecord& model = data.model;
  keyblock::Box box;
  for (const keyblock::Vec2 p : model.vertices) box.add(p);
  model.elements = {{"anchor <1>", "spring", 1e5, {2.0, 2.5}, {2.0, 4.5}, 0, 1},
                    {"boundary.base", "boundary", HUGE_VAL, {box.min.x, 0.0}, {box.max.x, 0.0}, -1, -1}};
  model.element_histories = {{"load cell", 0}};
  const auto at = [&](double share, bool present) {
    return std::vector<ElementState>{{.from = {2.0, 2.5 - 0.1 * share},
                                      .to = {2.0, 4.5},
                                      .force = 8e4 * share,
                                      .elongation = 0.1 * share,
                                      .present = present},
                                     {.from = {box.min.x, 0.0},
                                      .to = {box.max.x, 0.0},
                                      .force = 2e6,
                                      .elongation = 1e-3,
                                      .present = true}};
  };
  for (std::size_t f = 0; f < data.frames.size(); ++f) {
    const double share = static_cast<double>(f + 1) / static_cast<double>(data.frames.size());
    data.frames[f].elements = at(share, data.frames[f].stage > 0);
  }
  for (std::size_t k = 0; k < data.histories.size(); ++k) {
    ElementState cell = at(static_cast<double>(k) / static_cast<double>(data.histories.size()), true)[0];
    if (k == 0) cell.force = cell.elongation = std::nan("");
    data.histories[k].elements = {cell};
  }
  for (auto& stage : data.run.stages) stage.damage.largest_utilization = 0.8;
}

}  // namespace

/// write_samples DIR: one folder with a report.html for each kind of run that the browser test opens.
int main(int argc, char** argv) {
  using keyblock::made_up::synthetic_run;
  using keyblock::made_up::SyntheticOptions;
  if (argc != 2) {
    std::fputs("usage: write_samples DIR\n", stderr);
    return 1;
  }
  const auto write = [&](const std::string& name, const SyntheticOptions& options) {
    const std::filesystem::path directory = std::filesystem::path(argv[1]) / name;
    std::filesystem::create_directories(directory);
    keyblock::report::write_report(synthetic_run(options), directory);
  };
  write("tunnel", {});
  // Gravity has brought down two blocks before the shaking.
  keyblock::results::RunData marginal = synthetic_run({.marginal = true});
  for (std::size_t k = 1; k < marginal.run.stages.size(); ++k) {
    marginal.run.stages[k].damage.fallen_blocks += 2;
    marginal.run.stages[k].damage.fallen_area += 0.75;
  }
  // Opened in parts, and two equilibria of later stages.
  for (const double released : {0.0, 0.25, 0.5, 0.75, 1.0})
    marginal.run.stages[1].release.push_back({900 + std::lround(1000.0 * released), released, 8e-3 * released,
                                              3e-3 * released, 5e-3 * released, 0});
  marginal.run.stages[2].release = {{5000, 1.0, 9e-3, 4e-3, 6e-3, 0}};
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "marginal");
  keyblock::report::write_report(marginal, std::filesystem::path(argv[1]) / "marginal");
  keyblock::results::RunData anchored = synthetic_run({});
  add_elements(anchored);
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "anchored");
  keyblock::report::write_report(anchored, std::filesystem::path(argv[1]) / "anchored");
  write("interrupted", {.interrupted = true});
  keyblock::results::RunData killed = synthetic_run({.interrupted = true});
  forget_end(killed);
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "killed");
  keyblock::report::write_report(killed, std::filesystem::path(argv[1]) / "killed");
  write("short", {.frames_per_stage = 5, .interrupted = true, .shake_duration = 0.08});
  keyblock::results::RunData unsettled = synthetic_run({.frames = false});
  unsettled.run.stages[0].way = 0.0312;
  unsettled.run.stages[0].way_share = 0.04;
  unsettled.run.stages[1].equilibrium_reached = false;
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "no_frames");
  keyblock::report::write_report(unsettled, std::filesystem::path(argv[1]) / "no_frames");
  write("no_excavation", {.excavation = false});
  keyblock::results::RunData odd = synthetic_run({});
  odd.model.warnings = {
      "rock.density = 2.6 kg/m3 (line 14): usual is 1000 to 4000 kg/m3; was it in t/m3 or g/cm3? That is "
      "2600 kg/m3",
      "rock.state <default>: plane stress"};
  odd.model.closure_is_lower_bound = true;
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "odd_input");
  keyblock::report::write_report(odd, std::filesystem::path(argv[1]) / "odd_input");
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "empty");
  keyblock::report::write_report({}, std::filesystem::path(argv[1]) / "empty");
  // Far from the origin of coordinates, and hardly moving: long and small numbers at the axes.
  keyblock::results::RunData far = synthetic_run({.frames_per_stage = 4});
  far.model.origin = {466000.0, 6691590.0};
  for (auto& row : far.steps) {
    row.max_displacement = 1e-9 * (1.0 + static_cast<double>(row.step % 7));
    row.energy = {.kinetic = 1.0 + 1e-9 * static_cast<double>(row.step % 11), .input = 1.0};
  }
  for (auto& stage : far.run.stages) {
    stage.damage = {};
    stage.damage.slip_max = stage.damage.slip_max_ever = 1.26e-5;
    stage.damage.slip_mean = 7.2e-7;
  }
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "far_and_still");
  keyblock::report::write_report(far, std::filesystem::path(argv[1]) / "far_and_still");
  // Nothing is excavated; one stone falls out of the wall by 4 m, another flies far away, and the first stage is short.
  keyblock::results::RunData stone =
      synthetic_run({.columns = 3, .rows = 3, .frames_per_stage = 10, .excavation = false});
  move_block(stone, 0, -4.0F);
  move_block(stone, 1, -500.0F);
  stone.frames.erase(stone.frames.begin(), stone.frames.begin() + 9);
  for (auto& row : stone.steps) row.closed_contacts = 0;
  for (auto& stage : stone.run.stages) {
    stage.damage.loosened_area = 0.6;
    stage.damage.displacement_max = 4.0;
  }
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "fallen_stone");
  keyblock::report::write_report(stone, std::filesystem::path(argv[1]) / "fallen_stone");
  // The same, but one stone counts as fallen.
  for (std::size_t k = 2; k < stone.run.stages.size(); ++k) {
    keyblock::record::StageRecord& stage = stone.run.stages[k];
    const auto& block = stone.model.blocks[0];
    stage.fallen = {{0, block.area, 9.81 * block.density * block.area, std::nan("")}};
    stage.damage.fallen_blocks = 1;
    stage.damage.fallen_area = stage.damage.largest_fallen_area = block.area;
    stage.damage.fallen_weight = stage.damage.largest_fallen_weight = stage.fallen[0].weight;
    stage.standing = keyblock::record::Standing::collapsed;
  }
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "collapsed");
  keyblock::report::write_report(stone, std::filesystem::path(argv[1]) / "collapsed");
  // As large as the demo: about 900 blocks, 10,000 display vertices, 300 frames.
  write("large", {.columns = 32, .rows = 28, .edge_pieces = 3, .frames_per_stage = 75});
  // Blocks smaller than pixels.
  write("tiny_blocks", {.columns = 200, .rows = 60, .frames_per_stage = 2, .excavation = false});
}
