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

/// The surroundings of the openings at one moment of a run, as a small SVG of its own: blocks filled by their status.
std::string thumbnail_svg(const simulation::ModelRecord& model, const simulation::Frame& frame);

}  // namespace keyblock::study
