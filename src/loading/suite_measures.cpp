#include "loading/suite_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/read_file.h"
#include "loading/intensity.h"
#include "loading/intensity_measures.h"
#include "loading/motion_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {
namespace {

constexpr std::size_t number_of_periods = 21;
constexpr double first_period = 0.04, last_period = 4.0;  // s
constexpr std::size_t largest_target = 1 << 20;           // bytes

MotionComponent single_component(const std::filesystem::path& file, std::optional<double> azimuth) {
  std::vector<MotionComponent> read = read_motion_file(file, {});
  if (read.size() != 1) {
    Diagnostic diagnostic;
    diagnostic.where.file = file.string();
    diagnostic.found = fmt::format("a file of {} components", read.size());
    diagnostic.expected = "a file for each component";
    throw InputError(std::move(diagnostic));
  }
  if (azimuth) read.front().azimuth = azimuth;
  return std::move(read.front());
}

/// Without directions: as if the second were to the east of the first. RotD50 does not hang on that.
GroundMotion pair_of(const SuiteRecord& record) {
  MotionComponent first = single_component(record.h1, record.azimuth1);
  MotionComponent second = single_component(record.h2, record.azimuth2);
  if (!first.azimuth || !second.azimuth) {
    first.azimuth = 0.0;
    second.azimuth = 90.0;
  }
  auto found = horizontal_pair({first, second});
  if (found) return std::move(*found);
  Diagnostic diagnostic;
  diagnostic.where.file = record.h2.string();
  diagnostic.found = fmt::format("a component along {:.4g}°", *second.azimuth);
  diagnostic.expected =
      fmt::format("one at right angles to the {:.4g}° of {}", *first.azimuth, record.h1.filename().string());
  throw InputError(std::move(diagnostic));
}

SuiteRow measured_row(const SuiteRecord& record) {
  SuiteRow row{record, {}, {}};
  std::optional<GroundMotion> both;
  std::vector<double> time, alone;
  if (record.h2.empty()) {
    const MotionComponent one = single_component(record.h1, record.azimuth1);
    for (std::size_t k = 0; k < one.acceleration.size(); ++k) time.push_back(one.time(k) - one.time(0));
    alone = one.acceleration;
  } else {
    both = pair_of(record);
  }
  const auto value = [&](const std::string& text) {
    const IntensityName name = intensity_named(text).value();
    return both ? intensity_of(*both, name, DirectionRule::rotd50) : intensity_along(time, alone, name);
  };
  for (const std::string& name : suite_intensities()) row.values.push_back(value(name));
  for (const double period : suite_periods()) row.spectrum.push_back(value(fmt::format("SA({})", period)));
  return row;
}

}  // namespace

std::vector<std::string> suite_intensities() {
  return {"PGA", "PGV", "PGD", "IA", "CAV", "RSD575", "RSD595"};
}

std::vector<double> suite_periods() {
  std::vector<double> periods;
  for (std::size_t k = 0; k < number_of_periods; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(number_of_periods - 1);
    periods.push_back(first_period * std::pow(last_period / first_period, share));
  }
  return periods;
}

std::vector<SuiteRow> measure_suite(const std::filesystem::path& list) {
  std::vector<SuiteRow> rows;
  std::vector<Diagnostic> mistakes;
  for (const SuiteRecord& record : read_suite_list(list)) {
    try {
      rows.push_back(measured_row(record));
    } catch (const InputError& error) {
      mistakes.insert(mistakes.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return rows;
}

SuiteSpectrum spectrum_of(const std::vector<SuiteRow>& rows) {
  SuiteSpectrum found;
  const auto n = static_cast<double>(rows.size());
  for (std::size_t k = 0; k < number_of_periods; ++k) {
    double sum = 0.0, squares = 0.0;
    for (const SuiteRow& row : rows) sum += std::log(row.spectrum[k]);
    const double mean = sum / n;
    for (const SuiteRow& row : rows) squares += std::pow(std::log(row.spectrum[k]) - mean, 2.0);
    const double deviation = rows.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;
    found.median.push_back(std::exp(mean));
    found.low.push_back(std::exp(mean - deviation));
    found.high.push_back(std::exp(mean + deviation));
  }
  return found;
}

std::vector<std::pair<double, double>> read_target_spectrum(const std::filesystem::path& file) {
  const MotionText text(file.string(), read_file(file, largest_target));
  std::vector<std::pair<double, double>> target;
  for (std::size_t line = 0; line < text.size(); ++line) {
    const std::string_view row = text.line(line);
    const bool is_number = !row.empty() && row.find_first_of("0123456789.") == 0;
    if (!is_number && target.empty()) continue;  // comments and names of columns
    if (row.empty()) continue;
    const std::vector<double> numbers = text.numbers(line, 2, 0, "a period and SA");
    if (!(numbers[0] > (target.empty() ? 0.0 : target.back().first)) || !(numbers[1] > 0.0))
      text.fail(line, "a period above the one before, and SA above 0");
    target.emplace_back(numbers[0], numbers[1]);
  }
  if (target.size() < 2) text.refuse("fewer than two points", "a period in s and SA in m/s² in each line");
  return target;
}

double target_at(const std::vector<std::pair<double, double>>& target, double period) {
  for (std::size_t k = 1; k < target.size(); ++k) {
    const auto [t0, a0] = target[k - 1];
    const auto [t1, a1] = target[k];
    if (period >= t0 && period <= t1)
      return a0 * std::pow(a1 / a0, std::log(period / t0) / std::log(t1 / t0));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string suite_spectra_csv(const std::vector<SuiteRow>& rows,
                              const std::vector<std::pair<double, double>>& target) {
  std::string text = "period_s,median_m_s2,p16_m_s2,p84_m_s2,target_m_s2";
  for (const SuiteRow& row : rows) {
    std::string name = row.listed.name;
    for (std::size_t k = name.find('"'); k != std::string::npos; k = name.find('"', k + 2))
      name.insert(k, 1, '"');
    text += name.find_first_of(",\"") == std::string::npos ? "," + name : ",\"" + name + '"';
  }
  const SuiteSpectrum suite = spectrum_of(rows);
  const std::vector<double> periods = suite_periods();
  for (std::size_t k = 0; k < periods.size(); ++k) {
    const double wanted = target_at(target, periods[k]);
    text += fmt::format("\n{:.6g},{:.6g},{:.6g},{:.6g},{}", periods[k], suite.median[k], suite.low[k],
                        suite.high[k], std::isnan(wanted) ? "" : fmt::format("{:.6g}", wanted));
    for (const SuiteRow& row : rows) text += fmt::format(",{:.6g}", row.spectrum[k]);
  }
  return text + "\n";
}

}  // namespace keyblock::loading
