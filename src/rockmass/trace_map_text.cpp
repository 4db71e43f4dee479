#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::toupper(c); });
  return out;
}

const std::string to_geojson = "turn it into GeoJSON: in QGIS by Export, Save features as; or by ogr2ogr ";

/// Formats that are known by their first bytes.
std::optional<ForeignFormat> by_first_bytes(std::string_view text) {
  using std::string_view_literals::operator""sv;
  const ForeignFormat utf_16{"text in UTF-16", "save it as text in UTF-8, or as CSV"};
  const std::pair<std::string_view, ForeignFormat> known[] = {
      {"SQLite format 3", {"a GeoPackage (SQLite)", to_geojson + "-f GeoJSON lines.geojson lines.gpkg"}},
      {"AutoCAD Binary DXF", {"a drawing (binary DXF)", "save it as DXF, as text (ASCII)"}},
      {"AC10", {"an AutoCAD drawing (DWG)", "save it as DXF, as text (ASCII)"}},
      {"PK\x03\x04",
       {"a packed file (ZIP, KMZ, XLSX)", "unpack it, or save the table as CSV, and name the file in it"}},
      {"PROJCS[", {"the projection of a shapefile (.prj)", "name the file with the lines"}},
      {"GEOGCS[", {"the projection of a shapefile (.prj)", "name the file with the lines"}},
      {"\xFF\xFE", utf_16},
      {"\xFE\xFF", utf_16}};
  for (const auto& [bytes, format] : known) {
    if (text.starts_with(bytes)) return format;
  }
  return std::nullopt;
}

ForeignFormat xml_format(std::string_view text) {
  constexpr std::size_t enough = 4096;
  const std::string beginning = upper(text.substr(0, enough));
  // Both are in degrees always.
  const std::string project = "-f GeoJSON -t_srs EPSG:32633 lines.geojson ";
  if (beginning.find("<KML") != std::string::npos)
    return {"KML, which is in degrees", to_geojson + project + "lines.kml (33: your UTM zone)"};
  if (beginning.find("<GPX") != std::string::npos)
    return {"GPX, which is in degrees", to_geojson + project + "lines.gpx tracks (33: your UTM zone)"};
  if (beginning.find("<SVG") != std::string::npos) return {"a picture (SVG)", "save its lines as DXF"};
  return {"XML", to_geojson + "-f GeoJSON lines.geojson FILE"};
}

}  // namespace

std::pair<int, int> line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? before.size() : before.size() - newline - 1;
  return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1, static_cast<int>(column) + 1};
}

std::string shortened(std::string_view text) {
  return text.size() <= 40 ? std::string(text) : std::string(text.substr(0, 37)) + "...";
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  const std::size_t mark = text.starts_with("\r\n") ? 2 : 1;
  text.remove_prefix(std::min(mark, text.size()));
  return line;
}

bool is_in_degrees(std::string_view system) {
  const std::string name = upper(trimmed(system));
  for (const char* word : {"CRS84", "CRS83", "CRS27"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  if (name == "WGS84" || name == "WGS 84" || name == "LONGITUDE, LATITUDE") return true;
  // Systems of longitude and latitude have numbers from 4001 to 4999; some of other kinds, too, but their coordinates are
  // far from any degrees. Newer ones of large countries follow.
  constexpr std::array<int, 4> newer{6318, 6668, 7844, 9057};
  const auto digits = name.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
  int code = 0;
  const auto [end, error] = std::from_chars(name.data() + digits, name.data() + name.size(), code);
  if (error != std::errc() || (digits > 0 && name.find("EPSG") == std::string::npos)) return false;
  return (code > 4000 && code < 5000) || std::find(newer.begin(), newer.end(), code) != newer.end();
}

std::optional<ForeignFormat> foreign_format(std::string_view text) {
  constexpr std::size_t enough = 4096;
  if (auto format = by_first_bytes(text)) return format;
  if (text.substr(0, enough).find('\0') != std::string_view::npos)
    return ForeignFormat{"a file that is no text", to_geojson + "-f GeoJSON lines.geojson FILE"};
  const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string_view::npos && text[first] == '<') return xml_format(text.substr(first));
  return std::nullopt;
}

}  // namespace keyblock::rockmass
