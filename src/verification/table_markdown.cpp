#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "verification/table_columns.h"

namespace keyblock::verification {
namespace {

// Where a quantity has more rows than this, the page shows its worst one.
constexpr std::size_t most_rows = 12;
constexpr std::size_t parameter_column = 3;

// How much of what is allowed a row uses up; above 1 it fails.
double use(const Row& row) {
  if (!std::isfinite(row.computed)) return HUGE_VAL;
  const auto share = [](double part, double whole) { return part == 0.0 ? 0.0 : part / whole; };
  if (row.at_most) return share(row.computed, *row.at_most);
  if (row.at_least) return share(*row.at_least, row.computed);
  return share(std::abs(row.computed - *row.expected),
               row.absolute_tolerance.value_or(row.tolerance.value_or(0.0) * std::abs(*row.expected)));
}

// Text within a cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '<' || c == '*' || c == '_' || c == '`') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string row_line(const Row& row, const std::array<bool, table_columns.size()>& used,
                     const std::string& parameters) {
  RowText cells = row_text(row);
  cells.parameters = parameters.empty() ? cells.parameters : parameters;
  std::string text = "|";
  for (std::size_t c = 0; c < table_columns.size(); ++c) {
    if (used[c]) text += fmt::format(" {} |", cell(cells.*table_columns[c].cell));
  }
  // A message names a file by its whole path, which is that of one machine.
  return text + (row.pass ? " holds |\n" : " **FAIL** |\n");
}

/// The rows of one quantity of one run.
using Group = std::span<const Row>;

std::vector<Group> groups_of(const std::vector<Row>& rows) {
  std::vector<Group> groups;
  for (auto begin = rows.begin(); begin != rows.end();) {
    const auto end = std::find_if(begin, rows.end(), [&](const Row& row) {
      return row.quantity != begin->quantity || row.run != begin->run;
    });
    groups.emplace_back(begin, end);
    begin = end;
  }
  return groups;
}

std::string group_lines(Group group, const std::array<bool, table_columns.size()>& used) {
  if (group.size() > most_rows) {
    const auto more = [](const Row& a, const Row& b) { return use(a) < use(b); };
    const Row& worst = *std::max_element(group.begin(), group.end(), more);
    const std::string what = worst.label.empty() ? "" : ": " + worst.label;
    return row_line(worst, used, fmt::format("worst of {}{}", group.size(), what));
  }
  std::string text;
  for (const Row& row : group) text += row_line(row, used, "");
  return text;
}

std::string case_section(const CaseResult& result) {
  const CaseFile& file = *result.file;
  auto used = used_columns(result);
  const std::vector<Group> groups = groups_of(result.rows);
  used[parameter_column] =
      used[parameter_column] ||
      std::any_of(groups.begin(), groups.end(), [](Group group) { return group.size() > most_rows; });
  std::string body;
  for (const Group group : groups) body += group_lines(group, used);
  std::string line = "|", rule = "|";
  for (std::size_t c = 0; c < table_columns.size(); ++c) {
    if (!used[c]) continue;
    line += fmt::format(" {} |", table_columns[c].heading);
    rule += table_columns[c].left ? "---|" : "--:|";
  }
  return fmt::format("\n## {}. {}\n\n`keyblock verify {}`: {} rows, {} fail.\n\n{}  |\n{}---|\n{}",
                     file.number, file.title, file.name, result.rows.size(), result.failed(), line, rule,
                     body);
}

}  // namespace

std::string table_markdown(const std::vector<CaseResult>& results, const std::string& version) {
  std::string text = fmt::format(
      "# Problems with known answers: the table\n\nWritten by `keyblock verify --all --format markdown`, "
      "version {}: {}.\n[verification.md](verification.md) says how to read it. Of a quantity with more than "
      "{} rows the "
      "worst is shown.\n",
      version, verdict_text(results), most_rows);
  for (const CaseResult& result : results) {
    if (!result.rows.empty()) text += case_section(result);
  }
  return text;
}

}  // namespace keyblock::verification
