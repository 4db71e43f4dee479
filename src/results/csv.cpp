#include "results/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/atomic_file.h"

namespace keyblock::results {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::vector<std::string> history_columns(const std::vector<std::string>& names) {
  std::vector<std::string> columns{"time"};
  for (const std::string& name : names) {
    for (const char* quantity : {"ux", "uy", "vx", "vy", "sxx", "syy", "sxy"}) {
      columns.push_back(fmt::format("{}.{}", name, quantity));
    }
  }
  return columns;
}

std::string histories_csv(const std::vector<std::string>& names,
                          const std::vector<simulation::HistoryRow>& rows) {
  std::string text;
  for (const std::string& column : history_columns(names))
    text += (text.empty() ? "" : ",") + csv_field(column);
  text += "\n";
  for (const simulation::HistoryRow& row : rows) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{}", row.time);
    for (const auto& p : row.points) {
      if (std::isnan(p.ux)) {
        text += ",,,,,,,";
      } else {
        fmt::format_to(out, ",{},{},{},{},{},{},{}", p.ux, p.uy, p.vx, p.vy, p.sxx, p.syy, p.sxy);
      }
    }
    text += "\n";
  }
  return text;
}

void write_histories_csv(const std::filesystem::path& directory, const std::vector<std::string>& names,
                         const std::vector<simulation::HistoryRow>& rows) {
  write_file_atomically(directory / "histories.csv", histories_csv(names, rows));
}

}  // namespace keyblock::results
