#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "external_tool.h"
#include "picture/quantities.h"
#include "picture_arguments.h"
#include "scenario/key_path.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

struct MomentArguments {
  std::optional<double> time;
  std::string stage;
};

std::size_t frame_asked_for(const results::RunData& run, const MomentArguments& arguments) {
  if (arguments.time) {
    const double end = run.frames.back().time;
    if (*arguments.time > end * (1.0 + 1e-9) + 1e-9) {
      Diagnostic diagnostic;
      diagnostic.key = "--time";
      diagnostic.found = fmt::format("{:g} s", *arguments.time);
      diagnostic.expected = fmt::format("a time of the run, which ends at {:g} s", end);
      throw InputError(std::move(diagnostic));
    }
    return picture::frame_near(run, *arguments.time);
  }
  if (arguments.stage.empty()) return run.frames.size() - 1;
  for (const std::size_t end : picture::stage_end_frames(run))
    if (run.model.stage_names.at(static_cast<std::size_t>(run.frames[end].stage)) == arguments.stage)
      return end;
  Diagnostic diagnostic;
  diagnostic.key = "--stage";
  diagnostic.found = "'" + arguments.stage + "'";
  diagnostic.expected = "a stage that has begun: " + scenario::list_words(run.model.stage_names, " or ");
  throw InputError(std::move(diagnostic));
}

void convert(const fs::path& svg, const fs::path& output, const std::string& format) {
  const WorkFolder work(output);
  const fs::path made = work / ("picture." + format);
  std::vector<std::string> words{"--format", format, "--output", made.string(), svg.string()};
  if (format == "png") words.insert(words.begin(), {"--zoom", "3"});
  run_tool(find_tool(svg_converter), words);
  write_file_atomically(output, read_file(made));
}

void draw_picture(const PictureArguments& arguments, const MomentArguments& moment) {
  fs::path output = arguments.output;
  const std::string format =
      output.empty() ? "svg" : output.extension().string().substr(output.has_extension() ? 1 : 0);
  if (format != "svg" && format != "pdf" && format != "png") {
    Diagnostic diagnostic;
    diagnostic.key = "-o";
    diagnostic.found = "'" + output.string() + "'";
    diagnostic.expected = "a name that ends in .svg, .pdf or .png";
    throw InputError(std::move(diagnostic));
  }
  if (format != "svg") find_tool(svg_converter);
  const results::RunData run = read_frames(arguments.folder);
  const std::size_t frame = frame_asked_for(run, moment);
  const picture::SectionPicture picture(run, arguments.options);
  if (output.empty()) output = fs::path(arguments.folder) / (picture.file_name(frame) + ".svg");
  check_can_write(output);
  if (format == "svg") {
    write_file_atomically(output, picture.draw(frame));
  } else {
    const WorkFolder work(output);
    const fs::path svg = work / "picture.svg";
    write_file_atomically(svg, picture.draw(frame));
    convert(svg, output, format);
  }
  std::cout << fmt::format("picture of {:.3f} s: {}\n", run.frames[frame].time, output.string());
}

}  // namespace

void add_picture(CLI::App& app) {
  auto arguments = std::make_shared<PictureArguments>();
  auto moment = std::make_shared<MomentArguments>();
  CLI::App* command =
      app.add_subcommand("picture", "A picture of the section at one moment: SVG, PDF or PNG");
  add_picture_arguments(*command, *arguments);
  CLI::Option* time =
      command->add_option("--time", moment->time, "Of the frame nearest to it, s; default: the end")
          ->check(CLI::Range(0.0, 1e9).description(""))
          ->type_name("T");
  command->add_option("--stage", moment->stage, "The end of this stage")->excludes(time)->type_name("NAME");
  command
      ->add_option(
          "-o,--output", arguments->output,
          "A file that ends in .svg, .pdf or .png; default: an SVG in DIR whose name says what it is")
      ->type_name("FILE");
  command->footer(
      "Scales are the same for all moments of a run, so that pictures can be compared.\n\n"
      "Examples:\n"
      "  keyblock picture out/tunnel --time 3.4 --color slip -o slip.pdf\n"
      "  keyblock picture out/arch --color plain --thrust");
  command->callback([arguments, moment] { draw_picture(*arguments, *moment); });
}

}  // namespace keyblock::app
