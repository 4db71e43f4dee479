#include "rockmass/trace_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "core/error.h"

namespace keyblock::rockmass {

namespace {

/// Mistakes beyond this number are not listed.
constexpr std::size_t max_mistakes = 20;

/// What both formats share: the traces found and the mistakes.
class MapReader {
 public:
  MapReader(std::string file, int map_index)
      : file_(std::move(file)), source_{TraceSource::Kind::trace_map, map_index} {}

  void mistake(int line, int column, std::string key, std::string found, std::string expected) {
    if (mistakes_.size() >= max_mistakes) return;
    mistakes_.push_back({{file_, line, column}, std::move(key), std::move(found), std::move(expected), {}});
  }

  /// Line, column and key are of the trace, for the message.
  void add(const std::vector<Vec2>& vertices, int line, int column, const std::string& key) {
    const std::size_t before = traces_.size();
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
      if (!(vertices[k] == vertices[k + 1])) traces_.push_back({vertices[k], vertices[k + 1], source_});
    }
    if (traces_.size() > before) return;
    mistake(line, column, key,
            vertices.size() == 1 ? "a trace of one vertex"
                                 : fmt::format("a trace of {} equal vertices", vertices.size()),
            "two or more different vertices");
  }

  std::vector<Trace> finish() {
    if (mistakes_.empty() && traces_.empty()) mistake(0, 0, "", "no trace", "one trace or more");
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    return std::move(traces_);
  }

 private:
  std::string file_;
  TraceSource source_;
  std::vector<Trace> traces_;
  std::vector<Diagnostic> mistakes_;
};

std::pair<int, int> line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? before.size() : before.size() - newline - 1;
  return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1, static_cast<int>(column) + 1};
}

// ---- GeoJSON

using Json = nlohmann::json;

std::string text_of(const Json& value) {
  std::string text = value.dump();
  return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

class GeoJsonReader {
 public:
  explicit GeoJsonReader(MapReader& map) : map_(map) {}

  void object(const Json& value, const std::string& key) {
    const std::string type =
        value.is_object()
            ? value.value("type", Json()).is_string() ? value["type"].get<std::string>() : std::string()
            : std::string();
    if (type == "FeatureCollection") {
      members(value, key, "features");
    } else if (type == "GeometryCollection") {
      members(value, key, "geometries");
    } else if (type == "Feature") {
      if (const auto geometry = value.find("geometry"); geometry != value.end() && !geometry->is_null()) {
        object(*geometry, join(key, "geometry"));
      }
    } else if (type == "LineString") {
      line(value, join(key, "coordinates"));
    } else if (type == "MultiLineString") {
      lines(value, join(key, "coordinates"));
    } else {
      map_.mistake(0, 0, join(key, "type"), type.empty() ? text_of(value) : '"' + type + '"',
                   "LineString or MultiLineString, alone or in a Feature or FeatureCollection");
    }
  }

 private:
  static std::string join(const std::string& key, const std::string& member) {
    return key.empty() ? member : key + '.' + member;
  }

  void members(const Json& value, const std::string& key, const char* name) {
    const auto list = value.find(name);
    if (list == value.end() || !list->is_array()) {
      map_.mistake(0, 0, join(key, name), list == value.end() ? "nothing" : text_of(*list), "a list");
      return;
    }
    for (std::size_t k = 0; k < list->size(); ++k)
      object((*list)[k], fmt::format("{}[{}]", join(key, name), k));
  }

  void lines(const Json& value, const std::string& key) {
    const auto list = value.find("coordinates");
    if (list == value.end() || !list->is_array()) {
      map_.mistake(0, 0, key, list == value.end() ? "nothing" : text_of(*list), "a list of lines");
      return;
    }
    for (std::size_t k = 0; k < list->size(); ++k) vertices((*list)[k], fmt::format("{}[{}]", key, k));
  }

  void line(const Json& value, const std::string& key) {
    const auto list = value.find("coordinates");
    vertices(list == value.end() ? Json() : *list, key);
  }

  void vertices(const Json& list, const std::string& key) {
    if (!list.is_array() || list.empty()) {
      map_.mistake(0, 0, key, text_of(list), "a list of [x, y]");
      return;
    }
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Json& p = list[k];
      if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number()) {
        map_.mistake(0, 0, fmt::format("{}[{}]", key, k), text_of(p), "[x, y], two finite numbers");
        return;
      }
      points.push_back({p[0].get<double>(), p[1].get<double>()});
    }
    map_.add(points, 0, 0, key);
  }

  MapReader& map_;
};

