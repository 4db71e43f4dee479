#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/plan_json.h"
#include "study/risk.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

struct RiskArguments {
  std::string folder, settings, level, output;
  std::vector<std::string> hazards;
  bool as_json = false;
};

study::RiskSettings settings_of(const RiskArguments& arguments) {
  study::RiskSettings settings;
  if (!arguments.settings.empty()) settings = study::read_risk_settings(arguments.settings);
  for (const std::string& file : arguments.hazards) {
    study::HazardSource source;
    source.file = file;
    source.options.from = "[[hazard]] of the file of --settings";
    settings.hazards.push_back(std::move(source));
  }
  if (!settings.hazards.empty()) return settings;
  Diagnostic diagnostic;
  diagnostic.where.file = arguments.settings;
  diagnostic.found = "no hazard curve";
  diagnostic.expected = "--hazard FILE, or [[hazard]] in the file of --settings";
  throw InputError(std::move(diagnostic));
}

void show_risk(const RiskArguments& arguments) {
  const study::RiskSettings settings = settings_of(arguments);
  study::check_is_no_limit(arguments.folder);
  const study::Plan plan = study::read_plan(arguments.folder);
  const study::StudyData data = study::study_data(plan, study::read_study_files(arguments.folder, plan));
  const study::Summary summary = study::summarize(data);
  const study::Risk risk = study::find_risk(data, summary, settings, arguments.level);
  const std::string json = study::risk_json(data, summary, risk);
  const fs::path output =
      arguments.output.empty() ? fs::path(arguments.folder) / "risk" : fs::path(arguments.output);
  make_folder(output);
  write_file_atomically(output / "risk.json", json);
  write_file_atomically(output / "risk.csv", study::risk_csv(data, summary, risk));
  if (arguments.as_json) {
    std::cout << json;
    return;
  }
  for (const std::string& line : study::risk_lines(data, summary, risk)) std::cout << line << "\n";
  std::cout << (output / "risk.json").string() << ", risk.csv\n";
}

}  // namespace

void add_risk(CLI::App& app) {
  auto arguments = std::make_shared<RiskArguments>();
  CLI::App* command = app.add_subcommand(
      "risk", "How often a year damage is exceeded: fragility of a study times hazard curves");
  command->add_option("DIR", arguments->folder, "Folder of a study whose runs are done")->required();
  command
      ->add_option("--hazard", arguments->hazards,
                   "Hazard curve of OpenQuake or the USGS; others need --settings")
      ->type_name("FILE");
  command->add_option("--settings", arguments->settings, "Lifetime, sections, hazard curves: docs/risk.md")
      ->type_name("FILE");
  command->add_option("--level", arguments->level, "One level of damage (default: all)")->type_name("NAME");
  command
      ->add_option("-o,--output", arguments->output, "Folder for risk.json and risk.csv (default: DIR/risk)")
      ->type_name("DIR");
  command->add_flag("--json", arguments->as_json, "Print risk.json");
  command->callback([arguments] { show_risk(*arguments); });
}

}  // namespace keyblock::app
