#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

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
      if (!trace.complete) continue;
      if (auto found = map_.add(trace.vertices)) {
        map_.mistake(trace.line, 1, "trace " + trace.name, std::move(*found), MapReader::trace_expected);
      }
    }
  }

 private:
  struct Polyline {
    std::string name;
    int line = 0;          ///< of its first row
    int last_line = 0;     ///< of its last one so far
    bool complete = true;  ///< no row of it had a mistake
    std::vector<Vec2> vertices;
  };

  bool header(std::string_view line, int number) {
    separator_ = line.find(',') == std::string_view::npos ? ';' : ',';
    const std::vector<Cell> cells = cells_of(line, separator_);
    columns_ = cells.size();
    bool complete = true;
    for (std::size_t name = 0; name < names.size(); ++name) {
      const auto is_named = [&](const Cell& cell) { return cell.text == names[name]; };
      const auto found = std::find_if(cells.begin(), cells.end(), is_named);
      if (found == cells.end()) {
        map_.mistake(number, 1, std::string(names[name]), "no such column in \"" + trimmed(line) + '"',
                     "a header with the columns trace, x, y");
        complete = false;
      } else if (const auto again = std::find_if(found + 1, cells.end(), is_named); again != cells.end()) {
        map_.mistake(number, again->column, std::string(names[name]), "the column again",
                     "every column once");
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
    Polyline& trace = trace_of(cells[places_[0]], number);
    if (cells.size() > columns_) {
      map_.mistake(number, cells[columns_].column, "", fmt::format("{} cells", cells.size()),
                   fmt::format("at most {}, the columns of the header", columns_));
      trace.complete = false;
      return;
    }
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

  Polyline& trace_of(const Cell& name, int number) {
    const auto [place, is_new] = by_name_.try_emplace(name.text, traces_.size());
    if (is_new) traces_.push_back({name.text, number, number, true, {}});
    Polyline& trace = traces_[place->second];
    if (place->second != current_ && !is_new) {
      map_.mistake(number, name.column, std::string(names[0]),
                   fmt::format("\"{}\" again, after rows of \"{}\"", name.text, traces_[current_].name),
                   fmt::format("rows of a trace that follow each other; the one before is in line {}",
                               trace.last_line));
      trace.complete = false;
    }
    current_ = place->second;
    trace.last_line = number;
    return trace;
  }

  static constexpr std::array<std::string_view, 3> names{"trace", "x", "y"};
  MapReader& map_;
  char separator_ = ',';
  std::array<std::size_t, 3> places_{};
  std::size_t columns_ = 0;  ///< of the header
  std::vector<Polyline> traces_;
  std::size_t current_ = 0;  ///< the trace of the last row
  std::map<std::string, std::size_t> by_name_;
};

}  // namespace

void read_trace_csv(std::string_view text, MapReader& map) {
  CsvReader(map).read(text);
}

}  // namespace keyblock::rockmass
