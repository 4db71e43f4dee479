#include "study/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "record/before_shaking.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"
#include "scenario/override.h"
#include "scenario/parse.h"
#include "scenario/sections.h"
#include "scenario/shaking_axes.h"
#include "scenario/shaking_checks.h"
#include "study/rotation.h"
#include "study/variant.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;
using scenario::Scenario;

constexpr double most_runs = 1e6;
constexpr int key_digits = 10;

// Of what distinguishes the runs of one realization.
std::string combination_hash(const std::vector<std::string>& overrides, const std::string& variant) {
  std::vector<std::string> lines;
  for (const std::string& text : overrides) {
    const scenario::Override parsed = scenario::parse_override(text);
    std::string path;
    for (const scenario::PathSegment& segment : parsed.path) path = scenario::join_path(path, segment.key);
    lines.push_back(path + "=" + scenario::canonical_toml(parsed.value));
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return hash_text(text + "/" + variant).substr(0, key_digits);
}

std::string key_of(int realization, const std::string& hash) {
  return fmt::format("r{:04}-{}", realization, hash);
}

void add_files(const Scenario& scenario, std::map<fs::path, std::string>& files) {
  for (const fs::path& file : scenario::input_paths(scenario)) {
    if (!files.contains(file)) files[file] = hash_text(read_file(file));
  }
}

/// Unusual values that only some runs have.
void add_new(const Scenario& scenario, std::vector<std::string>& warnings) {
  std::vector<std::string> unusual;
  scenario::add_magnitude_warnings(scenario, unusual);
  for (std::string& text : unusual)
    if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(std::move(text));
}

// Reads every run of one realization, so that what it would refuse is refused now, and lists the files, the ground and the unusual
// values of all of them.
void read_all(const Scenario& base, Plan& plan, std::vector<std::string>* warnings) {
  std::map<fs::path, std::string> files;
  scenario::GroundFacts ground;
  add_files(base, files);
  scenario::read_combinations(plan.text, plan.scenario, plan.overrides, [&](const Scenario& scenario) {
    add_files(scenario, files);
    ground.add(scenario::ground_facts(scenario));
    if (warnings != nullptr) add_new(scenario, *warnings);
  });
  for (const auto& [path, hash] : files) plan.files.push_back({input_name(plan.scenario, path), hash});
  plan.ground = ground.merged();
}

void check_count(const Plan& plan, const Scenario& scenario, std::size_t variants) {
  double count = static_cast<double>(plan.realizations) * static_cast<double>(variants);
  for (const scenario::VarySpec& axis : plan.axes)
    count *= axis.per_realization
                 ? *axis.per_realization *
                       static_cast<double>(axis.of_block.value_or(static_cast<int>(axis.block)))
                 : static_cast<double>(axis.values.size());
  if (count <= most_runs) return;
  throw InputError(Diagnostic{scenario.where("study"), "study", fmt::format("{:.3g} runs", count),
                              fmt::format("at most {:.0e}", most_runs), ""});
}

// All combinations of one value per axis, the last axis changing fastest.
std::vector<std::vector<std::vector<std::string>>> combinations(const std::vector<scenario::VarySpec>& axes) {
  std::vector<std::vector<std::vector<std::string>>> all{{}};
  for (const scenario::VarySpec& axis : axes) {
    std::vector<std::vector<std::vector<std::string>>> longer;
    for (const auto& start : all) {
      for (const auto& value : axis.values) {
        longer.push_back(start);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

/// By axis: all its keys are scales of shaking after `since`, so that its values are alike where nothing shakes.
std::vector<bool> axes_of_scales(const Plan& plan, const Scenario& scenario) {
  std::vector<bool> result;
  for (const scenario::VarySpec& axis : plan.axes) {
    result.push_back(std::ranges::all_of(axis.keys, [&](const std::string& key) {
      const record::Stage* stage = scenario::stage_of_scale(scenario, key);
      return stage != nullptr && shakes_after(scenario, *stage, plan.since);
    }));
  }
  return result;
}

/// The runs of one realization, the keys without it.
class Realization {
 public:
  Realization(const Plan& plan, const Scenario& scenario)
      : plan_(plan), terms_(variant_terms(plan)), of_scales_(axes_of_scales(plan, scenario)) {}

  std::vector<PlannedRun> runs(const std::vector<std::string>& variants) {
    for (const auto& values : combinations(plan_.axes)) {
      const std::string control = plan_.control ? control_of(values) : "";
      for (const std::string& variant : variants) {
        runs_.push_back({"", 0, values, variant, true, variant.empty() ? control : ""});
        runs_.back().key = hash_of(runs_.back());
      }
    }
    return std::move(runs_);
  }

 private:
  std::string hash_of(const PlannedRun& run) const {
    return combination_hash(overrides_of(plan_, run), variant_identity(run.variant, terms_));
  }

  /// Its key; lists it where it is the first time that it is asked for.
  std::string control_of(std::vector<std::vector<std::string>> values) {
    for (std::size_t a = 0; a < values.size(); ++a) {
      if (of_scales_[a]) values[a].assign(values[a].size(), "0");
      if (!plan_.axes[a].unshaken.empty()) values[a] = plan_.axes[a].unshaken;
    }
    PlannedRun run{"", 0, std::move(values), unshaken_variant, true};
    run.key = hash_of(run);
    if (known_.insert(run.key).second) runs_.push_back(run);
    return run.key;
  }

  const Plan& plan_;
  VariantTerms terms_;
  std::vector<bool> of_scales_;
  std::vector<PlannedRun> runs_;
  std::set<std::string> known_;  ///< keys of control runs
};

/// Whether the realization has this run: its values are those of its turn.
bool is_its_turn(const Plan& plan, const PlannedRun& run, int realization) {
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const scenario::VarySpec& axis = plan.axes[a];
    if (!axis.per_realization) continue;
    const auto place =
        static_cast<std::size_t>(std::ranges::find(axis.values, run.values[a]) - axis.values.begin());
    const auto count = static_cast<std::size_t>(*axis.per_realization),
               i = static_cast<std::size_t>(realization);
    const std::size_t blocks = axis.values.size() / axis.block;
    const auto turn = turn_of(i, place / axis.block, blocks, count);
    if (!turn) return false;
    if (axis.of_block && !takes_level(i, *turn, blocks, place % axis.block, axis.block,
                                      static_cast<std::size_t>(*axis.of_block)))
      return false;
  }
  return true;
}

void list_runs(Plan& plan, const Scenario& scenario, const std::vector<std::string>& variants) {
  const std::vector<PlannedRun> all = Realization(plan, scenario).runs(variants);
  for (int realization = 0; realization < plan.realizations; ++realization) {
    std::set<std::string_view> controls;
    for (const PlannedRun& run : all)
      if (!run.control.empty() && is_its_turn(plan, run, realization)) controls.insert(run.control);
    for (const PlannedRun& run : all) {
      const bool is_control = run.variant == unshaken_variant;
      if (is_control ? !controls.contains(run.key) : !is_its_turn(plan, run, realization)) continue;
      plan.runs.push_back(run);
      plan.runs.back().realization = realization;
      plan.runs.back().key = key_of(realization, run.key);
      if (!run.control.empty()) plan.runs.back().control = key_of(realization, run.control);
    }
  }
}

/// The last stage before the shaking, where that is before the stage `measured`.
std::string stage_before_shaking(const Scenario& scenario, const std::string& measured) {
  const auto last = record::last_before_shaking(scenario.stages);
  if (!last) return {};
  for (std::size_t k = 0; k <= *last; ++k) {
    if (scenario.stages[k].name == measured) return {};
  }
  return scenario.stages[*last].name;
}

/// As Plan has it, which knows no default and has no word for the first excavation.
std::string planned_since(const std::string& asked, const std::string& before_shaking) {
  if (asked.empty()) return before_shaking;
  return asked == scenario::from_the_start ? "" : asked;
}

std::string no_release_warning(const Plan& plan) {
  return fmt::format(
      "study.marginal: no variant \"released\", as it leaves out the stage \"{}\", at whose end the measures "
      "begin; with study.since = \"{}\" there is one",
      plan.since, scenario::from_the_start);
}

/// Measures can only begin before they end.
void check_order(const scenario::Scenario& scenario, const Plan& plan) {
  if (plan.since.empty()) return;
  for (const record::Stage& stage : scenario.stages) {
    if (stage.name == plan.stage) {
      throw InputError(Diagnostic{scenario.where("study.since"), "study.since", '"' + plan.since + '"',
                                  "a stage before \"" + plan.stage + "\"", ""});
    }
    if (stage.name == plan.since) return;
  }
}

/// A control run is compared with one that is shaken.
void check_shakes(const Scenario& scenario, const Plan& plan) {
  for (const record::Stage& stage : scenario.stages) {
    if (shakes_after(scenario, stage, plan.since)) return;
    if (stage.name == plan.stage) break;
  }
  throw InputError(Diagnostic{scenario.where("study.control"), "study.control", "true where nothing shakes",
                              "a stage of kind \"shake\" between `since` and `stage`", ""});
}

}  // namespace

VariantTerms variant_terms(const Plan& plan) {
  return {plan.marginal.value_or(MarginalCheck{}), plan.since};
}

std::vector<std::ptrdiff_t> control_places(const Plan& plan) {
  std::map<std::string_view, std::ptrdiff_t> place;
  for (std::size_t k = 0; k < plan.runs.size(); ++k)
    if (plan.runs[k].variant == unshaken_variant) place[plan.runs[k].key] = static_cast<std::ptrdiff_t>(k);
  std::vector<std::ptrdiff_t> places;
  for (const PlannedRun& run : plan.runs) {
    const auto found = place.find(run.control);
    places.push_back(found == place.end() ? -1 : found->second);
  }
  return places;
}

std::string input_name(const fs::path& scenario, const fs::path& file) {
  return fs::absolute(file)
      .lexically_normal()
      .lexically_relative(fs::absolute(scenario).lexically_normal().parent_path())
      .string();
}

std::string hash_text(std::string_view content) {
  Hash hash;
  hash.add(content.data(), content.size());
  return fmt::format("{:016x}", hash.value());
}

std::string scenario_identity(const std::string& text, const fs::path& file,
                              const std::vector<std::string>& overrides) {
  return hash_text(scenario::to_toml(scenario::document_without_study(text, file, overrides)));
}

std::string run_key(int realization, const std::vector<std::string>& overrides, const std::string& variant) {
  return key_of(realization, combination_hash(overrides, variant));
}

std::vector<std::string> overrides_of(const Plan& plan, const PlannedRun& run) {
  std::vector<std::string> overrides;
  for (std::size_t a = 0; a < run.values.size(); ++a) {
    for (std::size_t j = 0; j < run.values[a].size(); ++j)
      overrides.push_back(plan.axes.at(a).keys.at(j) + "=" + run.values[a][j]);
  }
  return overrides;
}

std::size_t Plan::wanted() const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.wanted; }));
}

