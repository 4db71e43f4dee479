#pragma once
#include <string>
#include <string_view>

namespace keyblock::report {

/// A template of viewer_template.h with its three places filled: the title (text, escaped here), the header (JSON as
/// script_json makes it) and the arrays (ArrayPack::encoded()).
std::string fill_page(std::string_view page_template, std::string_view title, std::string_view header,
                      std::string_view arrays);

/// JSON without the character '<', so that it can stand in a script element.
std::string script_json(std::string_view json);

}  // namespace keyblock::report
