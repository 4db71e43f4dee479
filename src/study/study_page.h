#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

#include "study/summaries.h"

namespace keyblock::study {

/// Pictures of runs that a page carries at most: those of the worst and the median of every combination, then by
/// realization.
inline constexpr std::size_t most_thumbnails = 1500;

/// The report of a study: one HTML page with its program, styles, numbers and pictures (runs/KEY/thumbnail.svg of the
/// directory, where they are there), which asks nothing of the network. It links to runs/KEY/report.html, runs.csv and
/// study.json beside it.
///
/// Its arrays (report/array_pack.h), n runs:
///
/// | name | type | numbers | what |
/// |---|---|---|---|
/// | study | u8 | | study.json, as bytes |
/// | texts | u8 | | JSON: `keys` by run, `variants` (the names), `errors` ({run: text}) |
/// | run.realization, run.combination | i32 | n | place in `combinations` of study.json |
/// | run.variant | u8 | n | place in `variants` |
/// | run.done, run.report | u8 | n | measured; has a report.html |
/// | run.marginal | u8 | n | 0 unknown, 1 no, 2 yes |
/// | run.wall_time | f32 | n | s |
/// | run.thumbnail | i32 | n | place among the pictures, −1: none in the page |
/// | run.measures | f64 | n · measures | run by run, as `measures` of study.json; not a number where there is none |
/// | thumbnail.begin | u32 | pictures + 1 | bytes of a picture in thumbnail.svg |
/// | thumbnail.svg | u8 | | one SVG after the other |
std::string study_page(const std::filesystem::path& directory, const StudyData& study, const Summary& summary,
                       const std::string& study_json);

}  // namespace keyblock::study
