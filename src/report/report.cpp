#include "report/report.h"

#include <stdexcept>
#include <string_view>

#include "core/atomic_file.h"
#include "report/page_data.h"
#include "report/viewer_template.h"

namespace keyblock::report {

namespace {

std::string html_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

/// Appends the template up to `mark` and then `content`; leaves in `rest` what follows the mark.
void fill(std::string& page, std::string_view& rest, std::string_view mark, std::string_view content) {
  const std::size_t at = rest.find(mark);
  if (at == std::string_view::npos) throw std::logic_error("report: a mark is missing in the page template");
  page.append(rest.substr(0, at)).append(content);
  rest.remove_prefix(at + mark.size());
}

}  // namespace

std::string render_report(const results::RunData& run) {
  const PageData data = make_page_data(run);
  std::string page;
  std::string_view rest = viewer_template();
  page.reserve(rest.size() + data.header.size() + data.arrays.size());
  fill(page, rest, "@@title@@", html_text(run.model.title));
  fill(page, rest, "@@header@@", data.header);
  fill(page, rest, "@@arrays@@", data.arrays);
  page.append(rest);
  return page;
}

void write_report(const results::RunData& run, const std::filesystem::path& directory) {
  write_file_atomically(directory / "report.html", render_report(run));
}

}  // namespace keyblock::report
