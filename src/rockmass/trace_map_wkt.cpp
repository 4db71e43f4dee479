#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

constexpr std::array<std::string_view, 11> geometries{
    "POINT",        "LINESTRING",         "POLYGON",        "MULTIPOINT",    "MULTILINESTRING",
    "MULTIPOLYGON", "GEOMETRYCOLLECTION", "CIRCULARSTRING", "COMPOUNDCURVE", "CURVEPOLYGON",
    "MULTICURVE"};
constexpr int most_collections = 32;  // collections within collections

/// Well-known text (ISO 19125), with `SRID=…;` before a geometry as PostGIS writes it. Reads up to the first mistake.
class WktReader {
 public:
  WktReader(std::string_view text, MapReader& map, int line, int column)
      : text_(text), map_(map), line_(line), column_(column) {}

  void read() {
    for (skip_space(); at_ < text_.size(); skip_separators()) {
      if (!geometry(0)) return;
    }
  }

 private:
  bool geometry(int depth) {
    const std::size_t begin = at_;
    std::string type = word();
    if (type == "SRID" && take('=')) {
      const std::size_t number = at_;
      const std::string srid = word();
      const auto [line, column] = place(number);
      map_.names_system(line, column, "SRID", "EPSG:" + srid);
      take(';');
      type = word();
    }
    const std::size_t after = at_;
    std::string kind = word();  // Z, M, ZM
    if (kind != "Z" && kind != "M" && kind != "ZM") {
      at_ = after;
      if (kind == "EMPTY") return static_cast<void>(word()), true;
      for (const char* suffix : {"ZM", "Z", "M"}) {
        if (!type.ends_with(suffix) || type.size() <= 4) continue;
        type.resize(type.size() - std::string_view(suffix).size());
        break;
      }
    }
    if (type == "GEOMETRYCOLLECTION" && depth < most_collections)
      return list([&] { return geometry(depth + 1); });
    if (type == "MULTILINESTRING") return list([&] { return line_string(); });
    if (type == "LINESTRING") return line_string();
    return fail(begin, type.empty() ? rest(begin) : '"' + shortened(type) + '"',
                "LINESTRING or MULTILINESTRING");
  }

  /// `( one, another, … )`
  template <class Item>
  bool list(const Item& item) {
    if (!expect('(')) return false;
    do {
      if (!item()) return false;
    } while (take(','));
    return expect(')');
  }

  bool line_string() {
    skip_space();
    const std::size_t begin = at_;
    std::vector<Vec2> vertices;
    if (!list([&] { return vertex(vertices); })) return false;
    if (auto found = map_.add(vertices)) {
      const auto [line, column] = place(begin);
      map_.mistake(line, column, "", std::move(*found), MapReader::trace_expected);
    }
    return true;
  }

  /// Heights and measures are left out.
  bool vertex(std::vector<Vec2>& vertices) {
    std::array<double, 4> values{};
    std::size_t count = 0;
    const std::size_t begin = at_;
    while (count < values.size()) {
      const auto value = number();
      if (!value) break;
      values[count++] = *value;
    }
    if (count < 2) return fail(begin, rest(at_), "x y, two finite numbers");
    vertices.push_back({values[0], values[1]});
    return true;
  }

  std::optional<double> number() {
    skip_space();
    double value = 0.0;
    const char* first = text_.data() + at_;
    const auto [end, error] =
        std::from_chars(first + (take_sign() ? 1 : 0), text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  [[nodiscard]] bool take_sign() const { return at_ < text_.size() && text_[at_] == '+'; }

  /// Letters and digits, in capitals.
  std::string word() {
    skip_space();
    std::string out;
    for (; at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_])) != 0; ++at_)
      out += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_])));
    return out;
  }

  void skip_space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  void skip_separators() { at_ = std::min(text_.find_first_not_of(" \t\r\n;,", at_), text_.size()); }

  bool take(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool expect(char c) { return take(c) || fail(at_, rest(at_), fmt::format("\"{}\"", c)); }

  [[nodiscard]] std::string rest(std::size_t from) const {
    const std::string_view line = text_.substr(from, text_.find_first_of("\r\n", from) - from);
    return line.empty() ? "the end of the text" : '"' + shortened(line) + '"';
  }

  [[nodiscard]] std::pair<int, int> place(std::size_t offset) const {
    const auto [line, column] = line_and_column(text_, offset);
    return {line_ + line - 1, line == 1 ? column_ + column - 1 : column};
  }

  bool fail(std::size_t offset, std::string found, std::string expected) {
    const auto [line, column] = place(offset);
    map_.mistake(line, column, "", std::move(found), std::move(expected));
    return false;
  }

  std::string_view text_;
  MapReader& map_;
  int line_, column_;
  std::size_t at_ = 0;
};

}  // namespace

bool is_wkt(std::string_view text) {
  std::string beginning(text.substr(0, 40));
  std::transform(beginning.begin(), beginning.end(), beginning.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  if (beginning.starts_with("SRID=")) return true;
  return std::any_of(geometries.begin(), geometries.end(), [&](std::string_view name) {
    if (!beginning.starts_with(name)) return false;
    const std::string_view after = trimmed(std::string_view(beginning).substr(name.size()));
    const auto bracket = after.find_first_not_of("ZM ");
    return after.starts_with("EMPTY") || (bracket != std::string_view::npos && after[bracket] == '(');
  });
}

void read_wkt(std::string_view text, MapReader& map, int line, int column) {
  WktReader(text, map, line, column).read();
}

}  // namespace keyblock::rockmass
