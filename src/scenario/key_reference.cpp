#include "scenario/key_reference.h"

#include <algorithm>

#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

// A bar would end the cell of a table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string row(const KeyReference& key) {
  return "| `" + key.key + "` | " + cell(key.type) + " | " + cell(key.fallback) + " | " + key.unit + " | " +
         cell(key.meaning) + " |\n";
}

/// The unit of a key of a section, or null where it has none of that name.
const std::string* unit_in(const SectionReference& section, const std::string& key) {
  const auto found = std::ranges::find(section.keys, key, &KeyReference::key);
  return found == section.keys.end() ? nullptr : &found->unit;
}

}  // namespace

std::string key_unit(const std::string& path) {
  auto segments = parse_key_path(path);
  if (!segments || segments->empty()) return {};
  while (segments->size() > 1 && segments->back().index) segments->pop_back();  // of a point
  const std::vector<SectionReference> sections = key_reference();
  const auto titled = [&](const std::string& title) {
    return std::ranges::find(sections, title, &SectionReference::title);
  };
  const std::string& first = segments->front().key;
  std::size_t begin = 1;
  auto section = titled("[" + first + "]");
  if (section == sections.end()) {
    section = titled("[[" + first + "]]");
    begin = segments->size() == 2 ? 1 : 2;  // after the name or the place of the element, if it has one
  }
  if (section == sections.end()) {
    section = titled("");
    begin = 0;
  }
  std::string key;
  for (std::size_t k = begin; k < segments->size(); ++k) key += (key.empty() ? "" : ".") + (*segments)[k].key;
  if (section != sections.end()) {
    if (const std::string* unit = unit_in(*section, key)) return *unit;
  }
  // A table with a section of its own.
  for (const SectionReference& group : sections) {
    if (group.title.starts_with('[')) continue;
    if (const std::string* unit = unit_in(group, segments->back().key)) return *unit;
  }
  return {};
}

std::vector<SectionReference> key_reference() {
  std::vector<SectionReference> sections;
  ReadContext context;
  context.reference = &sections;
  TableReader root(context, nullptr);
  Scenario defaults;
  read_scenario(root, defaults);
  return sections;
}

std::string scenario_reference() {
  std::string text;
  for (const SectionReference& section : key_reference()) {
    const bool is_table = section.title.starts_with('[');
    const std::string title = is_table ? "`" + section.title + "`" : section.title;
    text += (text.empty() ? "## " : "\n## ") + (title.empty() ? "Keys outside all tables" : title) + "\n\n" +
            section.meaning + "\n\n";
    text += "| key | type | default | unit | meaning |\n|---|---|---|---|---|\n";
    for (const KeyReference& key : section.keys) text += row(key);
  }
  return text;
}

}  // namespace keyblock::scenario
