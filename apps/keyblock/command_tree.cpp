#include "command_tree.h"

#include <CLI/CLI.hpp>

namespace keyblock::app {
namespace {

/// `vtk|csv|geojson` → three words.
std::vector<std::string> words_of(const std::string& value) {
  std::vector<std::string> words;
  if (value.find('|') == std::string::npos) return words;
  for (std::size_t from = 0; from <= value.size();) {
    const std::size_t to = std::min(value.find('|', from), value.size());
    words.push_back(value.substr(from, to - from));
    from = to + 1;
  }
  return words;
}

CommandOption option_of(const CLI::Option& option) {
  CommandOption described;
  described.is_argument = option.get_positional();
  if (described.is_argument) {
    described.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  }
  described.value = option.get_items_expected_max() > 0 ? option.get_type_name() : std::string();
  described.meaning = option.get_description();
  described.words = words_of(described.value);
  return described;
}

CommandNode node_of(const CLI::App& app, const std::string& above) {
  CommandNode node{above + app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) node.options.push_back(option_of(*option));
  }
  const std::string prefix = above.empty() && app.get_parent() == nullptr ? "" : node.name + " ";
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) node.commands.push_back(node_of(*command, prefix));
  }
  return node;
}

}  // namespace

CommandNode command_tree(const CLI::App& app) {
  return node_of(app, "");
}

}  // namespace keyblock::app
