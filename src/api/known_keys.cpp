#include "api/known_keys.h"

#include <algorithm>
#include <string_view>

#include "api/scenario_source.h"
#include "core/error.h"
#include "scenario/key_reference.h"

namespace keyblock::api {
namespace {

using scenario::KeyReference;
using scenario::SectionReference;

const std::vector<SectionReference>& reference() {
  static const std::vector<SectionReference> sections = scenario::key_reference();
  return sections;
}

std::size_t brackets_of(const SectionReference& section) {
  return section.title.starts_with("[[") ? 2 : section.title.starts_with('[') ? 1 : 0;
}

std::string name_of(const SectionReference& section, std::size_t brackets) {
  return section.title.substr(brackets, section.title.size() - 2 * brackets);
}

std::string list_title(const std::string& key) {
  return "[[" + key + "]]";
}

/// Defaults that are said in words, and required keys, are none.
std::optional<Value> standard_value(const KeyReference& key) {
  if (key.fallback == "none" || key.fallback == "required") return std::nullopt;
  try {
    const scenario::Value read = scenario::parse_toml("value = " + key.fallback, "");
    return public_value(read.items.at(0));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

KeyMeaning meaning_of(const KeyReference& key, std::size_t prefix) {
  std::string meaning = key.meaning;
  if (!key.unit.empty()) meaning += " Unit: " + key.unit + ".";
  return {key.key.substr(prefix), std::move(meaning), key.type, standard_value(key), key.fallback};
}

/// The tables of a scenario, as keys of it.
void add_tables(std::vector<KeyMeaning>& keys) {
  for (const SectionReference& s : reference()) {
    const std::size_t brackets = brackets_of(s);
    if (brackets == 0) continue;
    keys.push_back(
        {name_of(s, brackets), s.meaning, brackets == 2 ? "list of tables" : "table", std::nullopt, "none"});
  }
}

/// A key whose table has a section of its own, by the path of it with a point behind.
const KeyReference* group_key(const SectionReference& of, const std::string& within) {
  const auto found = std::find_if(of.keys.begin(), of.keys.end(), [&](const KeyReference& key) {
    return key.key + "." == within && !key.value_type.group.empty();
  });
  return found == of.keys.end() ? nullptr : &*found;
}

}  // namespace

const SectionReference* section_of(std::string_view title) {
  const auto found = std::find_if(reference().begin(), reference().end(),
                                  [&](const SectionReference& s) { return s.title == title; });
  return found == reference().end() ? nullptr : &*found;
}

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const SectionReference& s : reference()) {
    if (const std::size_t brackets = brackets_of(s); brackets > 0) names.push_back(name_of(s, brackets));
  }
  return names;
}

std::vector<KeyMeaning> known_keys(const std::string& table) {
  const std::size_t dot = std::min(table.find('.'), table.size());
  const std::string first = table.substr(0, dot);
  std::string within = dot < table.size() ? table.substr(dot + 1) + "." : "";
  const SectionReference* of = section_of(first.empty() ? "" : "[" + first + "]");
  if (of == nullptr) of = section_of(list_title(first));
  const KeyReference* group = of == nullptr ? nullptr : group_key(*of, within);
  if (group != nullptr) {
    of = section_of(group->value_type.group);
    within.clear();
  }
  std::vector<KeyMeaning> keys;
  if (of == nullptr) return keys;
  for (const KeyReference& key : of->keys) {
    if (key.key.starts_with(within)) keys.push_back(meaning_of(key, within.size()));
  }
  if (first.empty()) add_tables(keys);
  return keys;
}

bool is_list_section(const std::string& key) {
  return section_of(list_title(key)) != nullptr;
}

}  // namespace keyblock::api
