#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "command_line.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "json_output.h"
#include "loading/motion_measures.h"
#include "motion_json.h"
#include "motion_suite.h"

namespace keyblock::app {
namespace {

struct MotionArguments {
  std::vector<std::string> files;
  bool plot = false;
  std::string output = "motion.svg";
  bool force = false;
  bool as_json = false;
  loading::MotionReading reading;
  std::vector<double> window;  // empty, or from and to
  std::string suite, target, spectra;
};

[[noreturn]] void refuse_output(const std::filesystem::path& output, std::string found,
                                std::string expected) {
  Diagnostic diagnostic;
  diagnostic.where.file = output.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  throw InputError(std::move(diagnostic));
}

bool is_plot(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const std::string text = read_file(file);
  return text.starts_with("<svg ") && text.ends_with("time, s</text>\n</svg>\n");
}

// Records are never replaced, other files than plots not without being asked to.
void check_output(const MotionArguments& arguments) {
  const std::filesystem::path output = arguments.output;
  check_can_write(output);
  if (!file_exists(output)) return;
  for (const std::string& file : arguments.files) {
    std::error_code error;
    if (std::filesystem::equivalent(file, output, error))
      refuse_output(output, "a record that is to be read", "another file for the plot");
  }
  if (!arguments.force && !is_plot(output))
    refuse_output(output, "a file that is no plot of motions", "another file, or --force to replace it");
}

struct Records {
  std::vector<loading::MotionComponent> components;
  std::vector<Diagnostic> mistakes;
};

Records read_records(const MotionArguments& arguments) {
  Records records;
  for (const std::string& file : arguments.files) {
    try {
      for (auto& component : loading::read_motion_file(file, arguments.reading)) {
        if (!arguments.window.empty())
          component = loading::cut_out(std::move(component), arguments.window[0], arguments.window[1]);
        records.components.push_back(std::move(component));
      }
    } catch (const InputError& error) {
      records.mistakes.insert(records.mistakes.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  return records;
}

void plot(const MotionArguments& arguments, const Records& records) {
  write_file_atomically(arguments.output, loading::plot_motion_svg(records.components));
}

void show_motions(const MotionArguments& arguments) {
  if (arguments.plot) check_output(arguments);
  Records records = read_records(arguments);
  std::cout << loading::describe_motion(records.components);
  if (!records.mistakes.empty()) throw InputError(std::move(records.mistakes));
  if (!arguments.plot) return;
  plot(arguments, records);
  std::cout << "plot: " << arguments.output << "\n";
}

/// For other programs. Mistakes of files are printed here, and the exit code says that there are some.
void motions_as_json(const MotionArguments& arguments, int& exit_code) {
  if (arguments.plot) check_output(arguments);
  const Records records = read_records(arguments);
  nlohmann::ordered_json json{{"ok", records.mistakes.empty()},
                              {"mistakes", mistakes_json(records.mistakes)},
                              {"components", components_json(records.components)}};
  if (!records.mistakes.empty()) {
    exit_code = input_wrong;
  } else if (arguments.plot) {
    plot(arguments, records);
    json["plot"] = arguments.output;
  }
  print_json(json);
}

/// Exactly one of files and suite.
void add_suite_options(CLI::App& command, MotionArguments& arguments, CLI::Option& files) {
  CLI::Option* suite = command
                           .add_option("--suite", arguments.suite,
                                       "In the place of files: a list of records. Prints their intensities")
                           ->type_name("CSV")
                           ->excludes(&files);
  command
      .add_option("--target", arguments.target, "Spectrum that the suite is to have: period in s, SA in m/s2")
      ->type_name("CSV")
      ->needs(suite);
  command.add_option("--spectra", arguments.spectra, "Write the spectra of the suite and its records")
      ->type_name("CSV")
      ->needs(suite);
}

void run_motion(const MotionArguments& arguments, int& exit_code) {
  if (!arguments.suite.empty()) {
    if (arguments.plot || !arguments.window.empty() || arguments.reading.by_hand() ||
        !arguments.reading.unit.empty())
      throw CLI::ExcludesError("--suite", "--plot, --window and what says how a file is read");
    return show_suite(
        {arguments.suite, arguments.target, arguments.spectra, arguments.force, arguments.as_json});
  }
  if (arguments.files.empty()) throw CLI::RequiredError("FILE");
  if (arguments.as_json) return motions_as_json(arguments, exit_code);
  show_motions(arguments);
}

}  // namespace

void add_motion(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<MotionArguments>();
  CLI::App* command =
      app.add_subcommand("motion", "What a ground motion record holds: components, dt, points, peak, unit");
  CLI::Option* files = command->add_option("FILE", arguments->files,
                                           loading::motion_format_names() + " of time and accelerations");
  add_suite_options(*command, *arguments, *files);
  command->add_option("--skip", arguments->reading.skip, "Read plain numbers after this many lines")
      ->type_name("LINES");
  command->add_option("--column", arguments->reading.column, "Read plain numbers of this column, from 1")
      ->type_name("K");
  command->add_option("--dt", arguments->reading.dt, "Read plain numbers with this time step, in s")
      ->type_name("SECONDS");
  command
      ->add_option("--unit", arguments->reading.unit, "Unit of plain numbers, or of a file that names none")
      ->type_name("UNIT");
  command
      ->add_option("--window", arguments->window,
                   "Only the samples from one time to another, in s of the record")
      ->type_name("FROM TO")
      ->expected(2);
  command->add_flag(
      "--plot", arguments->plot,
      "Draw the components, with velocity, displacement, spectra and the baseline options, into an SVG "
      "file");
  command->add_option("-o,--output", arguments->output, "The SVG file")
      ->type_name("SVG")
      ->capture_default_str()
      ->needs("--plot");
  command->add_flag("--force", arguments->force,
                    "Replace the SVG or CSV file even if it is none of this command");
  command->add_flag("--json", arguments->as_json,
                    "For other programs: components and mistakes as JSON on standard output");
  command->footer(
      "Examples:\n  keyblock motion motions/*.smc --plot -o record.svg\n  keyblock motion other.txt --skip 3 "
      "--dt 0.01 --unit g");
  command->callback([arguments, &exit_code] { run_motion(*arguments, exit_code); });
}

}  // namespace keyblock::app
