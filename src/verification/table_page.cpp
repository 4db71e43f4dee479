#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/xml_text.h"
#include "verification/table_columns.h"

namespace keyblock::verification {
namespace {

// Longer tables are folded unless something in them fails.
constexpr std::size_t most_open_rows = 60;

constexpr const char* style_sheet = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 90rem; padding: 0 1rem; }
h2 { margin: 2.2rem 0 .3rem; font-size: 1.15rem; }
p.about { margin: .2rem 0 .6rem; max-width: 55rem; }
div.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .55rem; text-align: right; border-bottom: 1px solid #8884; white-space: nowrap; vertical-align: top; }
th.left, td.left { text-align: left; white-space: normal; min-width: 7rem; }
summary { cursor: pointer; }
ul.contents { columns: 24rem; padding-left: 1.2rem; }
li.fail { font-weight: bold; color: #b42318; }
td.ok { color: #1a7f37; } td.fail { color: #fff; background: #b42318; font-weight: bold; }
td.note { white-space: normal; color: #b42318; text-align: left; }
)";

std::string html_row(const Row& row, const std::array<bool, table_columns.size()>& used) {
  const RowText text = row_text(row);
  std::string html = "<tr>";
  for (std::size_t c = 0; c < table_columns.size(); ++c) {
    if (!used[c]) continue;
    const bool published =
        table_columns[c].cell == &RowText::published && !row.source.empty() && row.published;
    html += fmt::format("<td{}{}>{}</td>", table_columns[c].left ? " class=\"left\"" : "",
                        published ? fmt::format(" title=\"{}\"", xml_text(row.source)) : "",
                        xml_text(text.*table_columns[c].cell));
  }
  html += row.pass ? "<td class=\"ok\">holds</td></tr>\n" : "<td class=\"fail\">FAIL</td></tr>\n";
  if (!text.note.empty())
    html += fmt::format("<tr><td class=\"note\" colspan=\"10\">{}</td></tr>\n", xml_text(text.note));
  return html;
}

std::string verdict_of_case(const CaseResult& result) {
  return result.failed() == 0 ? fmt::format("{} rows, all hold", result.rows.size())
                              : fmt::format("{} of {} rows do not hold", result.failed(), result.rows.size());
}

std::string contents(const std::vector<CaseResult>& results) {
  std::string html = "<ul class=\"contents\">\n";
  for (const CaseResult& result : results) {
    if (result.rows.empty()) continue;
    html += fmt::format("<li{}><a href=\"#{}\">{}. {}</a>: {}</li>\n",
                        result.failed() > 0 ? " class=\"fail\"" : "", xml_text(result.file->name),
                        result.file->number, xml_text(result.file->title), verdict_of_case(result));
  }
  return html + "</ul>\n";
}

/// Text with empty lines between its paragraphs.
std::string paragraphs(const std::string& text) {
  std::string html;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find("\n\n", begin), text.size());
    html += fmt::format("<p class=\"about\">{}</p>\n", xml_text(text.substr(begin, end - begin)));
    begin = end + 2;
  }
  return html;
}

std::string html_case(const CaseResult& result) {
  const CaseFile& file = *result.file;
  const auto used = used_columns(result);
  const bool open = result.rows.size() <= most_open_rows || result.failed() > 0;
  std::string html = fmt::format(
      "<h2 id=\"{0}\">{1}. {2}</h2>\n{3}<details{4}><summary>{5}</summary><div "
      "class=\"wide\"><table>\n<tr>",
      xml_text(file.name), file.number, xml_text(file.title), paragraphs(file.about), open ? " open" : "",
      verdict_of_case(result));
  for (std::size_t c = 0; c < table_columns.size(); ++c) {
    if (used[c])
      html += fmt::format("<th{}>{}</th>", table_columns[c].left ? " class=\"left\"" : "",
                          table_columns[c].heading);
  }
  html += "<th></th></tr>\n";
  for (const Row& row : result.rows) html += html_row(row, used);
  return html + "</table></div></details>\n";
}

}  // namespace

std::string table_html(const std::vector<CaseResult>& results, const std::string& version) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>keyblock: problems with known "
      "answers</title>\n<style>{}</style></head><body>\n<h1>Problems with known answers</h1>\n<p>keyblock "
      "{}: {}.</p>\n",
      style_sheet, xml_text(version), verdict_text(results));
  html += contents(results);
  for (const CaseResult& result : results) {
    if (!result.rows.empty()) html += html_case(result);
  }
  return html + "</body></html>\n";
}

}  // namespace keyblock::verification
