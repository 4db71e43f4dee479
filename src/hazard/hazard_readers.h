#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hazard/hazard_file.h"

/// Readers of single formats: see hazard_file.h.
namespace keyblock::hazard {

/// A file in memory.
struct HazardText {
  std::string file, content;
  [[nodiscard]] std::vector<std::string_view> lines() const;
  /// line: from 1; 0: of the file as a whole.
  [[noreturn]] void fail(std::size_t line, const std::string& found, std::string expected,
                         std::string hint = {}) const;
};

/// What was read, before it is checked: rates of numbers in the unit of the file.
struct RawHazard {
  std::string intensity;
  std::vector<double> numbers, rates;
  std::vector<std::size_t> lines;  ///< of the points, from 1; empty: all are of line 0
  double unit = 1.0;               ///< m/s² or m/s in one of the unit
};

RawHazard read_openquake(const HazardText& text, const HazardOptions& options);
RawHazard read_usgs(const HazardText& text, const HazardOptions& options);
RawHazard read_table(const HazardText& text, const HazardOptions& options);

/// −ln(1 − p)/T; no number from 0.9999 on.
double rate_of_probability(double p, double years);

/// A finite number, or nothing.
std::optional<double> number_of(std::string_view text);
/// Fields between commas, blanks or tabs, without blanks at their ends.
std::vector<std::string_view> fields_of(std::string_view line, char separator);

}  // namespace keyblock::hazard
