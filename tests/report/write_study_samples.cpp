#include <cstdio>
#include <filesystem>
#include <string>

#include "../unit/study/synthetic_study.h"
#include "study/outputs.h"

/// write_study_samples DIR: one folder with a study's outputs for each kind of study that the browser test opens.
int main(int argc, char** argv) {
  using keyblock::made_up::SyntheticStudyOptions;
  if (argc != 2) {
    std::fputs("usage: write_study_samples DIR\n", stderr);
    return 1;
  }
  const auto write = [&](const std::string& name, const SyntheticStudyOptions& options) {
    const std::filesystem::path directory = std::filesystem::path(argv[1]) / name;
    std::filesystem::create_directories(directory);
    const auto study = keyblock::made_up::synthetic_study(options);
    keyblock::made_up::write_synthetic_pictures(directory, study, options);
    keyblock::study::write_outputs(directory, study);
  };
  write("study", {});
  // One combination, hardly any runs, neither levels nor maps nor pictures.
  write("study_small", {.realizations = 2,
                        .scales = {"1.0"},
                        .orders = {"1"},
                        .variants = false,
                        .failures = false,
                        .levels = false,
                        .map = false,
                        .pictures = 0});
  // All runs at the same intensity.
  write("study_one_intensity", {.realizations = 12,
                                .scales = {"1.0"},
                                .orders = {"1"},
                                .variants = false,
                                .failures = false,
                                .pictures = 0});
  // Measures that begin after the excavation, in too few realizations for the precision.
  write("study_since", {.realizations = 3,
                        .scales = {"0.4", "1.0"},
                        .orders = {"1"},
                        .variants = false,
                        .failures = false,
                        .since = true});
  // Nothing falls.
  write("study_still", {.realizations = 8,
                        .scales = {"0.0"},
                        .orders = {"1"},
                        .variants = false,
                        .failures = false,
                        .pictures = 0});
  // A wall: there is no opening.
  write("study_wall", {.realizations = 8,
                       .scales = {"0.05", "0.15"},
                       .orders = {"1"},
                       .variants = false,
                       .failures = false,
                       .opening = false,
                       .map = false,
                       .pictures = 0});
  // More pictures than a page holds.
  write("study_large", {.realizations = 190, .variants = false, .failures = false});
  std::filesystem::create_directories(std::filesystem::path(argv[1]) / "study_empty");
  keyblock::study::write_outputs(std::filesystem::path(argv[1]) / "study_empty", {});
}
