#pragma once
#include <optional>
#include <string>
#include <vector>

#include "statistics/interval.h"
#include "study/bisection.h"
#include "study/run_result.h"

/// A limit: the value of a key of the scenario at which a criterion first holds.
namespace keyblock::study {

/// When a run is beyond the limit, told by how it is at the end of its last stage.
struct LimitCriterion {
  std::string name;     ///< as asked for: "fallen", "moved", "collapsed", or a measure
  std::string measure;  ///< by its name in summary.json; of "collapsed", what is told beside the verdict
  double above = 0.0;   ///< it holds when the measure is larger; in the unit of the measure
  bool collapse =
      false;  ///< it holds when the blocks do not stand (simulation/standing.h); `above` is then of no use

  /// `fallen area of more than 0.1 m²`.
  [[nodiscard]] std::string text() const;
};

/// `fallen`, `moved`, `collapsed` or the name of a measure. Without `above`: the `loosened` distance of the scenario, m, for
/// "moved", 0 for all others. Throws InputError.
LimitCriterion limit_criterion(const std::string& name, std::optional<double> above, double loosened);

struct LimitRequest {
  std::string key;  ///< key path of a number
  double from = 0.0, to = 0.0;
  LimitCriterion criterion;
  std::string since;        ///< stage from whose end on the measure counts; empty: from the first excavation
  double tolerance = 0.02;  ///< width of the bracket over its larger end
  int realizations = 1;
};

/// A run at one value.
struct LimitTrial {
  double value = 0.0;
  std::string run;  ///< key of the run
  double measure = 0.0;
  simulation::Standing standing = simulation::Standing::stands;
  bool met = false;
  std::string state_hash;
};

/// A quantile of the limits of all realizations.
struct LimitQuantile {
  double p = 0.0;
  statistics::Estimate limit;  ///< the ends of its interval are infinite where there are too few realizations
  /// The limit is a bound, as limits beyond the larger or the smaller end of the search have a part in it.
  bool at_least = false, at_most = false;
};

/// In which share of the realizations the criterion holds at a value of the key.
struct LimitShare {
  double value = 0.0;
  statistics::Estimate share;
};

/// What was found for one realization.
struct RealizationLimit {
  int realization = 0;
  Bisection::State state;
  std::vector<LimitTrial> trials;  ///< in the order of the bisection
  std::string error;               ///< why a trial failed; empty: none has

  [[nodiscard]] const LimitTrial* trial_at(double value) const;
  [[nodiscard]] bool found() const { return error.empty() && state.status == Bisection::Status::found; }
  /// The middle of the bracket.
  [[nodiscard]] double limit() const { return 0.5 * (state.not_met + state.met); }
};

struct LimitResult {
  std::string title, scenario, version;
  std::uint64_t seed = 0;
  std::vector<std::string> overrides;
  LimitRequest request;
  double confidence = 0.95;
  bool complete = false;  ///< every bisection has ended
  std::vector<RealizationLimit> realizations;

  /// Limits over realizations at 5, 25, 50, 75 and 95 %, with intervals by order statistics. A limit that lies beyond an end of the interval
  /// that was searched counts as that end. Not a number where none is known.
  [[nodiscard]] std::vector<LimitQuantile> quantiles() const;
  [[nodiscard]] LimitQuantile median() const;
  /// A limit as text: "≥ 60" for the larger end of the search, "≤ 5" for the smaller one, as limits beyond it count as that end.
  [[nodiscard]] std::string number_text(double limit) const;
  [[nodiscard]] std::string number_text(const LimitQuantile& quantile) const;
  /// A staircase from `from` to `to`, with Wilson's interval at each value by itself: `share` holds from `value` on. Empty where nothing is known.
  [[nodiscard]] std::vector<LimitShare> met_shares() const;
};

/// The trial of a run that is done. since: LimitRequest::since.
LimitTrial limit_trial(const LimitCriterion& criterion, const std::string& since, double value,
                       const RunResult& run);

/// limits.csv: a row for each realization, documented in docs/user-guide.md.
std::string limit_csv(const LimitResult& result);

/// limit.json, documented in docs/user-guide.md. It depends on the scenario and the request alone, not on workers or time.
std::string limit_json(const LimitResult& result);

/// What was found, for people: a line for each realization, the median, and what to try where there is no limit.
std::string limit_text(const LimitResult& result);

}  // namespace keyblock::study
