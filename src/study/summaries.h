#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "statistics/bootstrap.h"
#include "statistics/curves.h"
#include "statistics/fragility.h"
#include "study/dependence.h"
#include "study/measures.h"
#include "study/run_result.h"

/// What the runs of a study say together. Definitions, formulas and sources: docs/study-report.md.
namespace keyblock::study {

inline constexpr std::array<double, 5> summary_quantiles{0.05, 0.25, 0.5, 0.75, 0.95};
/// A run is marginal only where a variant changes its fallen area by more than this, m².
inline constexpr double smallest_marginal_area = 0.01;

/// What happened to a run between the ends of StudyData::since and StudyData::stage, and the strongest shaking.
struct Measured {
  std::optional<record::Damage> damage;  ///< none where the run failed or did not get there
  /// As intensities(): largest over the stages between. No number where a stage shakes whose record does not have it.
  std::array<double, intensity_count> intensity{};
  std::string record;  ///< of the stages between that shake, by name
};
Measured measured(const StudyData& study, const RunResult& run);

/// Places in intensities() of those that some run has.
std::vector<std::size_t> known_intensities(const StudyData& study);

/// yes: one variant is enough; no: all of StudyData::variants were measured, and none changes much; else unknown.
enum class Marginal { unknown, no, yes };

struct MeasureSummary {
  statistics::Description description;  ///< quantiles: summary_quantiles
  statistics::RunningMean running;      ///< by realization
  statistics::ExceedanceCurve exceedance;
};

struct LevelSummary {
  std::size_t n = 0;  ///< runs that have the measure
  std::size_t exceeded = 0;
  statistics::Estimate probability;
};

/// Damage until the end of StudyData::before, or after it.
struct DamagePart {
  std::vector<statistics::Description> measures;  ///< as measures(); quantiles: summary_quantiles
  std::vector<LevelSummary> levels;               ///< as StudyData::levels
  LevelSummary falls;                             ///< a block has fallen
};

/// All runs with the same value on every axis, variant "".
struct Combination {
  std::vector<std::string> values;  ///< as RunResult::values
  std::vector<std::size_t> runs;    ///< those measured: places in StudyData::runs, by realization
  std::size_t failed = 0;           ///< those with an error, or without the stage
  std::array<double, intensity_count>
      intensity{};                           ///< mean over the runs; all alike unless the motion varies
  std::optional<std::size_t> worst, median;  ///< runs with the largest and with the middle fallen area
  std::size_t checked = 0, marginal = 0;  ///< runs of which it is known, and those of them that are marginal
  std::vector<MeasureSummary> measures;   ///< as measures()
  std::vector<LevelSummary> levels;       ///< as StudyData::levels
  LevelSummary falls;                     ///< a block has fallen
  /// Of the same runs, until the end of StudyData::before and from there on; none without such a stage.
  std::optional<DamagePart> before, added;
  /// How far each measure of StudyData::levels hangs on the strengths that were drawn.
  struct OfMeasure {
    std::string measure;
    std::vector<Dependence> dependences;
  };
  std::vector<OfMeasure> hangs_on;
  std::size_t mapped = 0;  ///< runs with a map
  /// By cell of the grid: in how many of them its rock has fallen, and has fallen or loosened; −1 where all excavate it.
  std::vector<int> fallen, disturbed;
};

/// The combinations that differ in the shaking alone, as one curve.
struct FragilityGroup {
  std::size_t level = 0, intensity = 0;
  std::vector<std::string> values;        ///< empty text on the axes of the shaking
  std::vector<std::size_t> combinations;  ///< by intensity
  std::vector<statistics::Estimate>
      points;  ///< exceeded share at each stripe of the curve, Wilson's interval of as many draws as realizations
  statistics::FragilityCurve curve;
};

/// What came down in the control runs between the ends of StudyData::since and StudyData::stage, where nothing shook.
struct ControlSummary {
  std::size_t realizations = 0;  ///< with a control run; 0 in a study without any
  std::size_t falling = 0;       ///< of these, where more than `threshold` fell: gravity was not done
  double threshold = statistics::not_a_number;  ///< m²
};

struct Summary {
  std::vector<Combination> combinations;  ///< in the order of the axes, the last one running fastest
  /// By axis: all its keys are of stages or motions, and end in .scale or .motion or change an intensity. An axis that
  /// changes the rock as well is none.
  std::vector<bool> shaking_axis;
  std::vector<FragilityGroup>
      fragility;                    ///< by level, intensity, group; empty where no axis changes the shaking
  std::vector<Marginal> marginal;   ///< by run; that of variants is unknown
  std::vector<int> combination_of;  ///< by run; variants have that of their run, control runs −1
  ControlSummary control;
  std::size_t done = 0, failed = 0;  ///< all runs, variants too
};

/// Deterministic; 10,000 runs take seconds.
Summary summarize(const StudyData& study);

/// Parts of it. `groups` of fragility, and whether runs are marginal.
std::vector<FragilityGroup> fragility_groups(const StudyData& study, const Summary& summary);
/// Those of statistics, where the interval of θ is one of amplitudes.
statistics::FragilityLimits fragility_limits(const Intensity& intensity);
std::vector<Marginal> marginal_runs(const StudyData& study);

}  // namespace keyblock::study
