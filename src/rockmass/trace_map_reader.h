#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "geometry/polygon.h"
#include "rockmass/random_strength.h"
#include "rockmass/trace.h"
#include "rockmass/trace_map.h"

/// What the readers of trace maps share; for trace_map*.cpp alone.
namespace keyblock::rockmass {

/// What all formats share: the traces found and the mistakes.
class MapReader {
 public:
  MapReader(std::string file, int map_index)
      : file_(std::move(file)), source_{TraceSource::Kind::trace_map, map_index} {}

  void mistake(int line, int column, std::string key, std::string found, std::string expected,
               std::string hint = {}) {
    if (is_full()) return;
    mistakes_.push_back(
        {{file_, line, column}, std::move(key), std::move(found), std::move(expected), std::move(hint)});
  }

  /// Whether there are so many mistakes that further ones are not listed.
  [[nodiscard]] bool is_full() const { return mistakes_.size() >= max_mistakes; }

  static constexpr const char* trace_expected = "two or more different vertices";
  static constexpr const char* format_expected =
      "a drawing (ASCII DXF), a shapefile (.shp), GeoJSON, WKT, or a table with the columns trace, x, y";

  /// How all traces are laid into the section at the end.
  void place(const drawing::Placement& placement) { placement_ = placement; }
  /// Of the traces that are added from now on.
  void set_strength(const TraceStrength& strength) { strength_ = strength; }
  /// Adds a trace. Returns what is found in place of one that has no two different vertices.
  std::optional<std::string> add(const std::vector<Vec2>& vertices);

  /// The file names the system of its coordinates, at this place.
  void names_system(int line, int column, std::string key, std::string name);

  /// All traces. Throws the mistakes, if there are any; coordinates in degrees are one.
  std::vector<Trace> finish();
  /// Of each trace; empty where there are none.
  void take_strengths(std::vector<TraceStrength>* strengths);

 private:
  /// Mistakes beyond this number are not listed.
  static constexpr std::size_t max_mistakes = 20;

  void check_unit();

  std::string file_;
  TraceSource source_;
  std::vector<Trace> traces_;
  TraceStrength strength_;                ///< of the next trace
  std::vector<TraceStrength> strengths_;  ///< by number of the trace
  Box box_;
  drawing::Placement placement_;
  Diagnostic system_;  ///< where the file names its system of coordinates, and as what
  std::vector<Diagnostic> mistakes_;
};

bool is_strength(StrengthKey key, double value);
/// What is expected of one.
std::string strength_expected(StrengthKey key);

/// Of an offset into the text, counted from 1.
std::pair<int, int> line_and_column(std::string_view text, std::size_t offset);

/// What a line of a message can hold of a text.
std::string shortened(std::string_view text);

/// Without the spaces around it.
std::string_view trimmed(std::string_view text);

/// Takes the first line off a text, without its end: CR, LF or both.
std::string_view take_line(std::string_view& text);

/// Whether coordinates in this system are degrees: `EPSG:4326`, `urn:ogc:def:crs:OGC:1.3:CRS84`, …
bool is_in_degrees(std::string_view system);

/// What a file of another kind is, and what to do with it.
struct ForeignFormat {
  std::string name;
  std::string advice;
};
std::optional<ForeignFormat> foreign_format(std::string_view text);

/// Whether the text begins with a geometry as well-known text.
bool is_wkt(std::string_view text);

/// One reader per format; mistakes are added to the map.
void read_geojson(std::string_view text, MapReader& map);
void read_trace_table(std::string_view text, MapReader& map);
/// A drawing or a shapefile. Throws InputError for one that cannot be read.
void read_drawn_lines(std::string_view text, const std::filesystem::path& path, const MapChoice& choice,
                      MapReader& map, std::string* skipped);
/// `line` and `column`: where the text begins in the file.
void read_wkt(std::string_view text, MapReader& map, int line = 1, int column = 1);

}  // namespace keyblock::rockmass