void read_geojson(std::string_view text, MapReader& map) {
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto [line, column] = line_and_column(text, error.byte > 0 ? error.byte - 1 : 0);
    map.mistake(line, column, "", "text that is no JSON", "GeoJSON");
    return;
  } catch (const Json::exception&) {
    map.mistake(0, 0, "", "a number that is not finite", "GeoJSON with finite numbers");
    return;
  }
  GeoJsonReader(map).object(root, "");
}

// ---- CSV

struct Cell {
  std::string text;
  int column = 1;  ///< where it begins in the line, in bytes from 1
};

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

/// Cells of one line; a quoted one may hold the separator, and a doubled quote for a quote.
std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  std::size_t begin = 0;
  bool quoted = false;
  std::string text;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    if (k == line.size() || (line[k] == separator && !quoted)) {
      const auto lead = line.substr(begin, k - begin).find_first_not_of(" \t");
      cells.push_back(
          {trimmed(text), static_cast<int>(begin + (lead == std::string_view::npos ? 0 : lead)) + 1});
      begin = k + 1;
      text.clear();
    } else if (line[k] == '"') {
      if (quoted && k + 1 < line.size() && line[k + 1] == '"') {
        text += line[++k];
      } else {
        quoted = !quoted;
      }
    } else {
      text += line[k];
    }
  }
  return cells;
}

std::optional<double> finite_number(const std::string& text) {
  double value = 0.0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

class CsvReader {
 public:
  explicit CsvReader(MapReader& map) : map_(map) {}

  void read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    int number = 0;
    bool header_read = false;
    while (!text.empty()) {
      const auto end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++number;
      if (trimmed(line).empty()) continue;
      if (header_read) {
        row(line, number);
      } else if (header(line, number)) {
        header_read = true;
      } else {
        return;
      }
    }
    if (!header_read) map_.mistake(1, 1, "", "an empty file", "a header with the columns trace, x, y");
    for (const Polyline& trace : traces_) {
      if (trace.complete) map_.add(trace.vertices, trace.line, 1, "trace " + trace.name);
    }
  }

 private:
  struct Polyline {
    std::string name;
    int line = 0;
    bool complete = true;  ///< no row of it had a mistake
    std::vector<Vec2> vertices;
  };

  bool header(std::string_view line, int number) {
    separator_ = line.find(',') == std::string_view::npos ? ';' : ',';
    const std::vector<Cell> cells = cells_of(line, separator_);
    bool complete = true;
    for (std::size_t name = 0; name < names.size(); ++name) {
      const auto found = std::find_if(cells.begin(), cells.end(),
                                      [&](const Cell& cell) { return cell.text == names[name]; });
      if (found == cells.end()) {
        map_.mistake(number, 1, std::string(names[name]), "no such column in \"" + trimmed(line) + '"',
                     "a header with the columns trace, x, y");
        complete = false;
      }
      places_[name] = static_cast<std::size_t>(found - cells.begin());
    }
    return complete;
  }

  void row(std::string_view line, int number) {
    const std::vector<Cell> cells = cells_of(line, separator_);
    const std::size_t needed = *std::max_element(places_.begin(), places_.end()) + 1;
    if (cells.size() < needed) {
      map_.mistake(number, 1, "", fmt::format("{} cells", cells.size()), fmt::format("{} or more", needed));
      return;
    }
    Polyline& trace = trace_named(cells[places_[0]].text, number);
    const auto coordinate = [&](std::size_t name) {
      const Cell& cell = cells[places_[name]];
      const std::optional<double> value = finite_number(cell.text);
      if (!value) {
        map_.mistake(number, cell.column, std::string(names[name]), '"' + cell.text + '"', "a finite number");
      }
      return value;
    };
    const std::optional<double> x = coordinate(1), y = coordinate(2);
    if (x && y) {
      trace.vertices.push_back({*x, *y});
    } else {
      trace.complete = false;
    }
  }

  Polyline& trace_named(const std::string& name, int number) {
    const auto [place, is_new] = by_name_.try_emplace(name, traces_.size());
    if (is_new) traces_.push_back({name, number, true, {}});
    return traces_[place->second];
  }

  static constexpr std::array<std::string_view, 3> names{"trace", "x", "y"};
  MapReader& map_;
  char separator_ = ',';
  std::array<std::size_t, 3> places_{};
  std::vector<Polyline> traces_;
  std::map<std::string, std::size_t> by_name_;
};

}  // namespace

std::vector<Trace> read_trace_map(const std::filesystem::path& path, int map_index) {
  const std::string text = read_file(path);
  MapReader map(path.string(), map_index);
  const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '{') {
    read_geojson(text, map);
  } else {
    CsvReader(map).read(text);
  }
  return map.finish();
}

}  // namespace keyblock::rockmass
