#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "commands.h"
#include "core/folder.h"
#include "report/report.h"
#include "results/run_data.h"

namespace keyblock::app {

void add_report(CLI::App& app) {
  auto directory = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("report", "Write DIR/report.html again from the results in DIR");
  command->add_option("DIR", *directory, "Where a run has left its results")->required();
  command->footer("Example:\n  keyblock report out/tunnel");
  command->callback([directory] {
    const results::RunData run = results::read_run(*directory);
    check_can_write(std::filesystem::path(*directory) / "report.html");
    report::write_report(run, *directory);
    std::cout << "report: " << *directory << "/report.html\n";
  });
}

}  // namespace keyblock::app
