#include "rockmass/trace_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/atomic_file.h"
#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

constexpr const char* in_degrees_advice =
    "project the lines on a plane in metres first: in QGIS by Export, Save features as, with a CRS in metres "
    "(UTM); or by ogr2ogr -f GeoJSON -t_srs EPSG:32633 NEW OLD (33: your UTM zone)";

/// Coordinates of a map of no named system are degrees where they can be degrees, where the map is smaller than this (10 km
/// on the ground, m when read as lengths), and where it lies this many times its size from the origin.
constexpr double largest_map_in_degrees = 0.1, least_distance_over_size = 100.0;

bool can_be_degrees(const Box& box) {
  return box.min.x >= -180.0 && box.max.x <= 360.0 && box.min.y >= -90.0 && box.max.y <= 90.0;
}

bool seems_to_be_degrees(const Box& box) {
  const double size = std::max(box.size().x, box.size().y);
  return can_be_degrees(box) && size < largest_map_in_degrees &&
         norm(box.min) > least_distance_over_size * size;
}

}  // namespace

std::optional<std::string> MapReader::add(const std::vector<Vec2>& vertices) {
  const std::size_t before = traces_.size();
  const auto count = static_cast<int>(strengths_.size());
  for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
    if (!(vertices[k] == vertices[k + 1]))
      traces_.push_back({vertices[k], vertices[k + 1], source_, count, 0, static_cast<std::uint32_t>(count)});
  }
  if (traces_.size() == before) {
    return vertices.size() == 1 ? "a trace of one vertex"
                                : fmt::format("a trace of {} equal vertices", vertices.size());
  }
  for (const Vec2 p : vertices) box_.add(p);
  strengths_.push_back(strength_);
  return std::nullopt;
}

void MapReader::names_system(int line, int column, std::string key, std::string name) {
  if (system_.found.empty()) system_ = {{file_, line, column}, std::move(key), std::move(name), "", ""};
}

void MapReader::check_unit() {
  if (traces_.empty()) return;
  constexpr const char* expected = "coordinates in metres, as those of the domain";
  if (is_in_degrees(system_.found)) {
    if (!can_be_degrees(box_)) return;  // a label that does not fit
    mistake(system_.where.line, system_.where.column, system_.key,
            fmt::format("longitude and latitude ({}), in degrees", shortened(system_.found)), expected,
            std::string(in_degrees_advice) + "; or leave that name out, if they are metres");
  } else if (system_.found.empty() && seems_to_be_degrees(box_)) {
    mistake(0, 0, "",
            fmt::format("coordinates from [{:.9g}, {:.9g}] to [{:.9g}, {:.9g}], which seem to be degrees",
                        box_.min.x, box_.min.y, box_.max.x, box_.max.y),
            expected, std::string(in_degrees_advice) + "; or move them nearer to [0, 0], if they are metres");
  }
}

std::vector<Trace> MapReader::finish() {
  check_unit();
  if (mistakes_.empty() && traces_.empty()) mistake(0, 0, "", "no trace", "one trace or more");
  if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
  drawing::Placement placement = placement_;
  placement.scale = placement.scale.value_or(1.0);
  if (!(placement == drawing::Placement{.scale = 1.0})) {
    for (Trace& trace : traces_) {
      trace.a = placement(trace.a);
      trace.b = placement(trace.b);
    }
  }
  return std::move(traces_);
}

void MapReader::take_strengths(std::vector<TraceStrength>* strengths) {
  if (strengths == nullptr) return;
  const auto is_empty = [](const TraceStrength& strength) { return strength == TraceStrength{}; };
  if (std::ranges::all_of(strengths_, is_empty)) strengths_.clear();
  *strengths = std::move(strengths_);
}

std::string strength_expected(StrengthKey key) {
  return is_friction(key) ? "a friction angle, at least 0 and below 90°" : "a number of at least 0, in Pa";
}

bool is_strength(StrengthKey key, double value) {
  constexpr double right_angle = 90.0;
  return std::isfinite(value) && value >= 0.0 && (!is_friction(key) || value < right_angle);
}

std::vector<Trace> read_trace_map(const std::filesystem::path& path, int map_index,
                                  std::vector<TraceStrength>* strengths, const MapChoice& choice,
                                  std::string* skipped) {
  const std::string text = read_file(path);
  MapReader map(path.string(), map_index);
  map.place(choice.placement);
  if (drawing::is_dxf(text) || drawing::is_shapefile(text)) {
    read_drawn_lines(text, path, choice, map, skipped);
    return map.finish();
  }
  if (!choice.layers.empty())
    map.mistake(0, 0, "layers", "layers of a file that is no drawing", "no layers, or a drawing (DXF)");
  if (const auto foreign = foreign_format(text)) {
    map.mistake(0, 0, "", foreign->name, MapReader::format_expected, foreign->advice);
    return map.finish();
  }
  const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '{') {
    read_geojson(text, map);
  } else if (first != std::string::npos && is_wkt(std::string_view(text).substr(first))) {
    const auto [line, column] = line_and_column(text, first);
    read_wkt(std::string_view(text).substr(first), map, line, column);
  } else {
    read_trace_table(text, map);
  }
  std::vector<Trace> traces = map.finish();
  map.take_strengths(strengths);
  return traces;
}

std::vector<Trace> traces_of(const std::vector<std::vector<Vec2>>& lines, int map_index) {
  MapReader map("", map_index);
  for (const std::vector<Vec2>& vertices : lines) map.add(vertices);
  return map.finish();
}

}  // namespace keyblock::rockmass
