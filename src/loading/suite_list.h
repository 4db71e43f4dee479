#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Lists of records: which files belong together, and what is known of each record.
namespace keyblock::loading {

struct SuiteRecord {
  std::string name;
  std::filesystem::path h1, h2, up;  ///< h2 and up may be empty
  std::optional<double> azimuth1, azimuth2;
  std::string event;                                              ///< earthquake
  double scale = 1.0;                                             ///< factor of the selection
  std::optional<double> magnitude, distance, vs30, pulse_period;  ///< km, m/s, s
  std::size_t line = 0;                                           ///< of the list, from 1
};

/// Reads a list: a table with commas, whose first line names its columns (name, h1, h2, up, azimuth1, azimuth2, event, scale, magnitude,
/// distance_km, vs30_m_s, pulse_period_s; h1 is required, others are left out), or `_SearchResults.csv` as the database of PEER writes it. Paths are
/// from the folder of the list. Throws InputError with line and column for what is wrong, for files that are not there, records or files that occur twice, and rows
/// of which only some name their event.
std::vector<SuiteRecord> read_suite_list(const std::filesystem::path& file);

}  // namespace keyblock::loading
