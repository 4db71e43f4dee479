#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "loading/suite_list.h"

/// What the records of a list are, as recorded and over their whole length.
namespace keyblock::loading {

struct SuiteRow {
  SuiteRecord listed;
  /// Of suite_intensities(): RotD50, where there are two horizontal components; else of the one that there is.
  std::vector<double> values;
  std::vector<double> spectrum;  ///< m/s², SA at suite_periods(), likewise
};
std::vector<std::string> suite_intensities();  ///< "PGA", …
std::vector<double> suite_periods();           ///< s

/// Throws InputError with the mistakes of all files.
std::vector<SuiteRow> measure_suite(const std::filesystem::path& list);

/// Of the spectra of a suite, period by period: exp of mean, and of mean ∓ standard deviation, of ln SA. One record: all alike.
struct SuiteSpectrum {
  std::vector<double> median, low, high;
};
SuiteSpectrum spectrum_of(const std::vector<SuiteRow>& rows);

/// Two columns: period in s, SA in m/s². Throws InputError for fewer than two rows and periods that do not ascend.
std::vector<std::pair<double, double>> read_target_spectrum(const std::filesystem::path& file);
/// Straight between its points in the logarithms of both; no number beyond them.
double target_at(const std::vector<std::pair<double, double>>& target, double period);

/// A row for each period: the suite, the target if there is one, and each record.
std::string suite_spectra_csv(const std::vector<SuiteRow>& rows,
                              const std::vector<std::pair<double, double>>& target);

}  // namespace keyblock::loading
