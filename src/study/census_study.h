#pragma once
#include <atomic>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "census/census.h"
#include "scenario/build.h"
#include "statistics/bootstrap.h"

/// The census of key blocks of many realizations: docs/guide/limits.md, "Key blocks".
namespace keyblock::study {

/// Of one realization.
struct RealizationCensus {
  int realization = 0;
  census::Census census;
  Vec2 origin;                                   ///< of its coordinates
  std::vector<std::string> names;                ///< of census.blocks, empty for cut blocks
  std::vector<std::vector<std::string>> joints;  ///< along which they slide
  std::string error;                             ///< why it could not be cut; empty: it was
};

/// What is gathered of a census.
struct CensusMeasure {
  const char* name;   ///< "area_m2_per_m"
  const char* title;  ///< "area per metre of wall"
  const char* unit;   ///< "m²/m"; empty for counts
  double (*of)(const census::Totals& totals, double wall);
};
const std::vector<CensusMeasure>& census_measures();

struct CensusStudy {
  double wanted_factor = 0.0, confidence = 0.95;
  std::vector<RealizationCensus> realizations;
  std::vector<statistics::Description> measures;  ///< as census_measures(); quantiles: summary_quantiles

  [[nodiscard]] std::size_t failed() const;
};

/// Of realizations 0 … count − 1, by so many threads, which change nothing. What cannot be cut is left out of the measures. `confidence` is
/// that of [study], or 0.95. Throws InputError of scenario::take_census, RunError when `stop` is set.
CensusStudy take_censuses(const scenario::Scenario& scenario, int count, double wanted_factor, int threads,
                          const std::atomic<bool>* stop = nullptr);

/// The member `over_realizations` of census.json.
nlohmann::ordered_json censuses_json(const CensusStudy& study);

/// census.csv: a row for each block that moves or needs a force for the wanted factor.
std::string census_csv(const std::vector<RealizationCensus>& realizations);

/// A census with the names that the scenario has for its blocks and joints.
RealizationCensus named_census(const scenario::Scenario& scenario, int realization,
                               const scenario::BlockModel& model, census::Census census);

}  // namespace keyblock::study
