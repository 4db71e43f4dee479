#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hazard/hazard_file.h"
#include "study/summaries.h"

/// How often a year each level of damage is exceeded: fragility curves of a study times hazard curves (statistics/rate.h).
namespace keyblock::study {

/// Of a file of hazard.
struct HazardSource {
  std::filesystem::path file;
  hazard::HazardOptions options;
  std::string component = "rotd50";  ///< of the horizontal shaking that the curve is of
  double weight = 1.0;               ///< among several curves of one intensity
};

struct RiskSettings {
  double lifetime = 50.0;  ///< a
  double sections = 1.0;   ///< of the structure, each with rock of its own, under the same earthquakes
  std::vector<HazardSource> hazards;
};

/// Reads a TOML file of settings. Throws InputError.
RiskSettings read_risk_settings(const std::filesystem::path& file);

/// A curve with what is asked of its file.
struct Hazard {
  HazardSource source;
  std::string hash;  ///< of the content of the file
  hazard::HazardFile found;
};

/// Reads the files of the settings. Throws InputError where they are of different intensities or components.
std::vector<Hazard> read_hazards(const RiskSettings& settings);

enum class RiskStatus {
  known,
  hazard_too_short,  ///< more than 5 % of the rate is from beyond the ends of the hazard curve
  runs_too_strong,  ///< more than 30 % of it is from shaking weaker than all runs: it hangs on the form of the curve
  step,             ///< the fragility curve is a step: the rate lies between the hazards at both sides of it
  upper_limit,  ///< no run exceeds the level: an upper limit alone
  no_curve,     ///< there is none, and so no rate
};
const char* name_of(RiskStatus status);

/// Of a level and a group of combinations that differ in their shaking alone.
struct LevelRisk {
  std::size_t group = 0;  ///< in Summary::fragility
  RiskStatus status = RiskStatus::no_curve;
  std::string why;            ///< what `status` means here; empty where it is known
  statistics::Estimate rate;  ///< a year, with its interval over rock masses and records
  double low_end = statistics::not_a_number,
         high_end = statistics::not_a_number;  ///< by what is beyond the ends of the hazard curve
  std::vector<double> by_hazard;               ///< curve by curve
  double share_below_runs = statistics::not_a_number, share_above_runs = statistics::not_a_number;
  /// The same rate from the points alone: straight in ln x between the intensities that were run, none below, between that of the strongest and
  /// certainty above.
  double points_low = statistics::not_a_number, points_high = statistics::not_a_number;
  double annual = statistics::not_a_number;  ///< probability that it is exceeded within a year
  double lifetime_poisson =
      statistics::not_a_number;  ///< within the lifetime, if rock changed from earthquake to earthquake
  double lifetime = statistics::not_a_number;  ///< where rock stays; not known without the split
  double p05 = statistics::not_a_number, p50 = statistics::not_a_number,
         p95 = statistics::not_a_number;  ///< rates over rock masses
  /// Rate at which at least one of the sections exceeds the level. Without the split its two bounds: all alike, and all apart.
  double sections_low = statistics::not_a_number, sections_high = statistics::not_a_number;
  /// Intensities below which 16, 50 and 84 % of the rate come from.
  double x16 = statistics::not_a_number, x50 = statistics::not_a_number, x84 = statistics::not_a_number;
};

/// Of a measure and a group: what is expected of it in a year.
struct ExpectedMeasure {
  std::string measure;
  std::vector<std::string> values;  ///< as FragilityGroup
  RiskStatus status = RiskStatus::known;
  std::string why;
  statistics::Estimate value;
  double below = 0.0, beyond = 0.0;  ///< parts from shaking weaker and stronger than that of all runs
};

struct Risk {
  std::vector<Hazard> hazards;
  std::size_t intensity = 0;  ///< in intensities()
  double lifetime = 0.0, sections = 1.0, confidence = 0.95;
  std::vector<LevelRisk> levels;
  std::vector<ExpectedMeasure> expected;
};

/// Throws InputError where the study has no intensity of the name and component of the hazard. `level`: one alone; empty: all.
Risk find_risk(const StudyData& study, const Summary& summary, const RiskSettings& settings,
               const std::string& level);

/// risk.json, risk.csv, and what a terminal shows. docs/risk.md.
std::string risk_json(const StudyData& study, const Summary& summary, const Risk& risk);
std::string risk_csv(const StudyData& study, const Summary& summary, const Risk& risk);
std::vector<std::string> risk_lines(const StudyData& study, const Summary& summary, const Risk& risk);

}  // namespace keyblock::study
