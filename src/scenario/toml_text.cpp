#include "scenario/toml_text.h"

#include <algorithm>

#include "scenario/key_path.h"

namespace keyblock::scenario {
namespace {

bool is_list_of_tables(const Value& value) {
  return value.is(Value::Type::array) && !value.items.empty() &&
         std::all_of(value.items.begin(), value.items.end(),
                     [](const Value& item) { return item.is(Value::Type::table); });
}

bool has_header(const Value& value) {
  return value.is(Value::Type::table) || is_list_of_tables(value);
}

void append_lines(const Value& table, std::string& text) {
  for (const Value& member : table.items) text += path_segment(member.key) + " = " + to_toml(member) + "\n";
}

}  // namespace

std::string toml_text(const Value& document) {
  std::string text;
  for (const Value& member : document.items) {
    if (!has_header(member)) text += path_segment(member.key) + " = " + to_toml(member) + "\n";
  }
  for (const Value& member : document.items) {
    const std::string key = path_segment(member.key);
    if (member.is(Value::Type::table)) {
      text += "\n[" + key + "]\n";
      append_lines(member, text);
    } else if (is_list_of_tables(member)) {
      for (const Value& item : member.items) {
        text += "\n[[" + key + "]]\n";
        append_lines(item, text);
      }
    }
  }
  return text;
}

}  // namespace keyblock::scenario
