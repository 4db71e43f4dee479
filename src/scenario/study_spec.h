#pragma once
#include <optional>
#include <string>
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

struct StudySpec {
  int realizations = 1;
  bool latin_hypercube = false;  ///< of what is drawn once in each realization
  std::vector<VarySpec> vary;
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
