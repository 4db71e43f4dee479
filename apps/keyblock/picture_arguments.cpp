#include "picture_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "picture/marks.h"
#include "picture/quantities.h"
#include "scenario/key_path.h"

namespace keyblock::app {
namespace {

CLI::Validator one_of(const std::vector<std::string>& words) {
  return {[words](std::string& value) {
            for (const std::string& word : words)
              if (word == value) return std::string();
            const std::string hint = scenario::suggestion(value, words);
            return fmt::format("found '{}'; expected {}{}", value, scenario::list_words(words, " or "),
                               hint.empty() ? "" : "; " + hint);
          },
          ""};
}

std::vector<std::string> as_strings(std::span<const std::string_view> words) {
  return {words.begin(), words.end()};
}

std::vector<std::string> names_of_quantities() {
  std::vector<std::string> names;
  for (const auto& quantity : picture::block_quantities()) names.emplace_back(quantity.name);
  return names;
}

std::string help_of(std::string_view mark) {
  std::string text = picture::mark_of(mark).meaning;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

void add_picture_arguments(CLI::App& command, PictureArguments& arguments) {
  picture::Options& o = arguments.options;
  command.add_option("DIR", arguments.folder, "Where a run has left its results")->required();
  command
      .add_option("--color", o.color,
                  "What blocks are coloured by: " + scenario::list_words(names_of_quantities(), " or "))
      ->check(one_of(names_of_quantities()))
      ->capture_default_str()
      ->type_name("NAME");
  command
      .add_option(
          "--joints", o.joints,
          "What joints are coloured by: " + scenario::list_words(as_strings(picture::joint_words), " or "))
      ->check(one_of(as_strings(picture::joint_words)))
      ->capture_default_str()
      ->type_name("NAME");
  command.add_flag("--forces", o.forces, help_of("forces"));
  command.add_flag("--stress", o.stress, help_of("stress"));
  command.add_flag("--thrust", o.thrust, help_of("thrust"));
  command.add_option("--arrows", o.arrows, "An arrow per block: none, displacement or velocity")
      ->check(one_of(as_strings(picture::arrow_words)))
      ->capture_default_str()
      ->type_name("NAME");
  command.add_flag("--outline", o.outline, help_of("outline"));
  command.add_option("--exaggerate", o.exaggeration, "Factor on displacements, as drawn")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->capture_default_str()
      ->type_name("F");
}

results::RunData read_frames(const std::string& folder) {
  results::RunData run = results::read_run(folder);
  if (run.frames.empty()) {
    Diagnostic diagnostic;
    diagnostic.where.file = folder + "/result.h5";
    diagnostic.found = "no frame";
    diagnostic.expected = "at least one moment of the run";
    throw InputError(std::move(diagnostic));
  }
  return run;
}

}  // namespace keyblock::app
