#include <cstdio>
#include <filesystem>
#include <string>

#include "../unit/report/synthetic_run.h"
#include "report/report.h"

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
  write("marginal", {.marginal = true});
  write("interrupted", {.interrupted = true});
  write("no_frames", {.frames = false});
  write("no_excavation", {.excavation = false});
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "empty");
  keyblock::report::write_report({}, std::filesystem::path(argv[1]) / "empty");
  // Far from the origin of coordinates, and hardly moving: long and small numbers at the axes.
  keyblock::results::RunData far = synthetic_run({.frames_per_stage = 4});
  far.model.origin = {466000.0, 6691590.0};
  for (auto& row : far.steps) {
    row.max_displacement = 1e-9 * (1.0 + static_cast<double>(row.step % 7));
    row.energy = {.kinetic = 1.0 + 1e-9 * static_cast<double>(row.step % 11), .input = 1.0};
  }
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "far_and_still");
  keyblock::report::write_report(far, std::filesystem::path(argv[1]) / "far_and_still");
  // As large as the demo: about 900 blocks, 10,000 display vertices, 300 frames.
  write("large", {.columns = 32, .rows = 28, .edge_pieces = 3, .frames_per_stage = 75});
  // Blocks smaller than pixels.
  write("tiny_blocks", {.columns = 200, .rows = 60, .frames_per_stage = 2, .excavation = false});
}
