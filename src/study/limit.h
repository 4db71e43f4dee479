#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "statistics/interval.h"
#include "study/bisection.h"
#include "study/limit_criterion.h"
#include "study/run_result.h"

/// A limit: the value of a key of the scenario at which a criterion first holds.
namespace keyblock::study {

/// The key of the factor of safety.
inline constexpr const char* safety_key = "safety.strength_factor";
/// That of the yield coefficient.
inline constexpr const char* yield_key = "safety.k_h";

struct LimitRequest {
  std::string key;  ///< key path of a number
  double from = 0.0, to = 0.0;
  LimitCriterion criterion;
  std::string since;        ///< stage from whose end on the measure counts; empty: from the first excavation
  double tolerance = 0.02;  ///< width of the bracket over its larger end
  int realizations = 1;
  int scan = 0;               ///< parts of the way that are looked at before the bisection; 0: by the key
  bool finds_moving = false;  ///< from where on blocks move before the criterion holds is looked for, too
  /// Of the factor of safety over realizations: 1, so that each is known to be below or above it.
  [[nodiscard]] std::optional<double> decided_value() const {
    const bool is_within = std::min(from, to) <= 1.0 && std::max(from, to) >= 1.0;
    return key == safety_key && realizations > 1 && is_within ? std::optional(1.0) : std::nullopt;
  }
  [[nodiscard]] bool is_of_safety() const { return key == safety_key || key == yield_key; }
  bool has_rest = false;  ///< a rest until all is still follows the last stage (needs_rest)
  std::string of = {};    ///< of the factor of safety: of which joints it is; empty: of all
};

/// Parts of the way of a key that need not be monotone: the scale of a motion, and what a motion is made of. 1 for others.
int scan_of(const std::string& key);

/// A run at one value.
struct LimitTrial {
  double value = 0.0;
  std::string run;  ///< key of the run
  double measure = 0.0;
  record::Standing standing = record::Standing::stands;
  bool met = false;
  std::string state_hash;
  record::Movers movers = {};
  std::string heaviest = {};  ///< name of the heaviest of them; empty for cut blocks
  double pga = 0.0;           ///< m/s², of the stage that the key is of; 0: none
  double moving_area = 0.0;   ///< m², of blocks that move or have fallen

  /// Blocks fall or move.
  [[nodiscard]] bool goes() const;
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
  /// A trial at which the criterion does not hold, and blocks fall or move all the same: the one nearest to `from`.
  std::optional<LimitTrial> moves = {};
  /// Of a criterion with two ends: the trial from which on blocks do not stand. None: they stand in all of them.
  std::optional<LimitTrial> falls = {};
  double stands_to = 0.0;  ///< value of the trial next to it, in which they stand
  std::vector<std::pair<std::string, double>> strengths = {};  ///< that were drawn: RunResult::strengths

  [[nodiscard]] const LimitTrial* trial_at(double value) const;
  [[nodiscard]] bool found() const { return error.empty() && state.status == Bisection::Status::found; }
  /// As far as it is known: of a search that was stopped it is wider than asked.
  [[nodiscard]] bool is_bracketed() const {
    const bool is_on_the_way = state.status == Bisection::Status::open && !state.limits.empty();
    return error.empty() && (found() || is_on_the_way);
  }
  /// The middle of the bracket.
  [[nodiscard]] double limit() const { return 0.5 * (state.not_met + state.met); }
  [[nodiscard]] const LimitTrial* just_beyond() const { return found() ? trial_at(state.met) : nullptr; }
};

struct LimitResult {
  std::string title, scenario, version;
  std::uint64_t seed = 0;
  std::vector<std::string> overrides;
  LimitRequest request;
  std::string unit;                                         ///< of the key
  std::vector<std::pair<std::string, std::string>> ground;  ///< ground and loads: names and values
  std::vector<std::string> warnings;                        ///< of the scenario and the search
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

/// The trial of a run that is done.
LimitTrial limit_trial(const LimitRequest& request, double value, const RunResult& run);

/// limits.csv: a row for each realization, documented in docs/guide/limits.md.
std::string limit_csv(const LimitResult& result);

/// limit.json, documented in docs/guide/limits.md. It depends on the scenario and the request alone, not on workers or time.
std::string limit_json(const LimitResult& result);

}  // namespace keyblock::study
