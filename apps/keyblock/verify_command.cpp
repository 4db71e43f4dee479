#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "interrupt.h"
#include "progress.h"
#include "scenario/key_path.h"
#include "terminal.h"
#include "verification/report.h"
#include "verification/verify.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

struct VerifyArguments {
  std::vector<std::string> names;
  std::vector<int> orders;
  std::string format = "table";
  bool all = false;
  std::string cases;
  std::string output;
  int workers = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
};

// Where the cases are: beside the source tree of a build, where they are installed, or here.
fs::path find_cases(const std::string& given) {
  if (!given.empty()) return given;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const std::vector<fs::path> places{program / "../../verification",
                                     program / "../share/keyblock/verification", "verification"};
  for (const fs::path& place : places) {
    if (fs::is_directory(place, error)) return place.lexically_normal();
  }
  Diagnostic diagnostic;
  diagnostic.where.file = "verification";
  diagnostic.found = "no such folder beside the program or here";
  diagnostic.expected = "--cases DIR, the folder with the case files";
  throw InputError(std::move(diagnostic));
}

std::vector<verification::CaseFile> chosen(std::vector<verification::CaseFile> cases,
                                           const std::vector<std::string>& names) {
  if (names.empty()) return cases;
  std::vector<std::string> known;
  for (const auto& file : cases) known.push_back(file.name);
  std::vector<Diagnostic> mistakes;
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    Diagnostic diagnostic;
    diagnostic.where.file = "keyblock verify";
    diagnostic.found = "no case '" + name + "'";
    diagnostic.expected = "one of " + scenario::list_words(known);
    diagnostic.hint = scenario::suggestion(name, known);
    mistakes.push_back(std::move(diagnostic));
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  std::erase_if(cases, [&](const auto& file) {
    return std::find(names.begin(), names.end(), file.name) == names.end();
  });
  return cases;
}

verification::VerifyProgress progress_line() {
  const Terminal terminal = Terminal::detect(STDERR_FILENO);
  if (!terminal.interactive) return {};
  return [terminal](std::size_t done, std::size_t count, const verification::CaseFile& file,
                    const verification::RunSpec& run) {
    const std::string text =
        fmt::format("{} of {} simulations; last: {}, {}", done, count, file.name, run.name);
    write_to_standard_error("\r\x1b[K" +
                            (done < count ? one_line(text, terminal.width - 1, terminal.unicode) : ""));
  };
}

std::string formatted(const std::vector<verification::CaseResult>& results,
                      const VerifyArguments& arguments) {
  if (arguments.format == "json") return verification::table_json(results, KEYBLOCK_VERSION);
  if (arguments.format == "html") return verification::table_html(results, KEYBLOCK_VERSION);
  if (arguments.format == "markdown") return verification::table_markdown(results, KEYBLOCK_VERSION);
  const Terminal terminal = Terminal::detect(STDOUT_FILENO);
  const bool file = !arguments.output.empty();
  return verification::table_text(results, {terminal.color && !file, terminal.unicode || file});
}

int verify_cases(const VerifyArguments& arguments) {
  if (!arguments.output.empty()) check_can_write(arguments.output);
  const auto cases = chosen(verification::read_cases(find_cases(arguments.cases)), arguments.names);
  verification::VerifyOptions options;
  // A case that is named is wanted, however long it takes.
  options.all = arguments.all || !arguments.names.empty();
  options.orders = std::set<int>(arguments.orders.begin(), arguments.orders.end());
  options.workers = arguments.workers;
  options.version = KEYBLOCK_VERSION;
  options.stop = &stop_on_interrupt();
  const auto results = verification::verify(cases, options, progress_line());
  const std::string text = formatted(results, arguments);
  if (arguments.output.empty()) {
    std::cout << text;
  } else {
    write_file_atomically(arguments.output, text);
    std::cout << verification::verdict_text(results) << "; " << arguments.output << "\n";
  }
  const auto rows = [](const auto& result) { return !result.rows.empty(); };
  if (std::none_of(results.begin(), results.end(), rows)) {
    std::cerr << "keyblock verify: nothing to do: --all runs the long cases, --order chooses others\n";
    return 1;
  }
  return std::any_of(results.begin(), results.end(), [](const auto& result) { return result.failed() > 0; });
}

}  // namespace

void add_verify(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = app.add_subcommand("verify", "Solves problems with known answers, and compares");
  command->add_option("NAME", arguments->names,
                      "Cases by the names of their files; default all but the long ones");
  command->add_option("--order", arguments->orders, "Only simulations of these orders of the displacement")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N");
  command->add_option("--format", arguments->format, "table, json, html or markdown")
      ->check([](const std::string& name) {
        const bool known = name == "table" || name == "json" || name == "html" || name == "markdown";
        return known ? std::string() : name + " is none of table, json, html and markdown";
      })
      ->capture_default_str()
      ->type_name("FORMAT");
  command->add_flag("--all", arguments->all, "The long cases too");
  command->add_option("--cases", arguments->cases, "Folder of the case files; default that of the program")
      ->type_name("DIR");
  command->add_option("--workers", arguments->workers, "Simulations at once, one thread each")
      ->check(CLI::Range(1, 1024).description(""))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("-o,--output", arguments->output, "File for the table; default standard output")
      ->type_name("FILE");
  command->footer(
      "Exit code 1 when a row does not hold.\n\n"
      "Examples:\n"
      "  keyblock verify\n"
      "  keyblock verify incline --order 1 2\n"
      "  keyblock verify --all --format html -o verification.html");
  command->callback([arguments, &exit_code] { exit_code = verify_cases(*arguments); });
}

}  // namespace keyblock::app
