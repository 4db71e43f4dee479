#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "commands.h"
#include "core/folder.h"
#include "job/result_folder.h"
#include "results/export.h"
#include "results/run_data.h"

namespace keyblock::app {
namespace {

struct ExportArguments {
  std::string folder;
  std::string format;
  std::string output;
  bool force = false;
};

void export_results(const ExportArguments& arguments) {
  const bool own_folder = arguments.output.empty();
  const std::filesystem::path output = own_folder ? std::filesystem::path(arguments.folder) / arguments.format
                                                  : std::filesystem::path(arguments.output);
  job::check_holds_no_run(output);
  if (own_folder) check_is_no_link(output);
  const results::RunData data = results::read_run(arguments.folder);
  const auto files = results::export_run(data, output, results::export_format(arguments.format).value(),
                                         own_folder || arguments.force);
  std::cout << fmt::format("{} {} in {}", files.size(), files.size() == 1 ? "file" : "files",
                           output.string());
  if (!files.empty()) std::cout << ", first " << files.front().filename().string();
  std::cout << "\n";
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Results for other programs: ParaView, spreadsheets, maps, drawings");
  command->add_option("DIR", arguments->folder, "Where a run has left its results")->required();
  command
      ->add_option(
          "--format", arguments->format,
          "vtk: frames as time series for ParaView; csv: tables of blocks, contacts and steps; geojson: the "
          "blocks at the end of each stage; dxf: the same as drawings, with the joints")
      ->required()
      ->check([](const std::string& name) {
        return results::export_format(name) ? std::string() : name + " is none of vtk, csv, geojson and dxf";
      })
      ->type_name("vtk|csv|geojson|dxf");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for the files: new, empty, or of an earlier export; default DIR/vtk, DIR/csv, "
                   "DIR/geojson or DIR/dxf")
      ->type_name("FOLDER");
  command->add_flag("--force", arguments->force,
                    "Write into a FOLDER with other files, and replace those that are in the way");
  command->footer(
      "The files take the place of those that an earlier export of the same format has left.\n\n"
      "Example:\n"
      "  keyblock export out/tunnel --format vtk");
  command->callback([arguments] { export_results(*arguments); });
}

}  // namespace keyblock::app
