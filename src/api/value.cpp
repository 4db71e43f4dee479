#include "keyblock/value.h"

#include <utility>

#include "api/scenario_source.h"

namespace keyblock::api {
namespace {

// Short enough that no text of its own is kept for each of a hundred thousand numbers.
constexpr const char* place_of_set_values = "a set value";

struct Converter {
  scenario::Value& to;

  void operator()(bool value) const {
    to.type = scenario::Value::Type::boolean;
    to.boolean = value;
  }
  void operator()(std::int64_t value) const {
    to.type = scenario::Value::Type::integer;
    to.integer = value;
    to.number = static_cast<double>(value);
  }
  void operator()(double value) const {
    to.type = scenario::Value::Type::number;
    to.number = value;
  }
  void operator()(const std::string& value) const {
    to.type = scenario::Value::Type::string;
    to.text = value;
  }
  void operator()(const Value::List& list) const {
    to.type = scenario::Value::Type::array;
    to.items.reserve(list.size());
    for (const Value& item : list) to.items.push_back(document_value(item));
  }
  void operator()(const Value::Table& table) const {
    to.type = scenario::Value::Type::table;
    to.items.reserve(table.size());
    for (const auto& [key, member] : table) {
      scenario::Value& item = to.items.emplace_back(document_value(member));
      item.key = key;
    }
  }
};

}  // namespace

scenario::Value document_value(const Value& value) {
  scenario::Value made;
  made.where.file = made.key_where.file = place_of_set_values;
  std::visit(Converter{made}, value.is);
  return made;
}

Value public_value(const scenario::Value& value) {
  using Type = scenario::Value::Type;
  switch (value.type) {
    case Type::string:
    case Type::date:
      return Value::text(value.text);
    case Type::integer:
      return value.integer;
    case Type::number:
      return value.number;
    case Type::boolean:
      return value.boolean;
    case Type::array: {
      Value::List list;
      list.reserve(value.items.size());
      for (const scenario::Value& item : value.items) list.push_back(public_value(item));
      return list;
    }
    case Type::table: {
      Value::Table table;
      table.reserve(value.items.size());
      for (const scenario::Value& item : value.items) table.emplace_back(item.key, public_value(item));
      return table;
    }
  }
  return {};
}

}  // namespace keyblock::api
