#include "loading/suite_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "core/error.h"
#include "core/read_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view title_of_peer = "Summary of Metadata of Selected Records";
constexpr std::size_t most_of_list = 16 << 20;  // bytes

/// Columns that mean something here: our name, and that of PEER.
constexpr std::pair<const char*, const char*> columns_of_peer[] = {
    {"name", "Record Sequence Number"},
    {"scale", "Scale Factor"},
    {"event", "Earthquake Name"},
    {"magnitude", "Magnitude"},
    {"distance_km", "Rrup (km)"},
    {"vs30_m_s", "Vs30 (m/sec)"},
    {"pulse_period_s", "Tp-Pulse Period (sec)"},
    {"h1", "Horizontal-1 Acc. Filename"},
    {"h2", "Horizontal-2 Acc. Filename"},
    {"up", "Vertical Acc. Filename"}};

constexpr std::string_view own_columns[] = {"name",      "h1",          "h2",       "up",
                                            "azimuth1",  "azimuth2",    "event",    "scale",
                                            "magnitude", "distance_km", "vs30_m_s", "pulse_period_s"};
/// Of other programs; they would change what the study says, and are not known here.
constexpr std::string_view refused_columns[] = {"weight", "levels"};

std::string trimmed(std::string text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  text.erase(text.begin(), std::ranges::find_if_not(text, is_blank));
  return text;
}

class SuiteListReader {
 public:
  explicit SuiteListReader(const fs::path& file)
      : file_(file), text_(file.string(), read_file(file, most_of_list)) {}

  std::vector<SuiteRecord> read() {
    is_of_peer_ = text_.find(title_of_peer) < text_.size();
    std::size_t line = is_of_peer_ ? text_.find(title_of_peer) + 1 : 0;
    while (line < text_.size() && is_left_out(line)) ++line;
    if (line >= text_.size())
      text_.refuse("no line with the names of columns", "a list of records: name,h1,h2,up");
    read_names(line);
    for (++line; line < text_.size(); ++line) {
      if (is_left_out(line)) {
        if (is_of_peer_ && !records_.empty()) break;
        continue;
      }
      read_row(line);
    }
    if (records_.empty()) text_.refuse("no records", "a line for each record");
    check_events();
    return std::move(records_);
  }

 private:
  [[nodiscard]] bool is_left_out(std::size_t line) const {
    const std::string_view text = text_.line(line);
    const bool is_comment = !is_of_peer_ && text.starts_with('#');
    return is_comment || text.find_first_not_of(" ,\t") == std::string_view::npos;
  }

