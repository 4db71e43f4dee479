#include "rockmass/trace_map.h"

#include <algorithm>
#include <string>

#include "core/atomic_file.h"
#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {

std::pair<int, int> line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? before.size() : before.size() - newline - 1;
  return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1, static_cast<int>(column) + 1};
}

std::vector<Trace> read_trace_map(const std::filesystem::path& path, int map_index) {
  const std::string text = read_file(path);
  MapReader map(path.string(), map_index);
  const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '{') {
    read_geojson(text, map);
  } else {
    read_trace_csv(text, map);
  }
  return map.finish();
}

}  // namespace keyblock::rockmass
