#include "scenario/key_reference.h"

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

}  // namespace

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
