#include "study/plan_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "study/measures.h"
#include "study/variant.h"

namespace keyblock::study {
namespace {

constexpr int most_strata = 1'000'000;
constexpr std::size_t least_realization_digits = 4, hash_digits = 10;
constexpr std::string_view known_variants[] = {"",         "friction-",   "friction+",
                                               "released", still_variant, unshaken_variant};

bool has_only(std::string_view text, std::string_view letters) {
  return text.find_first_not_of(letters) == std::string_view::npos;
}

// Whether runs have a value of every key. Those that are asked for no more may be of other axes.
bool fits_axes(const PlannedRun& run, const std::vector<scenario::VarySpec>& axes) {
  if (!run.wanted) return true;
  return std::equal(run.values.begin(), run.values.end(), axes.begin(), axes.end(),
                    [](const auto& row, const auto& axis) { return row.size() == axis.keys.size(); });
}

std::string mistake_in_run(const PlannedRun& run, const Plan& plan) {
  if (!is_run_key(run.key)) return fmt::format("the key \"{}\" of a run", run.key);
  if (run.realization < 0 || !run.key.starts_with(fmt::format("r{:04}-", run.realization)))
    return fmt::format("the run {} as one of realization {}", run.key, run.realization);
  if (std::find(std::begin(known_variants), std::end(known_variants), run.variant) ==
      std::end(known_variants))
    return fmt::format("the variant \"{}\" of a run", run.variant);
  return fits_axes(run, plan.axes) ? ""
                                   : fmt::format("values of the run {} that do not fit the axes", run.key);
}

bool is_grid(const MapGrid& grid) {
  if (grid.columns == 0 && grid.rows == 0) return true;
  return grid.columns > 0 && grid.rows > 0 && std::isfinite(grid.cell) && grid.cell > 0.0 &&
         static_cast<double>(grid.columns) * static_cast<double>(grid.rows) <= 4.0 * most_cells;
}

}  // namespace

bool is_run_key(const std::string& key) {
  const std::size_t dash = key.find('-');
  if (dash == std::string::npos || dash < 1 + least_realization_digits || key.front() != 'r') return false;
  const std::string_view number = std::string_view(key).substr(1, dash - 1),
                         hash = std::string_view(key).substr(dash + 1);
  return has_only(number, "0123456789") && hash.size() == hash_digits && has_only(hash, "0123456789abcdef");
}

std::string mistake_in(const Plan& plan) {
  std::set<std::string_view> keys;
  for (const scenario::VarySpec& axis : plan.axes) {
    const bool fits = std::all_of(axis.values.begin(), axis.values.end(),
                                  [&](const auto& row) { return row.size() == axis.keys.size(); });
    if (axis.keys.empty() || !fits) return "an axis whose values do not fit its keys";
  }
  for (const PlannedRun& run : plan.runs) {
    if (std::string found = mistake_in_run(run, plan); !found.empty()) return found;
    if (!keys.insert(run.key).second) return fmt::format("the run {} twice", run.key);
  }
  for (const DamageLevel& level : plan.levels)
    if (!find_measure(level.measure)) return fmt::format("the unknown measure \"{}\"", level.measure);
  if (plan.until && !find_measure(plan.until->measure))
    return fmt::format("the unknown measure \"{}\"", plan.until->measure);
  if (plan.strata < 0 || plan.strata > most_strata) return fmt::format("{} strata", plan.strata);
  if (!(plan.confidence > 0.0 && plan.confidence < 1.0))
    return fmt::format("a confidence of {}", plan.confidence);
  return is_grid(plan.grid) ? "" : "a map of too many cells";
}

}  // namespace keyblock::study