void keep_places(const std::vector<PlannedRun>& earlier, Plan& plan) {
  std::map<std::string, std::size_t> asked;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) asked[plan.runs[k].key] = k;
  std::vector<PlannedRun> all;
  std::vector<char> placed(plan.runs.size());
  for (const PlannedRun& run : earlier) {
    const auto found = asked.find(run.key);
    if (found == asked.end()) {
      all.push_back(run);
      all.back().wanted = false;
    } else {
      all.push_back(plan.runs[found->second]);
      placed[found->second] = 1;
    }
  }
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (!placed[k]) all.push_back(std::move(plan.runs[k]));
  }
  plan.runs = std::move(all);
}

ScenarioText read_scenario_text(const fs::path& file, std::vector<std::string> overrides) {
  return {read_file(file, scenario::largest_scenario), file, std::move(overrides)};
}

Plan make_plan(const fs::path& file, const std::vector<std::string>& overrides, const std::string& version,
               std::vector<std::string>* warnings) {
  return make_plan(read_scenario_text(file, overrides), version, warnings);
}

Plan make_plan(const ScenarioText& source, const std::string& version, std::vector<std::string>* warnings) {
  const auto& [text, file, overrides] = source;
  Plan plan;
  plan.scenario = file;
  plan.text = text;
  plan.overrides = overrides;
  plan.version = version;
  const Scenario scenario = scenario::parse_scenario_text(plan.text, file, overrides);
  if (scenario.stages.empty()) {
    throw InputError(Diagnostic{scenario.where("stage"), "stage", "nothing", "at least one [[stage]]", ""});
  }
  std::vector<std::string> notes = scenario::check_inputs(scenario);
  if (warnings != nullptr) {
    *warnings = std::move(notes);
    for (std::string& warning : scenario::study_warnings(scenario)) warnings->push_back(std::move(warning));
  }
  plan.input = scenario_identity(plan.text, file, overrides);
  plan.title = scenario.title;
  plan.seed = scenario.seed;
  const scenario::StudySpec study = scenario.study.value_or(scenario::StudySpec{});
  plan.until = study.until;
  plan.realizations = study.until ? study.until->maximum : study.realizations;
  plan.strata = scenario.strata;
  plan.axes = study.vary;
  for (scenario::VarySpec& axis : scenario::shaking_axes(scenario, warnings))
    plan.axes.push_back(std::move(axis));
  plan.stage = study.stage.empty() ? scenario.stages.back().name : study.stage;
  plan.before_shaking = stage_before_shaking(scenario, plan.stage);
  plan.since = planned_since(study.since, plan.before_shaking);
  check_order(scenario, plan);
  plan.levels = damage_levels(scenario);
  if (study.marginal) plan.marginal = MarginalCheck{study.marginal->friction, study.marginal->share};
  plan.confidence = study.confidence;
  plan.keep = study.keep;
  plan.grid = map_grid(scenario);
  for (const auto& spec : scenario.excavations) plan.outlines.push_back(scenario::excavation_outline(spec));
  const std::vector<std::string> variants =
      plan.marginal ? variants_of(scenario, {plan.stage, plan.since}) : std::vector<std::string>{""};
  if (warnings != nullptr && plan.marginal && variants.size() < variants_of(scenario, {plan.stage}).size())
    warnings->push_back(no_release_warning(plan));
  plan.control = study.control;
  if (plan.control) check_shakes(scenario, plan);
  check_count(plan, scenario, variants.size() + (plan.control ? 1 : 0));
  read_all(scenario, plan, warnings);
  list_runs(plan, scenario, variants);
  return plan;
}

}  // namespace keyblock::study
