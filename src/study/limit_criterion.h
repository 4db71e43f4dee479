#pragma once
#include <optional>
#include <span>
#include <string>

#include "scenario/scenario.h"
#include "study/run_result.h"

/// When a run is beyond a limit.
namespace keyblock::study {

/// Told by how the run is at the end of its last stage.
struct LimitCriterion {
  std::string name;     ///< as asked for: "fallen", "moved", "collapsed", "gives_way", or a measure
  std::string measure;  ///< by its name in summary.json; of "collapsed", what is told beside the verdict
  double above = 0.0;   ///< it holds when the measure is larger; in the unit of the measure
  std::optional<double> above_share = {};  ///< in the place of `above`: of the block size, of a measure in m
  bool by_measure = true;                  ///< it holds when the measure is larger
  bool by_standing = false;                ///< it holds when the blocks do not stand (record/standing.h)
  std::string why = {};                    ///< it is the default for this model; empty: it was asked for

  /// `fallen area of more than 0.1 m²`.
  [[nodiscard]] std::string text() const;
  /// Of a run that ended so (deciding_stage). What a static stage calls moving goes beyond any distance; blocks that rock come to rest.
  [[nodiscard]] bool is_met(double measured, double block_size, const StageMeasures& deciding) const;
  /// Whether from where on blocks do not stand is another question than from where on it holds.
  [[nodiscard]] bool has_two_ends() const { return by_measure && by_standing; }
};

/// The stage that tells how the blocks of a run are: the last one; or, where they stand at its end, the last static one, if that called blocks
/// moving. They may have slid a part of a way that has no end, and lie still.
const StageMeasures& deciding_stage(const RunResult& run);

/// `fallen`, `moved`, `collapsed`, `gives_way` or the name of a measure. Without `above`: the `loosened` distance of the scenario, m, for
/// "moved", a share of the block size for "gives_way", 0 for all others. Throws InputError.
LimitCriterion limit_criterion(const std::string& name, std::optional<double> above, double loosened);

/// What a scenario is a model of.
enum class LimitModel {
  structure,  ///< no [[excavation]]
  slope,      ///< one that reaches the edge of the rock
  tunnel,     ///< only such as lie within it
};
LimitModel limit_model(const scenario::Scenario& scenario);

/// How a scenario ends.
enum class LimitEnd {
  settled,    ///< its last stage is static
  in_motion,  ///< its last stage is dynamic, and nothing has shaken it
  shaken,     ///< its last stage is dynamic, and a motion has
};
LimitEnd limit_end(const scenario::Scenario& scenario);

/// Which criterion is that of a model, when none is asked for.
struct LimitDefault {
  LimitModel model;
  LimitEnd end;
  const char* what;
  const char* criterion;
  const char* why;
};
std::span<const LimitDefault> limit_defaults();
/// The row for a scenario, which has stages.
const LimitDefault& limit_default(const scenario::Scenario& scenario);

/// Whether the last stage may end while blocks still rock from shaking: whether they stand is then told after a rest until all is still
/// (variant.h).
bool needs_rest(const LimitCriterion& criterion, const scenario::Scenario& scenario);

}  // namespace keyblock::study
