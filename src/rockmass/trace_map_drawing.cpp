#include <fmt/format.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/read_file.h"
#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

// The system of coordinates of a shapefile stands beside it.
void name_system_beside(const std::filesystem::path& path, MapReader& map) {
  std::filesystem::path projection = path;
  projection.replace_extension(".prj");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(projection, ignored)) return;
  if (read_file(projection).starts_with("GEOGCS"))
    map.names_system(0, 0, projection.filename().string(), "longitude, latitude");
}

}  // namespace

void read_drawn_lines(std::string_view text, const std::filesystem::path& path, const MapChoice& choice,
                      MapReader& map, std::string* skipped) {
  const drawing::Drawing drawn = drawing::read_drawing(text, path.string());
  const bool on_layers = drawing::is_dxf(text);
  if (!on_layers) name_system_beside(path, map);
  const std::vector<drawing::DrawnLine> lines = drawing::lines_on(drawn, choice.layers);
  drawing::Placement placement = choice.placement;
  placement.scale = drawing::scale_of(drawn, lines, placement);
  map.place(placement);
  for (const drawing::DrawnLine& line : lines) {
    std::vector<Vec2> vertices = line.vertices;
    if (line.closed && !vertices.empty()) vertices.push_back(vertices.front());
    const std::string entity = fmt::format(
        "{} {}", line.entity, on_layers ? "on layer " + line.layer : fmt::format("of record {}", line.line));
    if (auto found = map.add(vertices))
      map.mistake(on_layers ? line.line : 0, on_layers ? 1 : 0, entity, std::move(*found),
                  MapReader::trace_expected);
  }
  if (skipped != nullptr) *skipped = drawing::skipped_words(drawn, choice.layers);
}

}  // namespace keyblock::rockmass
