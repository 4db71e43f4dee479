#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace keyblock::app {

/// An option or an argument of a command, as its help shows it.
struct CommandOption {
  std::vector<std::string> names;  ///< `-o`, `--output`; a single word for an argument
  std::string value;               ///< what stands for the value: `DIR`; empty: a flag
  std::string meaning;
  std::vector<std::string> words;  ///< that the value may be, where these are known
  bool is_argument = false;
};

/// A command with what lies below it. Made of the command line itself, so that completion and manual pages say what the program does.
struct CommandNode {
  std::string name;  ///< with those above it: `study run`
  std::string meaning, footer;
  std::vector<CommandOption> options;
  std::vector<CommandNode> commands;
};

/// Hidden options are left out.
CommandNode command_tree(const CLI::App& app);

/// A script by which a shell completes commands, options, files, and the keys of --set: `bash`, `zsh` or `fish`.
std::string completion_script(const CommandNode& program, const std::string& shell);

/// The manual page, keyblock(1), as roff.
std::string manual_page(const CommandNode& program, const std::string& version);

}  // namespace keyblock::app
