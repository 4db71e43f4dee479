#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "statistics/rate.h"

/// Hazard curves as the programs that compute them write them.
namespace keyblock::hazard {

/// What a file does not say, and which of its sites is meant.
struct HazardOptions {
  std::optional<std::pair<double, double>> site = {};  ///< longitude and latitude, degrees
  std::string intensity = {};                          ///< "PGA", "PGV", "SA(0.3)"; empty: that of the file
  std::string unit = {};                               ///< of a table: "g", "m/s2", "cm/s2", "m/s" or "cm/s"
  std::optional<double> investigation_time = {};  ///< of a table of probabilities, a; none: they are rates
  /// Of messages: where the options stand.
  std::string from = {};
};

struct HazardFile {
  std::string intensity;          ///< as OpenQuake names it: "PGA"
  statistics::HazardCurve curve;  ///< m/s² or m/s, rates a year
};

/// Reads a hazard curve. The kind of the file is told by what is in it:
///
/// - OpenQuake's `hazard_curve-mean-PGA_12.csv`: a line of comment with kind, investigation_time and imt; then lon, lat, depth and
///   poe-LEVEL, a site in each row. λ = −ln(1 − poe)/T. Accelerations are in g, velocities in cm/s.
/// - JSON of the hazard service of the USGS: `response.hazards[].metadata.imt.value` with `data[]` of component Total, or the older
///   `response[].metadata` with `xvalues` and `data[].yvalues`. Annual rates; accelerations in g, velocities in cm/s.
/// - A table of two columns: intensity, and annual rate or probability.
///
/// Points with a probability of 0.9999 and more are left out, as six digits do not hold their rate. Zeros at the end are cut off, and the
/// first of them is where the hazard ends.
///
/// Throws InputError for anything else, intensities that do not ascend, rates that rise, fewer than three points above 0, a site that is
/// farther than 0.01° from all of the file, fractiles, and a unit that does not fit the intensity.
HazardFile read_hazard(const std::filesystem::path& file, const HazardOptions& options);

/// m/s² or m/s in one of the unit; none where it is no unit of that intensity.
std::optional<double> unit_of(const std::string& intensity, const std::string& unit);

}  // namespace keyblock::hazard
