#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "commands.h"
#include "results/export.h"
#include "results/run_data.h"

namespace keyblock::app {
namespace {

struct ExportArguments {
  std::string folder;
  std::string format;
  std::string output;
};

void export_results(const ExportArguments& arguments) {
  const results::RunData data = results::read_run(arguments.folder);
  const std::filesystem::path output = arguments.output.empty()
                                           ? std::filesystem::path(arguments.folder) / arguments.format
                                           : std::filesystem::path(arguments.output);
  const auto files = results::export_run(data, output, results::export_format(arguments.format).value());
  std::cout << fmt::format("{} {} in {}", files.size(), files.size() == 1 ? "file" : "files",
                           output.string());
  if (!files.empty()) std::cout << ", first " << files.front().filename().string();
  std::cout << "\n";
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Results for other programs: ParaView, spreadsheets, maps");
  command->add_option("DIR", arguments->folder, "Where a run has left its results")->required();
  command
      ->add_option(
          "--format", arguments->format,
          "vtk: frames as time series for ParaView; csv: tables of blocks, contacts and steps; geojson: the "
          "blocks at the end of each stage")
      ->required()
      ->check([](const std::string& name) {
        return results::export_format(name) ? std::string() : name + " is none of vtk, csv and geojson";
      })
      ->type_name("vtk|csv|geojson");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for the files; default DIR/vtk, DIR/csv or DIR/geojson")
      ->type_name("FOLDER");
  command->footer("Example:\n  keyblock export out/tunnel --format vtk");
  command->callback([arguments] { export_results(*arguments); });
}

}  // namespace keyblock::app
