#pragma once
#include <filesystem>
#include <string>

#include "record/record.h"
#include "study/summaries.h"

namespace keyblock::study {

/// Writes DIR/runs.csv, DIR/study.json and DIR/report.html, each under a temporary name and renamed. The page shows the
/// pictures DIR/runs/KEY/thumbnail.svg that are there and links to DIR/runs/KEY/report.html. Throws RunError.
/// Returns what it has gathered of the runs.
Summary write_outputs(const std::filesystem::path& directory, const StudyData& study);

/// How rock moves in a stage: from where, and which joints slip.
struct Mechanism {
  record::Frame start;  ///< as the stage began
  std::vector<record::ContactRecord> contacts;

  [[nodiscard]] bool is_known() const { return !start.displacement.empty(); }
};

/// The surroundings of the openings at one moment of a run, as a small SVG of its own: blocks filled by their status. Of a mechanism also arrows
/// along which blocks move that are loosened or fallen, the longest for the farthest, and joints beside them that slip.
std::string thumbnail_svg(const record::ModelRecord& model, const record::Frame& frame,
                          const Mechanism& mechanism = {});

}  // namespace keyblock::study
