#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "rockmass/random_strength.h"
#include "rockmass/trace.h"

namespace keyblock::rockmass {

/// What is taken of a map, and where it lies.
struct MapChoice {
  std::vector<std::string> layers;  ///< of a drawing; empty: all
  drawing::Placement placement;
};

/// The traces of a digitised map, laid into the section by `choice`. Every straight piece is one Trace with source
/// {trace_map, map_index} and the number of its trace; pieces of length zero are left out.
///
/// The contents of the file say what it is:
/// - GeoJSON (RFC 7946): LineString and MultiLineString, bare, in a Feature, a FeatureCollection or a
///   GeometryCollection. Heights are ignored, features without geometry skipped.
/// - Well-known text: LINESTRING and MULTILINESTRING, alone or in a GEOMETRYCOLLECTION, one after the other.
/// - A table: cells between commas, semicolons, tabs or spaces (RFC 4180 as to quotes); names of columns in small letters or
///   capitals. Where commas separate no cells, a number may have a decimal comma.
///   With a header of the columns trace, x, y in any order, further ones ignored: one row per vertex. Rows with the same
///   text in `trace` are one trace, in their order; they follow each other.
///   With a column `wkt` (`wkt_geom`, `geometry`, `geom`, `the_geom`): a geometry as above in each row.
///   With columns of the ends, or of all vertices, of a line (x1, y1, x2, y2, …; START_X, START_Y, END_X, END_Y and the like), whatever
///   else stands beside them: a trace in each row.
///   With no header: a trace in each row, x y x y …. Rows that begin with their number are refused.
///
/// - A drawing (ASCII DXF, drawing/drawing.h): the lines on the chosen layers. A shapefile: its lines, and the rings of its polygons; a projection
///   beside it (.prj) says whether they are degrees.
///
/// `skipped`, if given, receives what of a drawing is no line, in words. `strengths`, if given, receives those of each trace, by its number: columns of a table with one of strength_names, in which every row of a trace has
/// the same or nothing, and members of `properties` of a GeoJSON feature. Empty where the file has none.
///
/// Throws InputError with every mistake of the file (at most 20): unreadable file, a file of another kind, which is named,
/// syntax, missing columns, other geometry, lists and objects nested too deeply, numbers missing or not finite, traces of
/// fewer than two different vertices, traces that go on after rows of another one, strengths that are none, and coordinates in degrees: the file says so,
/// or they lie as only degrees do.
std::vector<Trace> read_trace_map(const std::filesystem::path& path, int map_index,
                                  std::vector<TraceStrength>* strengths = nullptr,
                                  const MapChoice& choice = {}, std::string* skipped = nullptr);

/// A trace through the vertices of each line, of which two differ.
std::vector<Trace> traces_of(const std::vector<std::vector<Vec2>>& lines, int map_index);

}  // namespace keyblock::rockmass
