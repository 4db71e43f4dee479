#include <fmt/format.h>

#include <array>
#include <utility>

#include "verification/report.h"

namespace keyblock::verification {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 75rem; padding: 0 1rem; }
h2 { margin: 2.2rem 0 .3rem; font-size: 1.15rem; }
p.about { margin: .2rem 0 .6rem; max-width: 55rem; white-space: pre-line; }
div.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .7rem; text-align: right; border-bottom: 1px solid #8884; white-space: nowrap; }
th.left, td.left { text-align: left; }
td.ok { color: #1a7f37; } td.fail { color: #fff; background: #b42318; font-weight: bold; }
td.note { white-space: normal; color: #b42318; text-align: left; }
)";

constexpr std::array<std::pair<const char*, std::string RowText::*>, 9> columns{
    {{"run", &RowText::run},
     {"quantity", &RowText::quantity},
     {"order", &RowText::order},
     {"parameters", &RowText::parameters},
     {"computed", &RowText::computed},
     {"expected", &RowText::expected},
     {"error", &RowText::error},
     {"published DDA", &RowText::published},
     {"tolerance", &RowText::tolerance}}};
constexpr std::size_t parameter_column = 3;
bool is_left(std::size_t column) {
  return column <= 1 || column == parameter_column;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::array<bool, columns.size()> used_columns(const CaseResult& result) {
  std::array<bool, columns.size()> used{};
  for (const Row& row : result.rows) {
    const RowText text = row_text(row);
    for (std::size_t c = 0; c < columns.size(); ++c) used[c] = used[c] || !(text.*columns[c].second).empty();
  }
  used[0] = has_several_runs(result);
  return used;
}

std::string html_row(const Row& row, const std::array<bool, columns.size()>& used) {
  const RowText text = row_text(row);
  std::string html = "<tr>";
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (!used[c]) continue;
    const bool published = columns[c].second == &RowText::published && !row.source.empty() && row.published;
    html += fmt::format("<td{}{}>{}</td>", is_left(c) ? " class=\"left\"" : "",
                        published ? fmt::format(" title=\"{}\"", escaped(row.source)) : "",
                        escaped(text.*columns[c].second));
  }
  html += row.pass ? "<td class=\"ok\">holds</td></tr>\n" : "<td class=\"fail\">FAIL</td></tr>\n";
  if (!text.note.empty())
    html += fmt::format("<tr><td class=\"note\" colspan=\"10\">{}</td></tr>\n", escaped(text.note));
  return html;
}

std::string html_case(const CaseResult& result) {
  const CaseFile& file = *result.file;
  const auto used = used_columns(result);
  std::string html = fmt::format(
      "<h2 id=\"{0}\">{1}. {2}</h2>\n<p class=\"about\">{3}</p>\n<div class=\"wide\"><table>\n<tr>",
      escaped(file.name), file.number, escaped(file.title), escaped(file.about));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (used[c]) html += fmt::format("<th{}>{}</th>", is_left(c) ? " class=\"left\"" : "", columns[c].first);
  }
  html += "<th></th></tr>\n";
  for (const Row& row : result.rows) html += html_row(row, used);
  return html + "</table></div>\n";
}

// Text within a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '<' || c == '*' || c == '_' || c == '`') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string markdown_case(const CaseResult& result) {
  const CaseFile& file = *result.file;
  const auto used = used_columns(result);
  std::string text = fmt::format("\n## {}. {}\n\n`{}`\n\n", file.number, file.title, file.name), line = "|",
              rule = "|";
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (!used[c]) continue;
    line += fmt::format(" {} |", columns[c].first);
    rule += is_left(c) ? "---|" : "--:|";
  }
  text += line + "  |\n" + rule + "---|\n";
  for (const Row& row : result.rows) {
    const RowText cells = row_text(row);
    text += "|";
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (used[c]) text += fmt::format(" {} |", cell(cells.*columns[c].second));
    }
    text += row.pass ? " holds |\n" : fmt::format(" **FAIL** {} |\n", cell(cells.note));
  }
  return text;
}

}  // namespace

std::string table_html(const std::vector<CaseResult>& results, const std::string& version) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>keyblock: problems with known "
      "answers</title>\n<style>{}</style></head><body>\n<h1>Problems with known answers</h1>\n<p>keyblock "
      "{}: {}.</p>\n",
      style, escaped(version), verdict_text(results));
  for (const CaseResult& result : results) {
    if (!result.rows.empty()) html += html_case(result);
  }
  return html + "</body></html>\n";
}

std::string table_markdown(const std::vector<CaseResult>& results, const std::string& version) {
  std::string text = fmt::format(
      "# Problems with known answers: the table\n\nWritten by `keyblock verify --all --format markdown`, "
      "version {}: {}.\n"
      "[verification.md](verification.md) says how to read it.\n",
      version, verdict_text(results));
  for (const CaseResult& result : results) {
    if (!result.rows.empty()) text += markdown_case(result);
  }
  return text;
}

}  // namespace keyblock::verification
