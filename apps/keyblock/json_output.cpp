#include "json_output.h"

#include <iostream>

#include "core/text.h"

namespace keyblock::app {

using nlohmann::ordered_json;

ordered_json mistakes_json(const std::vector<Diagnostic>& mistakes) {
  ordered_json list = ordered_json::array();
  for (const Diagnostic& mistake : mistakes) {
    list.push_back({{"file", mistake.where.file},
                    {"line", mistake.where.line},
                    {"column", mistake.where.column},
                    {"key", mistake.key},
                    {"found", mistake.found},
                    {"expected", mistake.expected},
                    {"hint", mistake.hint}});
  }
  return list;
}

void print_json_text(std::string_view text) {
  std::cout << harmless_json(text);
}

void print_json(const ordered_json& json) {
  print_json_text(json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace keyblock::app
