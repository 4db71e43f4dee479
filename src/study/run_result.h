#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec2.h"
#include "record/record.h"

/// What a study keeps of its runs: small enough that ten thousand of them are read in seconds.
namespace keyblock::study {

/// A square raster around the openings, the same for all runs of a study; cells row by row from the lower left.
struct MapGrid {
  Vec2 corner;        ///< lower left, real coordinates, m
  double cell = 0.0;  ///< m
  int columns = 0, rows = 0;
};

/// The shaking of a stage and what had happened by its end. Measures are cumulative since the first excavation.
struct StageMeasures {
  std::string name;
  record::StageKind kind = record::StageKind::settle;
  double pga = 0.0;    ///< m/s², largest length of the scaled ground acceleration in the section
  double pgv = 0.0;    ///< m/s, the same of the ground velocity
  double arias = 0.0;  ///< m/s, sum of both components: π/(2g) ∫ a² dt
  record::Damage damage;
  record::Standing standing = record::Standing::stands;  ///< around openings, too
  record::Movers movers = {};
  std::string heaviest = {};  ///< name of the heaviest of them; empty for cut blocks
  std::string record = {};    ///< name of the ground motion; empty where nothing shakes
  /// RotD50 of the record, scaled (loading/intensity_measures.h); m/s², m/s. No numbers where that is not known.
  double pga_rotd50 = std::numeric_limits<double>::quiet_NaN();
  double pgv_rotd50 = std::numeric_limits<double>::quiet_NaN();
  double sa_03_rotd50 = std::numeric_limits<double>::quiet_NaN();
  double sa_10_rotd50 = std::numeric_limits<double>::quiet_NaN();
};

struct FallenBlock {
  int block = 0;
  std::string name;                  ///< empty for cut blocks
  int stage = 0;                     ///< in which it fell
  Vec2 centroid;                     ///< where it lay, real coordinates, m
  double area = 0.0;                 ///< m²
  double weight = 0.0, depth = 0.0;  ///< N per metre of tunnel, m behind the wall: record::FallenBlock
  record::WallPart part = record::WallPart::none;
};

/// One realization × one combination × one variant, when it has ended.
struct RunResult {
  std::string key;  ///< stable name of the run and of its folder: docs/studies.md
  int realization = 0;
  std::vector<std::string> values;  ///< TOML text of the value on every axis of the study, in their order
  std::string
      variant;  ///< of the sensitivity check: "" (the run itself), "friction-", "friction+", "released"; or "unshaken"
  std::string
      error;  ///< why it failed; empty when it is done. The rest below is then that of the stages that ended
  int blocks = 0;
  double block_size = 0.0;  ///< m, √ of the mean area of blocks that are not fixed
  long steps = 0;
  double wall_time = 0.0;  ///< s
  std::string state_hash;
  long unconverged_steps = 0;
  double max_overlap = 0.0;  ///< m
  double energy_residual_ratio = 0.0;
  /// Strengths that were drawn: name (record::DrawnStrength) and mean over the traces that bound blocks.
  std::vector<std::pair<std::string, double>> strengths = {};
  std::vector<StageMeasures> stages;
  std::vector<FallenBlock> fallen;
  /// Of every cell of the study's grid: where the rock that lay there is at the end.
  std::vector<record::BlockStatus> map;
};

/// An axis of the grid of a study: a [[study.vary]] table.
struct Axis {
  std::string key;                  ///< key path of what varies; of several, joined by " + "
  std::vector<std::string> values;  ///< TOML text
  std::vector<std::string> keys =
      {};  ///< those of an axis of several, one by one; empty: `key` is the only one
};

/// A level of damage to know the probability of: a measure (by its name in summary.json) above a threshold.
struct DamageLevel {
  std::string name;     ///< "light"
  std::string measure;  ///< "fallen_area_m2"
  double threshold = 0.0;
};

/// When a result is marginal: it changes by more than `share` of itself in a variant (run_result.h: RunResult::variant).
struct MarginalCheck {
  double friction = 3.0;  ///< degrees by which the friction angle of all joints is lowered and raised
  double share = 0.5;     ///< of the larger of both fallen areas
};

/// When enough realizations are there: the confidence interval of the mean of a measure is narrow enough in every
/// combination (until.h). Where both limits are given, one of them is enough.
struct Precision {
  std::string measure;               ///< by its name in summary.json
  std::optional<double> half_width;  ///< half the width is at most this share of the mean
  std::optional<double> width;       ///< the width is at most this, in the unit of the measure
  int minimum = 2;                   ///< realizations, before which nothing is enough
  bool reached = false;              ///< enough_realizations found some number to be enough
};

/// The runs that are there, with what a reader needs to group them.
struct StudyData {
  std::string title;
  std::uint64_t seed = 0;
  std::string version;
  std::vector<Axis> axes;
  std::string stage;  ///< at whose end the measures are compared: by default the last
  std::string since;  ///< what they were at the end of this stage is taken off; empty: nothing is
  /// At the end of which stage damage counts as there before: `since`, or else the last one before the shaking. Empty: none.
  std::string before;
  bool at_shaking =
      false;  ///< `before` is the last stage before the shaking: the shaking adds what comes after
  std::vector<DamageLevel> levels;
  std::optional<MarginalCheck> marginal;  ///< given when variants are run
  std::vector<std::string> variants;      ///< that are run of every case, without ""
  double confidence = 0.95;
  std::optional<Precision> precision;  ///< given when realizations are added until it is reached
  MapGrid grid;
  std::vector<std::vector<Vec2>> outlines;  ///< of the excavations, real coordinates
  /// What stands on the first screen of ground and loads: names and values (scenario/ground_facts.h).
  std::vector<std::pair<std::string, std::string>> ground;
  bool control = false;  ///< what shaken runs are counted by is what they have beyond their control runs
  /// Of each run, the place of its control run in `runs`; −1: it has none. Empty without control runs.
  std::vector<std::ptrdiff_t> control_of = {};
  std::vector<RunResult> runs;  ///< by realization, then combination, then variant
  std::size_t planned = 0;      ///< runs of the whole plan
};

}  // namespace keyblock::study
