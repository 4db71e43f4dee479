#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keyblock::verification {

/// Figures of a check, by name: what result('…') of its quantities reads.
using BuiltinResults = std::map<std::string, double, std::less<>>;

/// Checks that no scenario can express: they ask the modules below directly.
std::vector<std::string> builtin_names();
bool is_builtin(const std::string& name);
/// Precondition: is_builtin(name). `data` are the files of the run. Throws InputError.
BuiltinResults run_builtin(const std::string& name, const std::vector<std::filesystem::path>& data);

/// Integrals of x^i y^j, i + j ≤ 22, over concave polygons with holes, against Gauss rules on triangles: `integrals` (their
/// number), `largest_error_by_edges`, `largest_error_by_rule` (relative).
BuiltinResults polygon_integrals(const std::vector<std::filesystem::path>& data);

/// Random chords of 200 convex windows, and what may happen to lines: `cases`, `wrong_counts` (of faces), `wrong_edges` (cases
/// in which an inner edge is not that of two blocks), `largest_area_error` (relative), each also with the ends of the chords a
/// hair off the frame (`off_frame_…`) and with duplicates, overlaps and dead ends (`cluttered_…`); `star_…`: many lines through
/// one node; `island_blocks`, `island_holes`: of a ring within a ring.
BuiltinResults cutting_of_chords(const std::vector<std::filesystem::path>& data);

/// Spacing, length and gap of generated joints of several distributions before they are clipped, against these distributions:
/// `SET_spacing` …, the statistic of Kolmogorov and Smirnov times √n for the sets `paper_1`, `paper_2`, `paper_3`, `skewed`,
/// `cut_off`, and `smallest_sample`.
BuiltinResults trace_statistics(const std::vector<std::filesystem::path>& data);

/// How the traces of a map (first file) meet within an area (second file), both GeoJSON: `isolated`, `crossing`, `abutting`,
/// `boundary`, `branches`, `length_m`.
BuiltinResults trace_topology(const std::vector<std::filesystem::path>& data);

}  // namespace keyblock::verification