  /// Between commas, without quotes and blanks around them (RFC 4180).
  [[nodiscard]] std::vector<std::string> fields(std::size_t line) const {
    const std::string_view text = text_.line(line);
    std::vector<std::string> found(1);
    bool is_quoted = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
      const char c = text[k];
      if (c == '"' && is_quoted && k + 1 < text.size() && text[k + 1] == '"') {
        found.back() += text[++k];
      } else if (c == '"') {
        is_quoted = !is_quoted;
      } else if (c == ',' && !is_quoted) {
        found.emplace_back();
      } else {
        found.back() += c;
      }
    }
    if (is_quoted) text_.fail(line, text.size(), "a quote that does not end in its line", "a closing \"");
    for (std::string& field : found) field = trimmed(std::move(field));
    return found;
  }

  void read_names(std::size_t line) {
    const std::vector<std::string> names = fields(line);
    for (std::size_t k = 0; k < names.size(); ++k) {
      std::string name = names[k];
      for (const auto& [own, of_peer] : columns_of_peer)
        if (is_of_peer_ && name == of_peer) name = own;
      if (std::ranges::find(refused_columns, name) != std::end(refused_columns))
        text_.fail(line, column_of(line, k), fmt::format("the column \"{}\"", name),
                   "a list without it: all records count alike, at all levels");
      if (std::ranges::find(own_columns, name) == std::end(own_columns)) continue;
      if (!place_.emplace(name, k).second)
        text_.fail(line, column_of(line, k), fmt::format("the column \"{}\" again", name),
                   "each column once");
    }
    if (!place_.contains("h1"))
      text_.fail(
          line, 0, "no column of the first horizontal component",
          is_of_peer_ ? "\"Horizontal-1 Acc. Filename\"" : "columns by their names: name,h1,h2,up,event");
  }

  /// Of field k, which counts from 0; the column counts from 1.
  [[nodiscard]] std::size_t column_of(std::size_t line, std::size_t k) const {
    const std::string_view text = text_.line(line);
    std::size_t at = 1;
    bool is_quoted = false;
    for (std::size_t c = 0; c < text.size() && k > 0; ++c) {
      if (text[c] == '"') is_quoted = !is_quoted;
      if (text[c] != ',' || is_quoted) continue;
      --k;
      at = c + 2;
    }
    return at;
  }

  /// A value of the row at hand; empty where there is none, or PEER has a dash.
  [[nodiscard]] std::string value(const char* column) const {
    const auto found = place_.find(column);
    if (found == place_.end() || found->second >= row_.size()) return {};
    const std::string& text = row_[found->second];
    return is_of_peer_ && text == "-" ? std::string() : text;
  }

  [[noreturn]] void fail(const char* column, const std::string& expected) const {
    const auto found = place_.find(column);
    const std::size_t k = found == place_.end() ? 0 : found->second;
    const std::string text = value(column);
    text_.fail(
        line_, column_of(line_, k),
        text.empty() ? fmt::format("nothing in the column \"{}\"", column) : fmt::format("\"{}\"", text),
        expected);
  }

  [[nodiscard]] std::optional<double> number(const char* column, double least, double most,
                                             const char* expected) const {
    const std::string text = value(column);
    if (text.empty()) return std::nullopt;
    double read = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc() || end != text.data() + text.size() || !(read >= least && read <= most))
      fail(column, expected);
    return read;
  }

  [[nodiscard]] fs::path component(const char* column) {
    const std::string name = value(column);
    if (name.empty()) return {};
    const fs::path path = (file_.parent_path() / name).lexically_normal();
    std::error_code error;
    if (!fs::is_regular_file(path, error)) fail(column, "a file in or below " + file_.parent_path().string());
    if (!files_.insert(path).second) fail(column, "each file once");
    return path;
  }

  void read_row(std::size_t line) {
    line_ = line;
    row_ = fields(line);
    SuiteRecord record;
    record.line = line + 1;
    record.h1 = component("h1");
    if (record.h1.empty()) fail("h1", "the file of a horizontal component");
    record.h2 = component("h2");
    record.up = component("up");
    record.name = value("name");
    if (record.name.empty())
      record.name = record.h1.stem().string();
    else if (is_of_peer_)
      record.name = "RSN" + record.name;
    if (!names_.insert(record.name).second) fail("name", "a name that no other record has");
    record.azimuth1 = number("azimuth1", 0.0, 360.0, "degrees from north, 0 to 360");
    record.azimuth2 = number("azimuth2", 0.0, 360.0, "degrees from north, 0 to 360");
    record.event = value("event");
    record.scale = number("scale", 1e-6, 1e6, "a factor above 0").value_or(1.0);
    record.magnitude = number("magnitude", -2.0, 11.0, "a magnitude");
    record.distance = number("distance_km", 0.0, 2e4, "km");
    record.vs30 = number("vs30_m_s", 1.0, 1e4, "m/s");
    record.pulse_period = number("pulse_period_s", 0.0, 1e3, "s");
    check_azimuths(record);
    records_.push_back(std::move(record));
  }

  void check_azimuths(const SuiteRecord& record) const {
    constexpr double tolerance = 2.0;  // degrees
    if (record.azimuth1.has_value() != (record.azimuth2.has_value() && !record.h2.empty()) &&
        !record.h2.empty())
      fail(record.azimuth1 ? "azimuth2" : "azimuth1", "the directions of both components, or of none");
    if (!record.azimuth1 || !record.azimuth2) return;
    const double apart = std::abs(std::remainder(*record.azimuth2 - *record.azimuth1, 180.0));
    if (90.0 - apart > tolerance)
      fail("azimuth2", fmt::format("a direction normal to the {:.4g}° of azimuth1", *record.azimuth1));
  }

  /// Records of one earthquake are told from others only where all rows say which they are of.
  void check_events() {
    const auto has = [](const SuiteRecord& r) { return !r.event.empty(); };
    if (std::ranges::none_of(records_, has)) return;
    for (const SuiteRecord& record : records_) {
      if (has(record)) continue;
      line_ = record.line - 1;
      row_ = fields(line_);
      fail("event", "the earthquake of each record, or of none");
    }
  }

  fs::path file_;
  MotionText text_;
  bool is_of_peer_ = false;
  std::map<std::string, std::size_t, std::less<>> place_;
  std::size_t line_ = 0;
  std::vector<std::string> row_;
  std::set<std::string> names_;
  std::set<fs::path> files_;
  std::vector<SuiteRecord> records_;
};

}  // namespace

std::vector<SuiteRecord> read_suite_list(const fs::path& file) {
  return SuiteListReader(file).read();
}

}  // namespace keyblock::loading
