#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "study/run_result.h"

namespace keyblock::made_up {

/// A made-up study of a round tunnel, of which every part of the study's report has something to show. No mechanics:
/// which blocks fall is drawn by lot, more of them the stronger the shaking, fewer at order 2.
struct SyntheticStudyOptions {
  int realizations = 60;
  std::vector<std::string> scales{"0.2", "0.4", "0.6", "1.0"};
  std::vector<std::string> orders{"1", "2"};
  bool variants = true;  ///< friction−, friction+ and released, of the first realizations
  bool failures = true;  ///< some runs fail, some are missing
  bool levels = true;
  bool opening = true;  ///< otherwise the blocks are around none
  bool map = true;
  bool since = false;              ///< measures begin after the excavation
  std::size_t pictures = 100'000;  ///< how many realizations have one
};

study::StudyData synthetic_study(const SyntheticStudyOptions& options = {});

/// A tunnel of about 750 blocks, of which a share `severity` of those in the crown have fallen.
std::pair<record::ModelRecord, record::Frame> synthetic_tunnel(int realization, double severity);

/// DIR/runs/KEY/thumbnail.svg, and a report.html of a line, of all runs of the first `pictures` realizations.
void write_synthetic_pictures(const std::filesystem::path& directory, const study::StudyData& study,
                              const SyntheticStudyOptions& options);

}  // namespace keyblock::made_up
