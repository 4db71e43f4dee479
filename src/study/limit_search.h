#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/hold_map.h"
#include "study/limit.h"
#include "study/plan.h"
#include "study/workers.h"

namespace keyblock::study {

/// The plan of a limit, without runs yet: that of a study with the key as its one axis, and nothing else of [study] but `keep`,
/// `confidence` and the raster. The criterion of `request` is made of `until` (empty: that of the
/// model, limit_default) and `above`, its scan where it has none; its `since` is checked. Throws InputError for what is wrong with the
/// scenario, also with the key at both ends of the interval, and with the request.
Plan plan_limit(const ScenarioText& scenario, const std::string& version, LimitRequest& request,
                const std::string& until, std::optional<double> above);

/// A value of the key as TOML, with a point or an exponent: what must be an integer is no key for a bisection.
std::string limit_value_text(double value);

struct LimitOptions {
  WorkerOptions workers;
  bool resume = false;
  /// Told of every trial of a bisection, in its order, once it is known.
  std::function<void(const RealizationLimit&, const LimitTrial&)> trial = [](const RealizationLimit&,
                                                                             const LimitTrial&) {};
};

/// Runs the trials of all realizations until every bisection has ended, and leaves limit.json, limits.csv, report.html and, of one
/// realization whose rock moves, map.csv in the folder.
///
/// A round runs the next trial of every realization; where that is less than there are workers, also trials that may come after
/// it. Those have no say unless the bisection comes to them: the result is the same for any number of workers, and, as
/// trials are found again by their values, for a search that was killed and resumed. A run that fails ends the search of its
/// realization.
///
/// Returns what is known; `interrupted` says whether it was stopped. Throws what run_workers throws, and InputError as enter_limit does.
LimitResult find_limit(const std::filesystem::path& directory, Plan plan, const LimitRequest& request,
                       const LimitOptions& options, bool& interrupted);

/// The page of a limit: measure over value for all trials, the brackets, pictures of what happens just beyond, and up to where which rock holds. It
/// has no program, and asks nothing of the network.
std::string limit_page(const std::filesystem::path& directory, const LimitResult& result, const HoldMap& map);

}  // namespace keyblock::study
