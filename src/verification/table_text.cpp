#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "verification/table_columns.h"

namespace keyblock::verification {
namespace {

constexpr std::size_t columns = table_columns.size() + 1;  // the last: whether the row holds
using Line = std::array<std::string, columns>;

Line heading() {
  Line line;
  for (std::size_t c = 0; c < table_columns.size(); ++c) line[c] = table_columns[c].heading;
  return line;
}

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

Line line_of(const Row& row) {
  const RowText text = row_text(row);
  Line line;
  for (std::size_t c = 0; c < table_columns.size(); ++c) line[c] = text.*table_columns[c].cell;
  line.back() = row.pass ? "ok" : "FAIL";
  return line;
}

std::string paint(const std::string& text, const char* code, const TextStyle& style) {
  return style.color ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

// Signs that only Unicode has, for terminals that have none.
std::string spelled(std::string text, const TextStyle& style) {
  if (style.unicode) return text;
  for (const auto& [sign, word] : {std::pair{"≤", "<="}, {"≥", ">="}, {"±", "+-"}}) {
    for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign)) {
      text.replace(at, std::string_view(sign).size(), word);
    }
  }
  std::string ascii;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) ascii += c;
    if (byte >= 0xC0) ascii += '?';
  }
  return ascii;
}

/// One line of a table; row: null for its heading.
std::string line_text(const Line& cells, const Row* row, const std::array<std::size_t, columns>& width,
                      const std::array<bool, table_columns.size()>& used, const TextStyle& style) {
  std::string line = " ";
  for (std::size_t c = 0; c < columns; ++c) {
    const bool verdict = c + 1 == columns;
    if (!verdict && !used[c]) continue;
    const std::string padding(width[c] - width_of(cells[c]), ' ');
    std::string cell = verdict || table_columns[c].left ? cells[c] + padding : padding + cells[c];
    if (verdict && row != nullptr) cell = paint(cell, row->pass ? "32" : "1;31", style);
    line += " " + cell + (verdict ? "" : " ");
  }
  while (line.ends_with(' ')) line.pop_back();
  return line + "\n";
}

std::string case_text(const CaseResult& result, const TextStyle& style) {
  std::vector<Line> lines{heading()};
  for (const Row& row : result.rows) lines.push_back(line_of(row));
  std::array<std::size_t, columns> width{};
  for (Line& line : lines) {
    for (std::size_t c = 0; c < columns; ++c) {
      line[c] = spelled(line[c], style);
      width[c] = std::max(width[c], width_of(line[c]));
    }
  }
  const auto used = used_columns(result);
  std::string text = paint(
      spelled(fmt::format("{} {}: {}", result.file->number, result.file->name, result.file->title), style),
      "1", style);
  text += fmt::format("  ({:.1f} s)\n", result.wall_time);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Row* row = k > 0 ? &result.rows[k - 1] : nullptr;
    text += line_text(lines[k], row, width, used, style);
    if (row != nullptr && !row->failure.empty()) text += "      " + spelled(row->failure, style) + "\n";
  }
  return text + "\n";
}

}  // namespace

std::string table_text(const std::vector<CaseResult>& results, const TextStyle& style) {
  std::string text;
  for (const CaseResult& result : results) {
    if (!result.rows.empty()) text += case_text(result, style);
  }
  return text + verdict_text(results) + "\n";
}

}  // namespace keyblock::verification
