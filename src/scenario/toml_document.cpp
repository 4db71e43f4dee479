#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "scenario/value.h"

namespace keyblock::scenario {
namespace {

SourcePosition position(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node& node, const std::string& file) {
  Value value;
  value.where = position(node.source(), file);
  if (const auto* table = node.as_table()) {
    for (const auto& [key, member] : *table) {
      Value& item = value.items.emplace_back(convert(member, file));
      item.key = std::string(key.str());
      item.key_where = position(key.source(), file);
    }
    std::stable_sort(value.items.begin(), value.items.end(), [](const Value& a, const Value& b) {
      return std::tie(a.key_where.line, a.key_where.column) < std::tie(b.key_where.line, b.key_where.column);
    });
  } else if (const auto* array = node.as_array()) {
    value.type = Value::Type::array;
    for (const toml::node& element : *array) value.items.push_back(convert(element, file));
  } else if (const auto* text = node.as_string()) {
    value.type = Value::Type::string;
    value.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.type = Value::Type::integer;
    value.integer = integer->get();
    value.number = static_cast<double>(value.integer);
  } else if (const auto* number = node.as_floating_point()) {
    value.type = Value::Type::number;
    value.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    value.type = Value::Type::boolean;
    value.boolean = boolean->get();
  } else {
    std::ostringstream date;
    node.visit([&](const auto& n) {
      if constexpr (toml::is_chronological<decltype(n)>) date << n;
    });
    value.type = Value::Type::date;
    value.text = date.str();
  }
  return value;
}

}  // namespace

Value parse_toml(std::string_view text, const std::string& file) {
  try {
    return convert(toml::parse(text, file), file);
  } catch (const toml::parse_error& error) {
    Diagnostic diagnostic;
    diagnostic.where = position(error.source(), file);
    diagnostic.found = "text that is not TOML (" + std::string(error.description()) + ")";
    diagnostic.expected = "key = value, [table] or [[list]]";
    throw InputError(std::move(diagnostic));
  }
}

}  // namespace keyblock::scenario
