#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "record/damage_fields.h"
#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario/joint_table.h"
#include "scenario/key_path.h"
#include "scenario/parse.h"
#include "study/limit_search.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

constexpr double largest_tolerance = 0.5;
constexpr int most_scanned = 1000;  // parts

scenario::Scenario scenario_at(const Plan& plan, const LimitRequest& request, double value) {
  std::vector<std::string> overrides = plan.overrides;
  overrides.push_back(request.key + "=" + limit_value_text(value));
  return scenario::parse_scenario_text(plan.text, plan.scenario, overrides, scenario::StudyTable::leave_out);
}

/// What is odd at both ends of the search is so all over it; the rest belongs to the run in question. Throws InputError where an end is wrong.
std::vector<std::string> warnings_of_ends(const Plan& plan, const LimitRequest& request) {
  const auto warnings_at = [&](double end) {
    return scenario::check_inputs(scenario_at(plan, request, end));
  };
  std::vector<std::string> of_both = warnings_at(request.from);
  const std::vector<std::string> of_other = warnings_at(request.to);
  std::erase_if(of_both, [&](const std::string& warning) {
    return std::ranges::find(of_other, warning) == of_other.end();
  });
  return of_both;
}

void check_request(const LimitRequest& request) {
  for (const auto& [option, value] : {std::pair{"--from", request.from}, std::pair{"--to", request.to}}) {
    if (!std::isfinite(value)) refuse(option, fmt::format("{}", value), "a number");
  }
  if (request.from == request.to)
    refuse("--to", fmt::format("{}, as --from", request.to), "another value than --from");
  if (request.scan < 0 || request.scan > most_scanned)
    refuse("--scan", fmt::format("{}", request.scan), fmt::format("1 to {} parts", most_scanned));
  if (!(request.tolerance > 0.0 && request.tolerance <= largest_tolerance))
    refuse("--tolerance", fmt::format("{}", request.tolerance),
           fmt::format("above 0, at most {}", largest_tolerance));
}

/// A stage before the last one.
void check_since(const LimitRequest& request, std::span<const record::Stage> stages) {
  if (request.since.empty()) return;
  if (request.criterion.by_standing)
    refuse("--since", '"' + request.since + '"',
           "nothing, as " + request.criterion.name + " is how the blocks are at the end");
  std::vector<std::string> earlier;
  for (std::size_t k = 0; k + 1 < stages.size(); ++k) earlier.push_back(stages[k].name);
  if (std::ranges::find(earlier, request.since) != earlier.end()) return;
  refuse("--since", '"' + request.since + '"',
         earlier.empty() ? "nothing, as there is no stage before the last one"
                         : "a stage before the last one: " + scenario::list_words(earlier),
         scenario::suggestion(request.since, earlier));
}

/// A measure of elements is not known where none has a limit: it would never be above anything.
void check_measure(const LimitRequest& request, const scenario::Scenario& scenario) {
  const auto yields = [](const loading::Spring& spring) { return spring.yield.has_value(); };
  const auto gives_way = [](const scenario::BoltSpec& spec) {
    return spec.bolt.yield || spec.bolt.grout_strength || spec.bolt.dowel_strength;
  };
  const auto has_strength = [](const scenario::LinerSpec& spec) { return spec.liner.strength().has_value(); };
  if (std::ranges::any_of(scenario.springs, yields) || std::ranges::any_of(scenario.bolts, gives_way) ||
      std::ranges::any_of(scenario.liners, has_strength))
    return;
  record::for_damage_fields([&](const auto& field) {
    if (request.criterion.measure == field.name && field.column.table == record::DamageTable::elements)
      refuse("--until", '"' + request.criterion.measure + '"',
             "a measure that the scenario has: no [[spring]] or [[bolt]] has a yield, and no [[liner]] "
             "strengths");
  });
}

