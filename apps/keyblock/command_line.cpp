#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "build_info.h"
#include "commands.h"
#include "core/error.h"
#include "core/out_of_memory.h"
#include "harmless_output.h"
#include "scenario/key_path.h"

namespace keyblock::app {
namespace {

/// As from a variable of the shell that is not set.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator given(
      [](std::string& value) {
        return value.empty() ? std::string("found nothing; expected a value") : std::string();
      },
      "");
  for (CLI::Option* option : app.get_options()) {
    if (option->get_expected_max() > 0 && option->get_items_expected_max() > 0) option->check(given);
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

void describe(CLI::App& app, int& exit_code) {
  app.name("keyblock");
  app.description(
      "Jointed rock as a system of deformable blocks (2D discontinuous deformation analysis): joints are cut "
      "into "
      "blocks, an opening is excavated, an earthquake shakes it.");
  // The order matters: options act in the order in which they are added.
  const auto verbose = std::make_shared<bool>(false);
  app.add_flag("--verbose", *verbose,
               "With --version: for which processor the program was built, and by what");
  app.set_version_flag("--version",
                       [verbose] { return *verbose ? build_info() : "keyblock " KEYBLOCK_VERSION; });
  app.footer(
      "Examples:\n"
      "  keyblock new tunnel\n"
      "  keyblock check tunnel.toml\n"
      "  keyblock run tunnel.toml -o out/tunnel\n"
      "  keyblock run tunnel.toml -o out/strong --set \"stage.'first earthquake'.scale=2\"\n"
      "  keyblock picture out/tunnel --color slip -o slip.pdf\n"
      "  keyblock motion record.smc --plot\n"
      "  keyblock study run tunnel.toml -o out/study --workers 8\n"
      "  keyblock limit tunnel.toml --key joints.friction --from 45 --to 5 -o out/limit\n"
      "  keyblock verify\n\n"
      "Each command has its own --help.\n"
      "Exit codes: 0 done, 1 the input is wrong or a check does not hold, 2 the run failed or was "
      "interrupted, 3 internal error.");
  app.require_subcommand(1);
  add_run(app);
  add_check(app, exit_code);
  add_cut(app);
  add_report(app);
  add_export(app);
  add_picture(app);
  add_film(app);
  add_motion(app, exit_code);
  add_verify(app, exit_code);
  add_study(app);
  add_risk(app);
  add_limit(app);
  add_safety(app);
  add_bolt(app);
  add_new(app);
  add_schema(app);
  add_completion(app);
  add_manual(app);
  refuse_empty_values(app);
}

/// --help and --version arrive here too; they are no mistakes.
int explain(const CLI::App& app, const std::vector<std::string>& words, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    app.exit(error, std::cout, std::cerr);
    return done;
  }
  const CLI::App* asked = &app;
  if (app.get_subcommands().empty() && !words.empty() && words.front().substr(0, 1) != "-") {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    const std::string hint = scenario::suggestion(words.front(), names);
    std::cerr << fmt::format("keyblock: no command '{}'; there are {}{}\n", words.front(),
                             scenario::list_words(names, " and "), hint.empty() ? "" : "; " + hint);
    return input_wrong;
  }
  std::string command = "keyblock";
  while (!asked->get_subcommands().empty()) {
    asked = asked->get_subcommands().front();
    command += " " + asked->get_name();
  }
  std::cerr << command << ": " << error.what() << "\nSee " << command << " --help.\n";
  return input_wrong;
}

/// What was printed may have been lost on a full disk.
void finish_output() {
  if (!std::cout.flush()) throw RunError("standard output could not be written");
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  // What would grow beyond the limit for files is an error of writing like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const HarmlessOutput output(std::cout), errors(std::cerr);
  try {
    CLI::App app;
    int exit_code = done;
    describe(app, exit_code);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      exit_code = explain(app, {argv + 1, argv + argc}, error);
    }
    finish_output();
    return exit_code;
  } catch (const InputError& error) {
    std::cerr << error.what() << "\n";
    return input_wrong;
  } catch (const RunError& error) {
    std::cerr << "keyblock: " << error.what() << "\n";
    return run_failed;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "keyblock: " << error.what() << "\n";
    return run_failed;
  } catch (const std::bad_alloc&) {
    std::cerr << "keyblock: " << out_of_memory_text("") << "\n";
    return run_failed;
  } catch (const std::exception& error) {
    std::cerr << "keyblock: internal error: " << error.what()
              << "\nThis is a mistake in keyblock, not in your input. Please report it, with the scenario "
                 "and the output "
                 "of keyblock --version.\n";
    return internal_error;
  }
}

}  // namespace keyblock::app
