#include "scenario/schema.h"

#include <string_view>

#include "core/checked_json.h"
#include "scenario/key_reference.h"

namespace keyblock::scenario {
namespace {

using nlohmann::ordered_json;

constexpr const char* number_type = "number";

ordered_json list_of(ordered_json items, int least = 0, int most = 0) {
  ordered_json list{{"type", "array"}, {"items", std::move(items)}};
  if (least > 0) list["minItems"] = least;
  if (most > 0) list["maxItems"] = most;
  return list;
}

ordered_json two_numbers() {
  return list_of({{"type", number_type}}, 2, 2);
}

void add_range(const KeyType& type, ordered_json& json) {
  if (type.above) json["exclusiveMinimum"] = *type.above;
  if (type.at_least) json["minimum"] = *type.at_least;
  if (type.at_most) json["maximum"] = *type.at_most;
  if (type.below) json["exclusiveMaximum"] = *type.below;
}

ordered_json new_table() {
  return {{"type", "object"}, {"properties", ordered_json::object()}, {"additionalProperties", false}};
}

ordered_json one_of(const KeyType& type);

ordered_json of_type(const KeyType& type) {
  switch (type.kind) {
    case KeyKind::number:
    case KeyKind::integer: {
      ordered_json json{{"type", type.kind == KeyKind::integer ? "integer" : number_type}};
      add_range(type, json);
      return json;
    }
    case KeyKind::boolean:
      return {{"type", "boolean"}};
    case KeyKind::string:
      return {{"type", "string"}};
    case KeyKind::word:
      return {{"enum", type.words}};
    case KeyKind::point:
    case KeyKind::interval:
      return two_numbers();
    case KeyKind::points:
    case KeyKind::rows:
      return list_of(two_numbers(), 1);
    case KeyKind::rings:
      return list_of(list_of(two_numbers(), 3));
    case KeyKind::lines:
      return list_of(list_of(two_numbers(), 2), 1);
    case KeyKind::references:
      return list_of({{"type", "string"}});
    case KeyKind::table:
      return new_table();
    case KeyKind::tables:
      return list_of(new_table());
    case KeyKind::list:
      return list_of(ordered_json::object());
    case KeyKind::numbers:
      return {{"type", "object"}, {"additionalProperties", {{"type", number_type}}}};
    case KeyKind::group:
    case KeyKind::any:
      return one_of(type);
  }
  return ordered_json::object();
}

/// A value of any of several kinds, one of which may be a table with a section of its own.
ordered_json one_of(const KeyType& type) {
  ordered_json all = ordered_json::array();
  for (const KeyKind kind : type.kinds) {
    KeyType single = type;
    single.kind = kind;
    all.push_back(of_type(single));
  }
  if (type.kind == KeyKind::group) all.push_back({{"$ref", "#/definitions/" + type.group}});
  if (all.empty()) return ordered_json::object();
  return all.size() == 1 ? all.front() : ordered_json{{"anyOf", std::move(all)}};
}

std::string description(const KeyReference& key) {
  std::string text = key.meaning;
  if (!key.unit.empty()) text += " Unit: " + key.unit + ".";
  if (key.fallback != "required" && key.fallback != "none") text += " Default: " + key.fallback + ".";
  return text;
}

/// The table that holds the key, and its name there: `components.file` lies in the elements of `components`.
ordered_json& table_of(std::string_view& key, ordered_json& section) {
  ordered_json* table = &section;
  for (std::size_t dot = key.find('.'); dot != std::string_view::npos; dot = key.find('.')) {
    ordered_json& member = (*table)["properties"][std::string(key.substr(0, dot))];
    table = member.contains("items") ? &member["items"] : &member;
    key.remove_prefix(dot + 1);
  }
  return *table;
}

void add_key(const KeyReference& key, ordered_json& section) {
  std::string_view name = key.key;
  ordered_json& table = table_of(name, section);
  ordered_json& property = table["properties"][std::string(name)];
  // Several kinds of values are described one after the other.
  const bool again = !property.is_null();
  ordered_json json = again ? ordered_json::object() : of_type(key.value_type);
  json["description"] = description(key);
  property = std::move(json);
  if (key.value_type.required && !again) table["required"].push_back(std::string(name));
}

ordered_json section_schema(const SectionReference& section) {
  ordered_json table = new_table();
  if (!section.meaning.empty()) table["description"] = section.meaning;
  for (const KeyReference& key : section.keys) add_key(key, table);
  return table;
}

}  // namespace

std::string schema() {
  ordered_json root{{"$schema", "http://json-schema.org/draft-07/schema#"},
                    {"title", "keyblock scenario"},
                    {"type", "object"},
                    {"properties", ordered_json::object()},
                    {"additionalProperties", false},
                    {"definitions", ordered_json::object()}};
  for (const SectionReference& section : key_reference()) {
    ordered_json table = section_schema(section);
    std::string_view title = section.title;
    if (title.empty()) {
      root["properties"] = std::move(table["properties"]);
    } else if (title.starts_with("[[")) {
      ordered_json list = list_of(table);
      if (section.may_be_alone) list = {{"anyOf", {std::move(table), std::move(list)}}};
      root["properties"][std::string(title.substr(2, title.size() - 4))] = std::move(list);
    } else if (title.starts_with('[')) {
      root["properties"][std::string(title.substr(1, title.size() - 2))] = std::move(table);
    } else {
      root["definitions"][section.title] = std::move(table);
    }
  }
  return root.dump(1) + "\n";
}

}  // namespace keyblock::scenario