/// Of the factor of safety: nothing may give way, or no more than an area.
LimitCriterion criterion_of_safety(const scenario::SafetySpec& safety, const std::string& key) {
  const bool has_area = safety.area > 0.0;
  LimitCriterion criterion = has_area ? limit_criterion("moving_area_m2", safety.area, 0.0)
                                      : limit_criterion("gives_way", safety.moved, 0.0);
  criterion.why =
      key == yield_key
          ? "rock has given way that has moved since the coefficient acts, or that does not stand"
      : has_area ? "so much rock may move by [safety] area, in motion, after strength was reduced"
                 : "rock has given way that has moved since strength was reduced, or that does not stand";
  return criterion;
}

/// Whose strength is reduced, from when on, and what of the scenario does not come.
std::string what_is_reduced(const scenario::Scenario& scenario, const std::string& key) {
  const scenario::SafetySpec& safety = scenario.safety.value();
  std::string text =
      key == yield_key
          ? fmt::format("a horizontal seismic coefficient acts from the end of \"{}\" on", safety.stage)
          : fmt::format("strength of {} is reduced from the end of \"{}\" on",
                        safety.sets.empty() ? "all joints" : scenario::list_words(safety.sets, " and "),
                        safety.stage);
  std::vector<std::string> names;
  for (const record::Stage& stage : scenario.left_out) names.push_back(stage.name);
  if (!names.empty())
    text += fmt::format("; not run, with what {}: {}", names.size() == 1 ? "it does" : "they do",
                        scenario::list_words(names, " and "));
  return text;
}

/// That which is asked for, or else that of the key or of the model.
LimitCriterion chosen_criterion(const scenario::Scenario& scenario, const std::string& key,
                                const std::string& until, std::optional<double> above) {
  const double loosened = scenario.damage.loosened_distance;
  if (!until.empty()) return limit_criterion(until, above, loosened);
  if (key == safety_key || key == yield_key) {
    if (above)
      refuse("--above", fmt::format("{}", *above), "nothing, as [safety] moved and area are the thresholds");
    return criterion_of_safety(scenario.safety.value(), key);
  }
  const LimitDefault& row = limit_default(scenario);
  LimitCriterion criterion = limit_criterion(row.criterion, above, loosened);
  criterion.why = fmt::format("--until {} is the default for {}: {}", row.criterion, row.what, row.why);
  return criterion;
}

}  // namespace

std::string limit_value_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

Plan plan_limit(const ScenarioText& scenario, const std::string& version, LimitRequest& request,
                const std::string& until, std::optional<double> above) {
  check_request(request);
  std::vector<std::string> warnings;
  Plan plan = make_plan(scenario, version, &warnings);
  const scenario::Scenario read = scenario_at(plan, request, request.from);
  request.criterion = chosen_criterion(read, request.key, until, above);
  check_measure(request, read);
  if (request.is_of_safety()) {
    request.of = scenario::list_words(read.safety.value().sets, " and ");
    request.criterion.why += (request.criterion.why.empty() ? "" : "\n") + what_is_reduced(read, request.key);
  }
  request.has_rest = needs_rest(request.criterion, read);
  request.finds_moving =
      !request.criterion.by_standing && std::string_view(limit_default(read).criterion) != "fallen";
  if (request.scan == 0) request.scan = scan_of(request.key);
  if (request.realizations > 1 && read.joint_sets.empty() && !scenario::has_random_strengths(read))
    warnings.push_back(fmt::format(
        "--realizations {}: nothing is random, neither joint sets nor strengths; all limits are the same, "
        "and their interval says nothing",
        request.realizations));
  check_since(request, read.stages);
  for (std::string& warning : warnings_of_ends(plan, request)) {
    if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(std::move(warning));
  }
  // What shows only when blocks are cut and built.
  for (std::string& warning : scenario::build_setup(read, 0).warnings) {
    if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(std::move(warning));
  }
  plan.warnings = std::move(warnings);
  plan.realizations = request.realizations;
  if (plan.strata > 0) plan.strata = request.realizations;
  plan.axes = {{{request.key}, {}}};
  plan.since.clear();
  plan.before_shaking.clear();
  plan.levels.clear();
  plan.marginal.reset();
  plan.until.reset();
  plan.runs.clear();
  return plan;
}

}  // namespace keyblock::study
