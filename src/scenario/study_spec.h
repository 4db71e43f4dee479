#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// [study]: what `keyblock study` makes of a scenario. The meaning of every key: docs/scenario.md and docs/studies.md.
namespace keyblock::scenario {

/// One axis of the grid of a study: one key, or several that vary together.
struct VarySpec {
  std::vector<std::string> keys;  ///< key paths
  std::vector<std::vector<std::string>>
      values;  ///< of every key, as TOML: `keys[j]=values[k][j]` is an override
  /// How many of them each realization takes, in rotation (study/rotation.h); none: all.
  std::optional<int> per_realization = {};
  std::size_t block = 1;  ///< values that follow each other and are taken together: the levels of a record
  std::optional<int> of_block = {};  ///< how many of a block are taken, in rotation; none: all
  std::vector<std::string> unshaken =
      {};  ///< of an axis of records: its row in control runs; empty: it is none

  [[nodiscard]] std::string key_text() const;                 ///< the keys, joined by " + "
  [[nodiscard]] std::string value_text(std::size_t k) const;  ///< the values of place k, joined by ", "
};

/// Realizations are added until the confidence interval of the mean of a measure is narrow enough.
struct UntilSpec {
  std::string measure;
  std::optional<double> half_width;  ///< of the interval, as a share of the mean
  std::optional<double> width;       ///< of the whole interval, in the unit of the measure
  int minimum = 10, maximum = 1000;  ///< realizations
};

struct LevelSpec {
  std::string name, measure;
  double threshold = 0.0;
};

struct MarginalSpec {
  double friction = 3.0;  ///< degrees
  double share = 0.5;
};

/// What stays in the folder of a run beside its measures.
enum class Keep { all, report, measures };

/// StudySpec::since that asks for all that happened since the first excavation.
inline constexpr const char* from_the_start = "start";

/// Records of a suite, brought to levels of intensity.
struct ShakingSpec {
  int suite = -1;
  std::vector<std::string> stages;  ///< each with the same record
  std::string intensity = "PGA", component = "rotd50";
  std::vector<double> levels;  ///< of the intensity; or
  std::vector<double> scales;  ///< factors
  std::optional<int> per_realization, levels_per_record;
  std::pair<double, double> scale_limits{0.2, 5.0};
  std::string path;
};

struct StudySpec {
  int realizations = 1;
  bool latin_hypercube = false;  ///< of what is drawn once in each realization
  std::vector<VarySpec> vary;
  std::vector<ShakingSpec> shaking;
  std::string stage;  ///< at whose end measures are compared; empty: the last
  /// An earlier stage, at whose end they begin, or from_the_start; empty: the last one before the shaking.
  std::string since;
  double confidence = 0.95;
  std::optional<UntilSpec> until;
  std::vector<LevelSpec> levels;  ///< empty: defaults, see study::damage_levels
  std::optional<MarginalSpec> marginal;
  bool control = false;            ///< a run without shaking for each rock mass
  std::optional<double> map_cell;  ///< m
  Keep keep = Keep::report;
};

}  // namespace keyblock::scenario
