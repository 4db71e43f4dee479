#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::app {

/// What `keyblock new` makes scenarios of: the files of templates/, by name.
std::vector<std::string> template_kinds();
std::string_view template_text(const std::string& kind);

}  // namespace keyblock::app
