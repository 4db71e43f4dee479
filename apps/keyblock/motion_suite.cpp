#include "motion_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "core/text.h"
#include "json_output.h"
#include "loading/intensity.h"
#include "loading/suite_measures.h"

namespace keyblock::app {
namespace {

using Target = std::vector<std::pair<double, double>>;

/// Where the median of the suite is farthest from the target, by its logarithm.
struct Misfit {
  double period = 0.0, ratio = 1.0;
};

Misfit largest_misfit(const std::vector<loading::SuiteRow>& rows, const Target& target) {
  const loading::SuiteSpectrum suite = loading::spectrum_of(rows);
  const std::vector<double> periods = loading::suite_periods();
  Misfit worst;
  for (std::size_t k = 0; k < periods.size(); ++k) {
    const double ratio = suite.median[k] / loading::target_at(target, periods[k]);
    if (std::abs(std::log(ratio)) > std::abs(std::log(worst.ratio)) || worst.period == 0.0)
      if (!std::isnan(ratio)) worst = {periods[k], ratio};
  }
  return worst;
}

void print_table(const std::vector<loading::SuiteRow>& rows, const Target& target) {
  const std::vector<std::string> names = loading::suite_intensities();
  std::size_t width = 6;
  for (const loading::SuiteRow& row : rows) width = std::max(width, row.listed.name.size());
  std::string text = fmt::format("{:{}}", "record", width);
  for (const std::string& name : names)
    text += fmt::format("  {:>12}", fmt::format("{}, {}", name, loading::intensity_named(name)->unit));
  for (const loading::SuiteRow& row : rows) {
    text += fmt::format("\n{:{}}", printable(row.listed.name, std::string::npos), width);
    for (const double value : row.values) text += fmt::format("  {:>12.4g}", value);
    if (row.listed.h2.empty()) text += "  one component";
  }
  text += "\nRotD50 of the records as they are, without the factors of the list\n";
  const Misfit worst = target.empty() ? Misfit{} : largest_misfit(rows, target);
  if (worst.period > 0.0)
    text += fmt::format("the median of the suite is farthest from the target at {:.3g} s: {:.3g} times it\n",
                        worst.period, worst.ratio);
  std::cout << text;
}

nlohmann::ordered_json suite_json(const std::vector<loading::SuiteRow>& rows, const Target& target) {
  const std::vector<std::string> names = loading::suite_intensities();
  nlohmann::ordered_json records = nlohmann::ordered_json::array();
  for (const loading::SuiteRow& row : rows) {
    nlohmann::ordered_json record{{"name", row.listed.name}, {"event", row.listed.event}};
    for (std::size_t k = 0; k < names.size(); ++k) record[names[k]] = row.values[k];
    record["SA"] = row.spectrum;
    records.push_back(std::move(record));
  }
  const loading::SuiteSpectrum suite = loading::spectrum_of(rows);
  nlohmann::ordered_json json{{"ok", true},
                              {"component", "rotd50"},
                              {"periods", loading::suite_periods()},
                              {"median", suite.median},
                              {"p16", suite.low},
                              {"p84", suite.high},
                              {"records", records}};
  const Misfit worst = target.empty() ? Misfit{} : largest_misfit(rows, target);
  if (worst.period > 0.0) json["misfit"] = {{"period", worst.period}, {"ratio", worst.ratio}};
  return json;
}

/// Only what this command has written is replaced without being asked to.
void write_spectra(const SuiteArguments& arguments, const std::string& text) {
  check_can_write(arguments.spectra);
  if (file_exists(arguments.spectra) && !arguments.force &&
      !read_file(arguments.spectra).starts_with("period_s,median_m_s2")) {
    Diagnostic diagnostic;
    diagnostic.where.file = arguments.spectra.string();
    diagnostic.found = "a file that is no table of spectra";
    diagnostic.expected = "another file, or --force to replace it";
    throw InputError(std::move(diagnostic));
  }
  write_file_atomically(arguments.spectra, text);
}

}  // namespace

void show_suite(const SuiteArguments& arguments) {
  const Target target = arguments.target.empty() ? Target{} : loading::read_target_spectrum(arguments.target);
  const std::vector<loading::SuiteRow> rows = loading::measure_suite(arguments.list);
  if (!arguments.spectra.empty()) write_spectra(arguments, loading::suite_spectra_csv(rows, target));
  if (arguments.as_json) return print_json(suite_json(rows, target));
  print_table(rows, target);
  if (!arguments.spectra.empty()) std::cout << "spectra: " << arguments.spectra.string() << "\n";
}

}  // namespace keyblock::app
