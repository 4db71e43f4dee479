#include "scenario/value.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/key_path.h"

namespace keyblock::scenario {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || code == 0x7f) {
      result += fmt::format("\\u{:04X}", code);
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string number_text(double number) {
  std::string text = fmt::format("{}", number);
  if (text.find_first_of(".einf") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

const Value* Value::find(std::string_view member) const {
  if (type != Type::table) return nullptr;
  for (const Value& item : items) {
    if (item.key == member) return &item;
  }
  return nullptr;
}

Value* Value::find(std::string_view member) {
  return const_cast<Value*>(static_cast<const Value*>(this)->find(member));
}

const std::string* Value::name() const {
  const Value* member = find("name");
  return member != nullptr && member->is(Type::string) ? &member->text : nullptr;
}

std::string describe(const Value& value) {
  switch (value.type) {
    case Value::Type::string:
      return "the string " + in_quotes(value.text);
    case Value::Type::integer:
      return fmt::format("the integer {}", value.integer);
    case Value::Type::number:
      return "the number " + number_text(value.number);
    case Value::Type::boolean:
      return fmt::format("the boolean {}", value.boolean);
    case Value::Type::date:
      return "the date or time " + value.text;
    case Value::Type::array:
      return value.items.empty() ? "an empty array" : fmt::format("an array of {}", value.items.size());
    case Value::Type::table:
      return "a table";
  }
  return {};
}

std::string to_toml(const Value& value) {
  std::string text;
  switch (value.type) {
    case Value::Type::string:
      return in_quotes(value.text);
    case Value::Type::integer:
      return fmt::format("{}", value.integer);
    case Value::Type::number:
      return number_text(value.number);
    case Value::Type::boolean:
      return value.boolean ? "true" : "false";
    case Value::Type::date:
      return value.text;
    case Value::Type::array:
      for (const Value& item : value.items) text += (text.empty() ? "" : ", ") + to_toml(item);
      return "[" + text + "]";
    case Value::Type::table:
      for (const Value& item : value.items) {
        text += (text.empty() ? " " : ", ") + path_segment(item.key) + " = " + to_toml(item);
      }
      return "{" + text + " }";
  }
  return {};
}

bool same_value(const Value& a, const Value& b) {
  if (a.is_number() && b.is_number())
    return a.type == b.type && a.is(Value::Type::integer) ? a.integer == b.integer : a.number == b.number;
  if (a.type != b.type || a.items.size() != b.items.size()) return false;
  if (a.is(Value::Type::array))
    return std::equal(a.items.begin(), a.items.end(), b.items.begin(), same_value);
  if (!a.is(Value::Type::table)) return to_toml(a) == to_toml(b);
  return std::all_of(a.items.begin(), a.items.end(), [&](const Value& item) {
    const Value* other = b.find(item.key);
    return other != nullptr && same_value(item, *other);
  });
}

namespace {

// Doubles of this size and more need not have all integers.
constexpr std::int64_t inexact_integer = std::int64_t{1} << 53;

void make_canonical(Value& value) {
  if (value.is(Value::Type::integer) && value.integer > -inexact_integer && value.integer < inexact_integer) {
    value.type = Value::Type::number;
    value.number = static_cast<double>(value.integer);
  }
  if (value.is(Value::Type::number)) value.number += 0.0;  // -0 is 0
  if (value.is(Value::Type::table))
    std::sort(value.items.begin(), value.items.end(),
              [](const Value& a, const Value& b) { return a.key < b.key; });
  for (Value& item : value.items) make_canonical(item);
}

}  // namespace

std::string canonical_toml(Value value) {
  make_canonical(value);
  return to_toml(value);
}

namespace {

void add_differences(const Value* there, const Value* here, const std::string& path,
                     std::vector<std::string>& found) {
  const auto text = [](const Value* value) { return value == nullptr ? "nothing" : to_toml(*value); };
  if (text(there) == text(here)) return;
  const bool both = there != nullptr && here != nullptr && there->type == here->type;
  if (both && there->is(Value::Type::table)) {
    for (const Value& member : there->items)
      add_differences(&member, here->find(member.key), join_path(path, member.key), found);
    for (const Value& member : here->items) {
      if (there->find(member.key) == nullptr)
        add_differences(nullptr, &member, join_path(path, member.key), found);
    }
  } else if (both && there->is(Value::Type::array) && there->items.size() == here->items.size()) {
    for (std::size_t k = 0; k < there->items.size(); ++k)
      add_differences(&there->items[k], &here->items[k], join_index(path, k), found);
  } else {
    found.push_back(fmt::format("{}: {} there, {} here", path, text(there), text(here)));
  }
}

}  // namespace

std::vector<std::string> differences(const Value& there, const Value& here) {
  std::vector<std::string> found;
  add_differences(&there, &here, "", found);
  return found;
}

}  // namespace keyblock::scenario
