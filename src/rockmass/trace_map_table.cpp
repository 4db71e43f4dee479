#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rockmass/trace_map_columns.h"
#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

struct Cell {
  std::string text;
  int column = 1;  ///< where it begins in the line, in bytes from 1
};

constexpr char any_space = ' ';  // as a separator: any number of spaces and tabs
/// Those that come first are tried first.
constexpr std::array<char, 4> separators{',', ';', '\t', any_space};

bool separates(char character, char separator) {
  return character == separator || (separator == any_space && character == '\t');
}

/// Cells of one line; a quoted one may hold the separator, and a doubled quote for a quote.
std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  std::size_t begin = 0;
  bool quoted = false;
  std::string text;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    if (k == line.size() || (separates(line[k], separator) && !quoted)) {
      const auto lead = line.substr(begin, k - begin).find_first_not_of(" \t");
      Cell cell{std::string(trimmed(text)),
                static_cast<int>(begin + (lead == std::string_view::npos ? 0 : lead)) + 1};
      if (separator != any_space || !cell.text.empty()) cells.push_back(std::move(cell));
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

/// Where commas separate no cells, one may stand for the decimal point.
std::optional<double> finite_number(std::string text, char separator) {
  if (separator != ',' && text.find('.') == std::string::npos)
    std::replace(text.begin(), text.end(), ',', '.');
  double value = 0.0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::vector<std::string> names_in(const std::vector<Cell>& cells) {
  std::vector<std::string> names;
  for (const Cell& cell : cells) names.push_back(lower(cell.text));
  return names;
}

bool are_points(std::vector<Cell> cells, char separator) {
  while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
  return cells.size() >= 4 && cells.size() % 2 == 0 &&
         std::all_of(cells.begin(), cells.end(),
                     [&](const Cell& cell) { return finite_number(cell.text, separator).has_value(); });
}

class TableReader {
 public:
  explicit TableReader(MapReader& map) : map_(map) {}

  void read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    int number = 0;
    while (!text.empty()) {
      const std::string_view line = take_line(text);
      ++number;
      if (trimmed(line).empty()) continue;
      if (kind_ != Kind::unknown) {
        row(line, number);
      } else if (!line.starts_with('#') && !begin(line, number)) {
        return;
      }
    }
    if (kind_ == Kind::unknown) map_.mistake(1, 1, "", "an empty file", header_expected);
    finish();
  }

 private:
  enum class Kind { unknown, vertices, points, ends, wkt };

  struct Polyline {
    std::string name;
    int line = 0;          ///< of its first row
    int last_line = 0;     ///< of its last one so far
    bool complete = true;  ///< no row of it had a mistake
    std::vector<Vec2> vertices;
    TraceStrength strength = {};
  };

  /// What kind of table the first line begins.
  bool begin(std::string_view line, int number) {
    for (const char separator : separators) {
      separator_ = separator;
      const std::vector<Cell> cells = cells_of(line, separator);
      const std::vector<std::string> names = names_in(cells);
      columns_ = cells.size();
      const auto x = column_of(names, {"x", "lon", "long", "lng", "longitude"});
      const auto y = column_of(names, {"y", "lat", "latitude"});
      if (!find_strengths(names, cells, number)) return false;
      if (const auto trace = column_of(names, {"trace"}); trace && x && y) {
        places_ = {*trace, *x, *y};
        if (names[*x] != "x" && names[*y] != "y")
          map_.names_system(number, cells[*x].column, "", "longitude, latitude");
        return header_of_vertices(names, cells, number);
      }
      if (const auto wkt = column_of(names, {"wkt", "wkt_geom", "geometry", "geom", "the_geom"})) {
        kind_ = Kind::wkt;
        places_ = {*wkt, *wkt, *wkt};
        return true;
      }
      if (is_header_of_points(names)) {
        kind_ = Kind::points;
        return true;
      }
      if (vertex_places_ = places_of_vertices(names); !vertex_places_.empty()) {
        kind_ = Kind::ends;
        return header_of_ends(names, cells, number);
      }
      if (!are_points(cells, separator)) continue;
      kind_ = Kind::points;
      headerless_ = true;
      row_of_points(cells, number);
      return true;
    }
    missing_columns(line, number);
    return false;
  }

  /// Columns of strengths. False: one is there twice.
  bool find_strengths(const std::vector<std::string>& names, const std::vector<Cell>& cells, int number) {
    for (std::size_t k = 0; k < strength_count; ++k) {
      strength_places_[k] = column_of(names, {strength_names[k]});
      if (!strength_places_[k]) continue;
      const auto first = names.begin() + static_cast<std::ptrdiff_t>(*strength_places_[k]);
      const auto again = std::find(first + 1, names.end(), strength_names[k]);
      if (again == names.end()) continue;
      map_.mistake(number, cells[static_cast<std::size_t>(again - names.begin())].column, strength_names[k],
                   "the column again", "every column once");
      return false;
    }
    return true;
  }

  /// Of the row of a trace. What other rows of it have must be the same.
  bool add_strengths(const std::vector<Cell>& cells, int number, TraceStrength& strength) {
    bool complete = true;
    for (std::size_t k = 0; k < strength_count; ++k) {
      const auto place = strength_places_[k];
      if (!place || *place >= cells.size() || cells[*place].text.empty()) continue;
      const Cell& cell = cells[*place];
      const auto key = static_cast<StrengthKey>(k);
      const std::optional<double> value = finite_number(cell.text, separator_);
      const bool is_other = value && strength[k] && *strength[k] != *value;
      if (!value || !is_strength(key, *value) || is_other) {
        map_.mistake(number, cell.column, strength_names[k], '"' + cell.text + '"',
                     is_other ? fmt::format("{} as in the rows before: a trace has one", *strength[k])
                              : strength_expected(key));
        complete = false;
        continue;
      }
      strength[k] = value;
    }
    return complete;
  }

  /// `x1 y1 x2 y2 x1` does not say which x1 is meant.
  bool header_of_ends(const std::vector<std::string>& names, const std::vector<Cell>& cells, int number) {
    std::vector<bool> is_taken(names.size(), false);
    for (const auto& [x, y] : vertex_places_) is_taken[x] = is_taken[y] = true;
    bool complete = true;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (is_taken[k]) continue;
      for (std::size_t taken = 0; taken < names.size(); ++taken) {
        if (!is_taken[taken] || names[taken] != names[k]) continue;
        map_.mistake(number, cells[k].column, names[k], "the column again", "every column once");
        complete = false;
        break;
      }
    }
    return complete;
  }

  bool header_of_vertices(const std::vector<std::string>& names, const std::vector<Cell>& cells, int number) {
    bool complete = true;
    for (const std::size_t place : places_) {
      const auto again =
          std::find(names.begin() + static_cast<std::ptrdiff_t>(place) + 1, names.end(), names[place]);
      if (again == names.end()) continue;
      map_.mistake(number, cells[static_cast<std::size_t>(again - names.begin())].column, names[place],
                   "the column again", "every column once");
      complete = false;
    }
    kind_ = Kind::vertices;
    return complete;
  }

  void missing_columns(std::string_view line, int number) {
    const bool has_tabs = line.find('\t') != std::string_view::npos;
    const char separator = line.find(',') != std::string_view::npos   ? ','
                           : line.find(';') != std::string_view::npos ? ';'
                           : has_tabs                                 ? '\t'
                                                                      : any_space;
    const std::vector<std::string> names = names_in(cells_of(line, separator));
    for (const char* name : {"trace", "x", "y"}) {
      if (column_of(names, {name})) continue;
      map_.mistake(number, 1, name, "no such column in \"" + shortened(trimmed(line)) + '"', header_expected,
                   "without a header, a line is a trace: x y x y …");
    }
  }

  void row(std::string_view line, int number) {
    const std::vector<Cell> cells = cells_of(line, separator_);
    if (kind_ == Kind::points) return row_of_points(cells, number);
    if (kind_ == Kind::ends) return row_of_ends(cells, number);
    const std::size_t needed = *std::max_element(places_.begin(), places_.end()) + 1;
    if (cells.size() < needed) {
      map_.mistake(number, 1, "", fmt::format("{} cells", cells.size()), fmt::format("{} or more", needed));
    } else if (kind_ == Kind::wkt) {
      const Cell& cell = cells[places_[0]];
      TraceStrength strength;
      if (!cell.text.empty() && add_strengths(cells, number, strength)) {
        map_.set_strength(strength);
        read_wkt(cell.text, map_, number, cell.column);
      }
    } else {
      row_of_vertex(cells, number);
    }
  }

  void row_of_vertex(const std::vector<Cell>& cells, int number) {
    Polyline& trace = trace_of(cells[places_[0]], number);
    if (cells.size() > columns_) {
      map_.mistake(number, cells[columns_].column, "", fmt::format("{} cells", cells.size()),
                   fmt::format("at most {}, the columns of the header", columns_));
      trace.complete = false;
      return;
    }
    const std::optional<double> x = coordinate(cells[places_[1]], "x", number),
                                y = coordinate(cells[places_[2]], "y", number);
    if (x && y && add_strengths(cells, number, trace.strength)) {
      trace.vertices.push_back({*x, *y});
    } else {
      trace.complete = false;
    }
  }

  void row_of_points(std::vector<Cell> cells, int number) {
    while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
    const bool whole = cells.size() >= 4 && cells.size() % 2 == 0;
    if (!whole)
      map_.mistake(number, 1, "", fmt::format("{} cells", cells.size()),
                   "x y x y …, of two vertices or more");
    traces_.push_back({"", number, number, whole, {}});
    for (std::size_t k = 0; whole && k < cells.size(); k += 2) {
      const std::optional<double> x = coordinate(cells[k], "x", number),
                                  y = coordinate(cells[k + 1], "y", number);
      traces_.back().complete = traces_.back().complete && x && y;
      if (x && y) traces_.back().vertices.push_back({*x, *y});
    }
  }

  /// Of vertices after the second one both cells may be empty.
  void row_of_ends(const std::vector<Cell>& cells, int number) {
    traces_.push_back({"", number, number, true, {}});
    Polyline& trace = traces_.back();
    trace.complete = add_strengths(cells, number, trace.strength);
    for (std::size_t k = 0; k < vertex_places_.size(); ++k) {
      const auto [at_x, at_y] = vertex_places_[k];
      const bool there = at_x < cells.size() && at_y < cells.size();
      if (k >= 2 && (!there || (cells[at_x].text.empty() && cells[at_y].text.empty()))) return;
      if (!there) {
        map_.mistake(number, 1, "", fmt::format("{} cells", cells.size()),
                     fmt::format("{} or more", std::max(at_x, at_y) + 1));
        trace.complete = false;
        return;
      }
      const std::optional<double> x = coordinate(cells[at_x], "x", number),
                                  y = coordinate(cells[at_y], "y", number);
      trace.complete = trace.complete && x && y;
      if (x && y) trace.vertices.push_back({*x, *y});
    }
  }

  std::optional<double> coordinate(const Cell& cell, const char* name, int number) {
    const std::optional<double> value = finite_number(cell.text, separator_);
    if (!value) map_.mistake(number, cell.column, name, '"' + cell.text + '"', "a finite number");
    return value;
  }

  Polyline& trace_of(const Cell& name, int number) {
    const auto [place, is_new] = by_name_.try_emplace(name.text, traces_.size());
    if (is_new) traces_.push_back({name.text, number, number, true, {}});
    Polyline& trace = traces_[place->second];
    if (place->second != current_ && !is_new) {
      map_.mistake(number, name.column, "trace",
                   fmt::format("\"{}\" again, after rows of \"{}\"", name.text, traces_[current_].name),
                   fmt::format("rows of a trace that follow each other; the one before is in line {}",
                               trace.last_line));
      trace.complete = false;
    }
    current_ = place->second;
    trace.last_line = number;
    return trace;
  }

  /// Rows `number x y z` without a header look like traces of two vertices: their first values are whole numbers that ascend by
  /// one, each several times.
  [[nodiscard]] bool seem_numbered() const {
    std::size_t repeated = 0;
    for (std::size_t k = 0; k < traces_.size(); ++k) {
      if (traces_[k].vertices.size() != 2) return false;
      const double first = traces_[k].vertices[0].x;
      const double before = k == 0 ? first - 1.0 : traces_[k - 1].vertices[0].x;
      if (first != std::floor(first) || (first != before && first != before + 1.0)) return false;
      if (first == before) {
        ++repeated;
      } else if (k > 0 && repeated == 0) {
        return false;
      } else {
        repeated = 0;
      }
    }
    return repeated > 0 && traces_.front().vertices[0].x != traces_.back().vertices[0].x;
  }

  /// Rows `id x1 y1 x2 y2 set` without a header look like traces of three vertices: their first values count the rows.
  [[nodiscard]] bool seem_counted() const {
    if (traces_.size() < 2) return false;
    for (std::size_t k = 0; k < traces_.size(); ++k) {
      const std::vector<Vec2>& vertices = traces_[k].vertices;
      if (vertices.size() < 3 || vertices[0].x != std::floor(vertices[0].x)) return false;
      if (k > 0 && vertices[0].x != traces_[k - 1].vertices[0].x + 1.0) return false;
    }
    return true;
  }

  void finish() {
    if (kind_ == Kind::points && headerless_ && seem_counted()) {
      map_.mistake(traces_.front().line, 1, "", "rows without a header whose first numbers count them",
                   "a header with the names of the columns, such as id x1 y1 x2 y2 set",
                   "if they are traces of three vertices or more, begin with the line: x1 y1 x2 y2 x3 y3");
    }
    if (kind_ == Kind::points && headerless_ && seem_numbered()) {
      map_.mistake(traces_.front().line, 1, "",
                   "rows without a header that begin with the number of their trace", header_expected,
                   "if they are traces of two vertices each, begin with the line: x1 y1 x2 y2");
    }
    for (const Polyline& trace : traces_) {
      if (!trace.complete) continue;
      map_.set_strength(trace.strength);
      if (auto found = map_.add(trace.vertices)) {
        map_.mistake(trace.line, 1, trace.name.empty() ? "" : "trace " + trace.name, std::move(*found),
                     MapReader::trace_expected);
      }
    }
  }

  static constexpr const char* header_expected = "a header with the columns trace, x, y, or x1, y1, x2, y2";
  MapReader& map_;
  Kind kind_ = Kind::unknown;
  bool headerless_ = false;
  char separator_ = ',';
  std::array<std::optional<std::size_t>, strength_count> strength_places_{};
  std::array<std::size_t, 3> places_{};                             ///< of trace, x, y; of the geometry
  std::size_t columns_ = 0;                                         ///< of the header
  std::vector<std::pair<std::size_t, std::size_t>> vertex_places_;  ///< x and y of each vertex of a row
  std::vector<Polyline> traces_;
  std::size_t current_ = 0;  ///< the trace of the last row
  std::map<std::string, std::size_t> by_name_;
};

}  // namespace

void read_trace_table(std::string_view text, MapReader& map) {
  TableReader(map).read(text);
}

}  // namespace keyblock::rockmass
