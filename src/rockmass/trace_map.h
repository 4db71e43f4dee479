#pragma once
#include <filesystem>
#include <vector>

#include "rockmass/trace.h"

namespace keyblock::rockmass {

/// The traces of a digitised map, coordinates as in the file. Every straight piece is one Trace with source
/// {trace_map, map_index} and the number of its polyline; pieces of length zero are left out.
///
/// The file is GeoJSON if its first character is `{`, else CSV.
/// - GeoJSON (RFC 7946): LineString and MultiLineString, bare, in a Feature, a FeatureCollection or a
///   GeometryCollection. Heights are ignored, features without geometry skipped.
/// - CSV (RFC 4180; separator `,` or `;`): a header with the columns trace, x, y in any order, further ones are ignored;
///   one row per vertex. Rows with the same text in `trace` are one trace, in their order; they follow each other.
///
/// Throws InputError with every mistake of the file (at most 20): unreadable file, syntax, missing columns, other
/// geometry, lists and objects nested too deeply, numbers missing or not finite, traces of fewer than two different vertices,
/// and in CSV traces that go on after rows of another one.
std::vector<Trace> read_trace_map(const std::filesystem::path& path, int map_index);

}  // namespace keyblock::rockmass
