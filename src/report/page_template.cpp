#include "report/page_template.h"

#include <stdexcept>

#include "core/xml_text.h"

namespace keyblock::report {

namespace {

/// Appends the template up to `mark` and then `content`; leaves in `rest` what follows the mark.
void fill(std::string& page, std::string_view& rest, std::string_view mark, std::string_view content) {
  const std::size_t at = rest.find(mark);
  if (at == std::string_view::npos) throw std::logic_error("report: a mark is missing in the page template");
  page.append(rest.substr(0, at)).append(content);
  rest.remove_prefix(at + mark.size());
}

}  // namespace

std::string fill_page(std::string_view page_template, std::string_view title, std::string_view header,
                      std::string_view arrays) {
  std::string page;
  std::string_view rest = page_template;
  page.reserve(rest.size() + header.size() + arrays.size());
  fill(page, rest, "@@title@@", xml_text(title));
  fill(page, rest, "@@header@@", header);
  fill(page, rest, "@@arrays@@", arrays);
  page.append(rest);
  return page;
}

std::string script_json(std::string_view json) {
  std::string safe;
  for (const char c : json) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

}  // namespace keyblock::report
