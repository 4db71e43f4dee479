#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "command_tree.h"
#include "scenario/key_reference.h"

namespace keyblock::app {
namespace {

using Nodes = std::vector<const CommandNode*>;

/// Commands, those that have others below them before these.
Nodes all_commands(const CommandNode& node) {
  Nodes nodes;
  for (const CommandNode& command : node.commands) {
    nodes.push_back(&command);
    for (const CommandNode* below : all_commands(command)) nodes.push_back(below);
  }
  return nodes;
}

std::string last_word(const std::string& name) {
  return name.substr(name.rfind(' ') + 1);
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

std::vector<std::string> names_below(const CommandNode& node) {
  std::vector<std::string> names;
  for (const CommandNode& command : node.commands) names.push_back(last_word(command.name));
  return names;
}

std::vector<std::string> option_names(const CommandNode& node) {
  std::vector<std::string> names;
  for (const CommandOption& option : node.options) {
    if (!option.is_argument) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// Key paths that need no name of an element: `rock.young=`.
std::vector<std::string> keys_of_tables() {
  std::vector<std::string> keys;
  for (const scenario::SectionReference& section : scenario::key_reference()) {
    const std::string& title = section.title;
    const bool is_table = title.starts_with('[') && !title.starts_with("[[");
    if (!title.empty() && !is_table) continue;
    const std::string table = title.empty() ? "" : title.substr(1, title.size() - 2) + ".";
    for (const scenario::KeyReference& key : section.keys) keys.push_back(table + key.key + "=");
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

std::string in_quotes(std::string text) {
  for (std::size_t at = text.find('\''); at != std::string::npos; at = text.find('\'', at + 4))
    text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

/// The first sentence, which is what lists have room for.
std::string first_sentence(const std::string& text) {
  return text.substr(0, std::min(text.find("; "), text.find(". ")));
}

/// `run`, `study`, `study_run`, …
std::string command_words(const CommandNode& program) {
  std::vector<std::string> names;
  for (const CommandNode* node : all_commands(program)) {
    std::string name = node->name;
    std::replace(name.begin(), name.end(), ' ', '_');
    names.push_back(std::move(name));
  }
  return joined(names);
}

std::string bash_cases(const CommandNode& program) {
  std::string cases;
  for (const CommandNode* node : all_commands(program)) {
    std::vector<std::string> words = names_below(*node);
    for (const std::string& name : option_names(*node)) words.push_back(name);
    cases += fmt::format("    '{}') words='{}' ;;\n", node->name, joined(words));
  }
  return cases;
}

std::string bash_values(const CommandNode& program) {
  std::string values;
  for (const CommandNode* node : all_commands(program)) {
    for (const CommandOption& option : node->options) {
      if (option.words.empty() || option.is_argument) continue;
      for (const std::string& name : option.names)
        values += fmt::format("    '{} {}') COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n",
                              node->name, name, joined(option.words));
    }
  }
  return values;
}

std::string bash(const CommandNode& program) {
  return fmt::format(
      R"(# Completion of keyblock for bash.
_keyblock() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} command='' word words
  local commands=' {} '
  for word in "${{COMP_WORDS[@]:1:$((COMP_CWORD - 1))}}"; do
    [[ $word == -* ]] && continue
    if [[ $commands == *" ${{command:+${{command}}_}}$word "* ]]; then command=${{command:+$command }}$word; else break; fi
  done
  # Words are cut at "=": --set rock.young= is three of them.
  if [[ $previous == --set ]]; then
    compopt -o nospace
    COMPREPLY=($(compgen -W '{}' -- "$current"))
    return
  fi
  case "$command $previous" in
{}  esac
  case $command in
{}    *) words='{}' ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  [[ $current == -* ]] && return
  compopt -o filenames
  while IFS= read -r word; do COMPREPLY+=("$word"); done < <(compgen -f -- "$current")
}}
complete -F _keyblock keyblock
)",
      command_words(program), joined(keys_of_tables()), bash_values(program), bash_cases(program),
      joined(names_below(program)) + " " + joined(option_names(program)));
}

/// When fish offers a command: after its parent, and after none of its siblings.
std::string fish_condition(const CommandNode& program, const CommandNode& node) {
  const std::size_t space = node.name.find(' ');
  if (space == std::string::npos)
    return fmt::format("not __fish_seen_subcommand_from {}", joined(names_below(program)));
  const std::string above = node.name.substr(0, space);
  const auto parent = std::find_if(program.commands.begin(), program.commands.end(),
                                   [&](const CommandNode& command) { return command.name == above; });
  return fmt::format("__fish_seen_subcommand_from {}; and not __fish_seen_subcommand_from {}", above,
                     joined(names_below(*parent)));
}

std::string fish_option(const CommandNode& node, const CommandOption& option) {
  std::string text = fmt::format("complete -c keyblock -n {}",
                                 in_quotes("__fish_seen_subcommand_from " + last_word(node.name)));
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.value.empty()) text += " -r";
  if (!option.words.empty()) text += " -f -a " + in_quotes(joined(option.words));
  if (option.names.back() == "--set") text += " -f -a " + in_quotes(joined(keys_of_tables()));
  return text + " -d " + in_quotes(first_sentence(option.meaning)) + "\n";
}

std::string fish(const CommandNode& program) {
  std::string text = "# Completion of keyblock for fish.\n";
  for (const CommandNode* node : all_commands(program)) {
    text +=
        fmt::format("complete -c keyblock -f -n {} -a {} -d {}\n", in_quotes(fish_condition(program, *node)),
                    last_word(node->name), in_quotes(first_sentence(node->meaning)));
    for (const CommandOption& option : node->options) {
      if (!option.is_argument) text += fish_option(*node, option);
    }
  }
  return text;
}

std::string zsh(const CommandNode& program) {
  // The functions of bash do for zsh, too, except for compopt.
  return "#compdef keyblock\n# Completion of keyblock for zsh, by that for bash.\n"
         "autoload -U +X bashcompinit && bashcompinit\n"
         "(( ${+functions[compopt]} )) || compopt() { :; }\n" +
         bash(program);
}

}  // namespace

std::string completion_script(const CommandNode& program, const std::string& shell) {
  if (shell == "fish") return fish(program);
  return shell == "zsh" ? zsh(program) : bash(program);
}

}  // namespace keyblock::app
