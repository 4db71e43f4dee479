#include "job/recorded_run.h"

#include <exception>
#include <iostream>
#include <utility>

#include "core/error.h"
#include "core/folder.h"
#include "core/out_of_memory.h"
#include "report/report.h"
#include "results/csv.h"
#include "results/run_data.h"
#include "scenario/inputs.h"
#include "simulation/feasibility.h"

namespace keyblock::job {

RecordedRun::RecordedRun(const scenario::Scenario& scenario, const simulation::RunSetup& setup,
                         Options options, record::RunObserver& observer)
    : setup_(setup),
      options_(std::move(options)),
      guard_(options_.folder, files_read(scenario), setup, options_.use),
      writer_(options_.folder),
      observers_({&writer_, &observer}) {
  options_.run.directory = options_.folder;
  options_.run.resume = guard_.resumes();
  writer_.before_publishing([this] { guard_.enter(); });
}

/// The first failure is the one to be told about.
template <typename Work>
decltype(auto) RecordedRun::with_report_of_failure(const Work& work) {
  try {
    return work();
  } catch (const RunError&) {
    try {
      if (guard_.holds_this_run()) write_report(options_.folder);
    } catch (const std::exception& error) {
      std::cerr << "keyblock: no report: " << error.what() << "\n";
    }
    throw;
  }
}

void RecordedRun::start() {
  with_report_of_failure([&] {
    with_memory_for([&] { return simulation::memory_purpose(setup_); },
                    [&] { runner_.emplace(setup_, options_.run, observers_); });
  });
}

simulation::Advance RecordedRun::advance() {
  return with_report_of_failure([&] { return runner_->advance(); });
}

record::RunRecord RecordedRun::finish() {
  try {
    record::RunRecord record = with_report_of_failure([&] { return runner_->finish(); });
    write_report(options_.folder);
    close();
    return record;
  } catch (...) {
    close();
    throw;
  }
}

void RecordedRun::close() {
  writer_.close();
  guard_.let_go();
}

std::vector<std::filesystem::path> files_read(const scenario::Scenario& scenario) {
  std::vector<std::filesystem::path> files = scenario::input_paths(scenario);
  files.emplace_back(scenario.file);
  return files;
}

void write_report(const std::filesystem::path& folder) {
  with_memory_for([] { return std::string("the report; `keyblock report` writes it later"); },
                  [&] { report::write_report(results::read_run(folder), folder); });
}

void restore_conclusions(const std::filesystem::path& folder) {
  const auto is_gone = [&](const char* name) {
    return !file_exists(folder / name) || std::filesystem::is_empty(folder / name);
  };
  const bool report = is_gone("report.html"), histories = is_gone("histories.csv");
  if (!report && !histories) return;
  const results::RunData data = results::read_run(folder);
  if (report) report::write_report(data, folder);
  if (histories && results::has_histories(data.model))
    results::write_histories_csv(folder, data.model, data.histories);
}

}  // namespace keyblock::job
