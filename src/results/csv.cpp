#include "results/csv.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <system_error>

#include "core/atomic_file.h"
#include "record/record_fields.h"

namespace keyblock::results {

namespace {

bool is_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error != std::errc::invalid_argument && end == text.data() + text.size();
}

// One, or several as values that vary together: "-0.5, 1".
bool are_numbers(std::string_view text) {
  for (std::size_t comma = text.find(", "); comma != std::string_view::npos; comma = text.find(", ")) {
    if (!is_number(text.substr(0, comma))) return false;
    text.remove_prefix(comma + 2);
  }
  return is_number(text);
}

// Spreadsheets look past spaces.
bool is_formula(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \n\v\f");
  if (first == std::string_view::npos) return false;
  constexpr std::string_view starts = "=+-@\t\r";
  return starts.find(text[first]) != std::string_view::npos && !are_numbers(text.substr(first));
}

}  // namespace

std::string csv_field(std::string_view text) {
  const std::string inert = is_formula(text) ? "'" + std::string(text) : std::string(text);
  if (inert.find_first_of(",;\"\n\r\t") == std::string::npos) return inert;
  std::string out = "\"";
  for (const char c : inert) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

bool has_histories(const record::ModelRecord& model) {
  return !model.history_names.empty() || !model.element_histories.empty();
}

std::vector<std::string> history_columns(const record::ModelRecord& model) {
  std::vector<std::string> columns{"time"};
  for (const std::string& name : model.history_names) {
    for (const record::HistoryField& field : record::history_fields)
      columns.push_back(fmt::format("{}.{}", name, field.name));
  }
  for (const record::ElementHistory& history : model.element_histories) {
    for (const auto& field : record::element_history_fields)
      columns.push_back(fmt::format("{}.{}", history.name, field.name));
  }
  return columns;
}

std::vector<double> history_numbers(const record::HistoryRow& row) {
  std::vector<double> numbers{row.time};
  for (const auto& p : row.points) {
    for (const record::HistoryField& field : record::history_fields) numbers.push_back(p.*field.member);
  }
  for (const record::ElementState& element : row.elements) {
    for (const auto& field : record::element_history_fields) numbers.push_back(element.*field.number);
  }
  return numbers;
}

namespace {

void add_cell(double number, bool is_there, std::string& text) {
  text += ',';
  if (is_there) fmt::format_to(std::back_inserter(text), "{}", number);
}

}  // namespace

std::string histories_csv(const record::ModelRecord& model, const std::vector<record::HistoryRow>& rows) {
  std::string text;
  for (const std::string& column : history_columns(model))
    text += (text.empty() ? "" : ",") + csv_field(column);
  text += "\n";
  for (const record::HistoryRow& row : rows) {
    fmt::format_to(std::back_inserter(text), "{}", row.time);
    for (const auto& p : row.points) {
      const bool is_there = !std::isnan(p.ux);
      for (const record::HistoryField& field : record::history_fields)
        add_cell(p.*field.member, is_there, text);
    }
    for (const record::ElementState& element : row.elements) {
      for (const auto& field : record::element_history_fields)
        add_cell(element.*field.number, !std::isnan(element.*field.number), text);
    }
    text += "\n";
  }
  return text;
}

void write_histories_csv(const std::filesystem::path& directory, const record::ModelRecord& model,
                         const std::vector<record::HistoryRow>& rows) {
  write_file_atomically(directory / "histories.csv", histories_csv(model, rows));
}

}  // namespace keyblock::results
