#include "api/unknown_keys.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "api/known_keys.h"
#include "scenario/key_hints.h"
#include "scenario/override.h"

namespace keyblock::api {
namespace {

using scenario::KeyKind;
using scenario::KeyReference;
using scenario::PathSegment;
using scenario::SectionReference;

/// Tables of one kind: keys of a section that begin with `prefix`, `components.` for one. No section: whatever keys there are.
struct Place {
  const SectionReference* section = nullptr;
  std::string prefix;
  bool is_top = false;   ///< the tables of the file are keys, too
  bool is_list = false;  ///< of such tables

  [[nodiscard]] std::vector<std::string> keys() const;
  /// What the tables under a key are; nothing where the key is unknown.
  [[nodiscard]] std::optional<Place> under(const std::string& key) const;
};

std::vector<std::string> Place::keys() const {
  std::vector<std::string> keys;
  const auto add = [&](std::string_view key) {
    const std::string first(key.substr(0, key.find('.')));
    if (std::find(keys.begin(), keys.end(), first) == keys.end()) keys.push_back(first);
  };
  for (const KeyReference& known : section->keys) {
    if (known.key.starts_with(prefix)) add(std::string_view(known.key).substr(prefix.size()));
  }
  if (is_top) {
    for (const std::string& table : table_names()) add(table);
  }
  return keys;
}

std::optional<Place> Place::under(const std::string& key) const {
  const std::string path = prefix + key, deeper = path + ".";
  bool is_known = false;
  Place place;
  for (const KeyReference& known : section->keys) {
    if (known.key == path) {
      is_known = true;
      place.is_list = place.is_list || known.value_type.kind == KeyKind::tables;
      if (!known.value_type.group.empty()) place.section = section_of(known.value_type.group);
    } else if (known.key.starts_with(deeper)) {
      is_known = true;
      place.section = section;
      place.prefix = deeper;
    }
  }
  if (is_top && !is_known) {
    place.is_list = is_list_section(key);
    place.section = section_of(place.is_list ? "[[" + key + "]]" : "[" + key + "]");
    is_known = place.section != nullptr;
  }
  return is_known ? std::optional(place) : std::nullopt;
}

class Check {
 public:
  void path(const Place& place, std::span<const PathSegment> rest, const std::string& path,
            const Value& value) {
    if (rest.empty()) return tables(place, path, value);
    if (place.is_list) {
      Place element = place;
      element.is_list = false;
      return this->path(element, rest.subspan(1), path + "[" + rest.front().key + "]", value);
    }
    const std::string& key = rest.front().key;
    if (const auto next = known(place, key, path); next && next->section != nullptr)
      this->path(*next, rest.subspan(1), scenario::join_path(path, key), value);
  }

  void finish() {
    if (!unknown_.empty()) throw InputError(std::move(unknown_));
  }

 private:
  std::optional<Place> known(const Place& place, const std::string& key, const std::string& path) {
    std::optional<Place> next = place.under(key);
    if (next) return next;
    const std::vector<std::string> keys = place.keys();
    std::string all;
    for (const std::string& name : keys) all += (all.empty() ? "" : ", ") + name;
    Diagnostic diagnostic;
    diagnostic.key = scenario::join_path(path, key);
    diagnostic.found = "an unknown key";
    diagnostic.hint = scenario::key_hint(key, keys);
    diagnostic.expected =
        diagnostic.hint.empty() ? "one of " + all : "a key of " + (path.empty() ? "the scenario" : path);
    unknown_.push_back(std::move(diagnostic));
    return next;
  }

  void tables(const Place& place, const std::string& path, const Value& value) {
    if (const auto* list = std::get_if<Value::List>(&value.is)) {
      for (std::size_t k = 0; k < list->size(); ++k) {
        if (std::holds_alternative<Value::Table>((*list)[k].is))
          tables(place, scenario::join_index(path, k), (*list)[k]);
      }
    }
    const auto* table = std::get_if<Value::Table>(&value.is);
    if (table == nullptr) return;
    for (const auto& [key, item] : *table) {
      if (const auto next = known(place, key, path); next && next->section != nullptr)
        tables(*next, scenario::join_path(path, key), item);
    }
  }

  std::vector<Diagnostic> unknown_;
};

}  // namespace

void check_keys(const std::string& key, const Value& value) {
  Place file;
  file.section = section_of("");
  file.is_top = true;
  Check check;
  check.path(file, scenario::make_override(key, {}).path, "", value);
  check.finish();
}

}  // namespace keyblock::api
