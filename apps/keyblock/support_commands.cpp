#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "command_tree.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "scenario/schema.h"
#include "templates.h"

namespace keyblock::app {
namespace {

struct NewArguments {
  std::string kind;
  std::string file;
  bool force = false;
};

void write_new(const NewArguments& arguments) {
  std::string text(template_text(arguments.kind));
  if (arguments.file == "-") {
    std::cout << text;
    return;
  }
  const std::string file = arguments.file.empty() ? arguments.kind + ".toml" : arguments.file;
  if (file_exists(file) && !arguments.force) {
    Diagnostic diagnostic;
    diagnostic.where.file = file;
    diagnostic.found = "a file that is there";
    diagnostic.expected = "the name of a new one";
    diagnostic.hint = "-o gives another, --force replaces it";
    throw InputError(std::move(diagnostic));
  }
  write_file_atomically(file, text);
  std::cout << file << ": change it as you like, then\n  keyblock check " << file << "\n  keyblock "
            << (arguments.kind == "study" ? "study run " : "run ") << file << " -o out\n";
}

const CLI::App& root_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app : root_of(*app.get_parent());
}

}  // namespace

void add_new(CLI::App& app) {
  auto arguments = std::make_shared<NewArguments>();
  CLI::App* command = app.add_subcommand("new", "A scenario to start from, with a word on every value");
  std::string kinds;
  for (const std::string& kind : template_kinds()) kinds += (kinds.empty() ? "" : "|") + kind;
  command->add_option("KIND", arguments->kind, "What it is of: " + kinds)
      ->required()
      ->check(CLI::IsMember(template_kinds()).description(""));
  command
      ->add_option("-o,--output", arguments->file,
                   "The file; - writes it to standard output; default KIND.toml")
      ->type_name("FILE");
  command->add_flag("--force", arguments->force, "Replace a file that is there");
  command->footer("Example:\n  keyblock new tunnel -o mine.toml");
  command->callback([arguments] { write_new(*arguments); });
}

void add_schema(CLI::App& app) {
  CLI::App* command = app.add_subcommand("schema", "A JSON Schema of scenarios, for editors");
  command->footer(
      "An editor with a TOML language server (Even Better TOML, taplo) completes keys and underlines "
      "mistakes in\n"
      "files whose first line names the schema:\n"
      "  keyblock schema > keyblock.schema.json\n"
      "  #:schema ./keyblock.schema.json");
  command->callback([] { std::cout << scenario::schema(); });
}

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "A script by which your shell completes what you type");
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}).description(""));
  command->footer(
      "Packages install them. By hand:\n"
      "  keyblock completion bash > ~/.local/share/bash-completion/completions/keyblock\n"
      "  keyblock completion fish > ~/.config/fish/completions/keyblock.fish\n"
      "  keyblock completion zsh > ~/.zsh/_keyblock          # a folder of $fpath");
  command->callback(
      [command, shell] { std::cout << completion_script(command_tree(root_of(*command)), *shell); });
}

void add_manual(CLI::App& app) {
  CLI::App* command = app.add_subcommand("manual-page", "keyblock(1), for man");
  command->group("");  // for packages
  command->callback(
      [command] { std::cout << manual_page(command_tree(root_of(*command)), KEYBLOCK_VERSION); });
}

}  // namespace keyblock::app
