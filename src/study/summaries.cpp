#include "study/summaries.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/index.h"
#include "scenario/key_path.h"
#include "statistics/proportion.h"
#include "study/variant.h"

namespace keyblock::study {

namespace {

/// Places of values on their axes: combinations sort as the grid runs. A value that no axis has comes last.
std::vector<std::size_t> places(const StudyData& study, const RunResult& run) {
  std::vector<std::size_t> result;
  for (std::size_t a = 0; a < run.values.size(); ++a) {
    std::size_t place = 0;
    if (a < study.axes.size()) {
      const auto& values = study.axes[a].values;
      place =
          static_cast<std::size_t>(std::find(values.begin(), values.end(), run.values[a]) - values.begin());
    }
    result.push_back(place);
  }
  return result;
}

/// The resamples for each size of sample, drawn once.
class ResampleStore {
 public:
  const statistics::Resamples& of(std::size_t n) { return store_.try_emplace(n, n).first->second; }

 private:
  std::map<std::size_t, statistics::Resamples> store_;
};

void choose_worst_and_median(const StudyData& study, Combination& c) {
  if (c.runs.empty()) return;
  std::vector<std::size_t> order = c.runs;
  const auto rank = [&](std::size_t r) {
    const record::Damage d = *measured(study, study.runs[r]).damage;
    return std::tuple(d.fallen_area, d.loosened_area, d.slip_max_ever, -study.runs[r].realization);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  c.worst = order.back();
  c.median = order[(order.size() - 1) / 2];
}

using Damages = std::vector<record::Damage>;

/// Of those that have the measure, in their order.
std::vector<double> values_of(const Measure& measure, const Damages& damages) {
  std::vector<double> values;
  for (const record::Damage& d : damages) {
    const double value = measure.of(d);
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

LevelSummary counted(const DamageLevel& level, const Damages& damages, double confidence) {
  LevelSummary summary;
  if (const auto measure = find_measure(level.measure)) {
    const std::vector<double> values = values_of(measures()[*measure], damages);
    summary.n = values.size();
    for (const double value : values)
      if (value > level.threshold) ++summary.exceeded;
  }
  summary.probability = statistics::proportion(summary.exceeded, summary.n, confidence);
  return summary;
}

LevelSummary counted_falls(const Damages& damages, double confidence) {
  return counted({"", "fallen_blocks", 0.0}, damages, confidence);
}

std::vector<LevelSummary> counted_levels(const StudyData& study, const Damages& damages) {
  std::vector<LevelSummary> levels;
  for (const DamageLevel& level : study.levels) levels.push_back(counted(level, damages, study.confidence));
  return levels;
}

/// What is counted of the runs of a combination.
Damages damages_of(const StudyData& study, const Combination& c) {
  Damages damages;
  for (const std::size_t r : c.runs)
    if (const auto damage = measured(study, study.runs[r]).damage) damages.push_back(*damage);
  return damages;
}

/// What happened to them between the ends of two stages.
Damages damages_between(const StudyData& study, const Combination& c, std::string_view since,
                        std::string_view stage) {
  Damages damages;
  for (const std::size_t r : c.runs)
    if (const auto damage = damage_between(study.runs[r], since, stage)) damages.push_back(*damage);
  return damages;
}

void describe_measures(const StudyData& study, ResampleStore& store, Combination& c) {
  const Damages damages = damages_of(study, c);
  for (const Measure& measure : measures()) {
    std::vector<double> values = values_of(measure, damages);
    MeasureSummary summary;
    summary.running = statistics::running_mean(values, study.confidence);
    std::sort(values.begin(), values.end());
    summary.description =
        statistics::describe(values, summary_quantiles, store.of(values.size()), study.confidence);
    summary.exceedance = statistics::exceedance_curve(values, study.confidence);
    c.measures.push_back(std::move(summary));
  }
  c.levels = counted_levels(study, damages);
  c.falls = counted_falls(damages, study.confidence);
}

DamagePart described_part(const StudyData& study, const Damages& damages, ResampleStore& store) {
  DamagePart part;
  for (const Measure& measure : measures()) {
    std::vector<double> values = values_of(measure, damages);
    std::sort(values.begin(), values.end());
    part.measures.push_back(
        statistics::describe(values, summary_quantiles, store.of(values.size()), study.confidence));
  }
  part.levels = counted_levels(study, damages);
  part.falls = counted_falls(damages, study.confidence);
  return part;
}

void part_at_shaking(const StudyData& study, ResampleStore& store, Combination& c) {
  if (study.before.empty()) return;
  c.before = described_part(study, damages_between(study, c, "", study.before), store);
  if (study.before != study.since) {
    c.added = described_part(study, damages_between(study, c, study.before, study.stage), store);
    return;
  }
  c.added.emplace();
  c.added->levels = c.levels;
  c.added->falls = c.falls;
  for (const MeasureSummary& m : c.measures) c.added->measures.push_back(m.description);
}

void find_dependences(const StudyData& study, Combination& c) {
  for (const DamageLevel& level : study.levels) {
    const auto measure = find_measure(level.measure);
    if (!measure ||
        std::ranges::find(c.hangs_on, level.measure, &Combination::OfMeasure::measure) != c.hangs_on.end())
      continue;
    std::vector<const Strengths*> strengths;
    std::vector<double> values;
    for (const std::size_t r : c.runs) {
      const auto damage = measured(study, study.runs[r]).damage;
      const double value = damage ? measures()[*measure].of(*damage) : statistics::not_a_number;
      if (std::isnan(value)) continue;
      strengths.push_back(&study.runs[r].strengths);
      values.push_back(value);
    }
    std::vector<Dependence> found = dependences(strengths, values, study.confidence);
    if (!found.empty()) c.hangs_on.push_back({level.measure, std::move(found)});
  }
}

void count_cells(const StudyData& study, Combination& c) {
  using record::BlockStatus;
  if (study.grid.columns <= 0 || study.grid.rows <= 0) return;
  const std::size_t cells = at(study.grid.columns) * at(study.grid.rows);
  std::vector<int> rock(cells, 0);
  c.fallen.assign(cells, 0);
  c.disturbed.assign(cells, 0);
  for (const std::size_t r : c.runs) {
    const auto& map = study.runs[r].map;
    if (map.size() != cells) continue;
    ++c.mapped;
    for (std::size_t k = 0; k < cells; ++k) {
      rock[k] += map[k] != BlockStatus::excavated ? 1 : 0;
      c.fallen[k] += map[k] == BlockStatus::fallen ? 1 : 0;
      c.disturbed[k] += map[k] == BlockStatus::fallen || map[k] == BlockStatus::loosened ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < cells; ++k)
    if (rock[k] == 0) c.fallen[k] = c.disturbed[k] = -1;
}

void average_intensity(const StudyData& study, Combination& c) {
  for (const std::size_t r : c.runs) {
    const Measured m = measured(study, study.runs[r]);
    for (std::size_t k = 0; k < m.intensity.size(); ++k) c.intensity[k] += m.intensity[k];
  }
  for (double& x : c.intensity)
    x = c.runs.empty() ? statistics::not_a_number : x / static_cast<double>(c.runs.size());
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && std::string_view(text).substr(text.size() - end.size()) == end;
}

/// Of several keys that vary together, too.
bool of_stages_and_motions(const std::vector<std::string>& keys) {
  return std::all_of(keys.begin(), keys.end(), [](const std::string& key) {
    const auto path = scenario::parse_key_path(key);
    return path && !path->empty() && (path->front().key == "stage" || path->front().key == "motion");
  });
}

/// See Summary::shaking_axis. Whether it changes an intensity: two combinations that differ on it alone differ in one.
std::vector<bool> shaking_axes(const StudyData& study, const std::vector<Combination>& combinations) {
  std::vector<bool> result;
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    const std::vector<std::string> keys =
        study.axes[a].keys.empty() ? std::vector{study.axes[a].key} : study.axes[a].keys;
    if (!of_stages_and_motions(keys)) {
      result.push_back(false);
      continue;
    }
    bool shaking = std::any_of(keys.begin(), keys.end(), [](const std::string& key) {
      return ends_with(key, ".scale") || ends_with(key, ".motion");
    });
    std::map<std::vector<std::string>, std::array<double, intensity_count>> seen;
    for (const Combination& c : combinations) {
      if (shaking || c.runs.empty() || a >= c.values.size()) continue;
      std::vector<std::string> others = c.values;
      others[a].clear();
      const auto& first = seen.try_emplace(others, c.intensity).first->second;
      for (std::size_t k = 0; k < first.size(); ++k)
        shaking = shaking || std::abs(first[k] - c.intensity[k]) > 1e-6 * std::max(first[k], c.intensity[k]);
    }
    result.push_back(shaking);
  }
  return result;
}

}  // namespace

namespace {

/// Without its control run nobody knows what the shaking did.
std::optional<record::Damage> counted_damage(const StudyData& study, const RunResult& run) {
  if (!study.control || !run.variant.empty()) return damage_between(run, study.since, study.stage);
  const auto control = study.control_of.at(static_cast<std::size_t>(&run - study.runs.data()));
  if (control < 0) return std::nullopt;
  return damage_beyond(run, study.runs[static_cast<std::size_t>(control)], study.since, study.stage);
}

/// To the larger of both. What a stage that shakes does not know, nobody knows of the run.
void raise(double& largest, double x, record::StageKind kind) {
  if (!std::isnan(x))
    largest = std::max(x, largest);
  else if (kind == record::StageKind::shake)
    largest = statistics::not_a_number;
}

}  // namespace

std::vector<std::size_t> known_intensities(const StudyData& study) {
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < intensities().size(); ++k) {
    const bool is_known = std::ranges::any_of(study.runs, [&](const RunResult& run) {
      return std::ranges::any_of(
          run.stages, [&](const StageMeasures& stage) { return !std::isnan(stage.*(intensities()[k].of)); });
    });
    // Those in the section are known of any motion.
    if (is_known || intensities()[k].component == "section") known.push_back(k);
  }
  return known;
}

Measured measured(const StudyData& study, const RunResult& run) {
  Measured result;
  result.damage = counted_damage(study, run);
  if (!result.damage) return result;
  for (const StageMeasures& stage : run.stages) {
    for (std::size_t k = 0; k < result.intensity.size(); ++k)
      raise(result.intensity[k], stage.*(intensities()[k].of), stage.kind);
    if (!stage.record.empty()) result.record += (result.record.empty() ? "" : ", ") + stage.record;
    if (stage.name == study.since) {
      result.intensity = {};
      result.record.clear();
    }
    if (stage.name == study.stage) break;
  }
  return result;
}

std::vector<Marginal> marginal_runs(const StudyData& study) {
  std::vector<Marginal> result(study.runs.size(), Marginal::unknown);
  if (!study.marginal) return result;
  std::map<std::pair<int, std::vector<std::string>>, std::size_t> own;
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    const RunResult& run = study.runs[r];
    if (run.variant.empty() && measured(study, run).damage) own[{run.realization, run.values}] = r;
  }
  std::vector<std::size_t> seen(study.runs.size(), 0);  // variants of a run that were measured
  for (const RunResult& run : study.runs) {
    if (run.variant.empty() || run.variant == unshaken_variant) continue;
    const Measured variant = measured(study, run);
    const auto found = own.find({run.realization, run.values});
    if (!variant.damage || found == own.end()) continue;
    const double a = damage_between(study.runs[found->second], study.since, study.stage)->fallen_area;
    const double b = variant.damage->fallen_area;
    const double change = std::abs(a - b);
    ++seen[found->second];
    if (change > study.marginal->share * std::max(a, b) && change > smallest_marginal_area)
      result[found->second] = Marginal::yes;
  }
  for (std::size_t r = 0; r < result.size(); ++r) {
    const bool all = seen[r] > 0 && seen[r] >= study.variants.size();
    if (all && result[r] == Marginal::unknown) result[r] = Marginal::no;
  }
  return result;
}

namespace {

/// See ControlSummary. What has fallen in a control run is judged by the level of fallen area with the lowest threshold.
ControlSummary control_summary(const StudyData& study) {
  ControlSummary summary;
  if (!study.control) return summary;
  for (const DamageLevel& level : study.levels)
    if (level.measure == "fallen_area_m2" && !(summary.threshold <= level.threshold))
      summary.threshold = level.threshold;
  if (std::isnan(summary.threshold)) summary.threshold = smallest_marginal_area;
  std::set<int> all, falling;
  for (const RunResult& run : study.runs) {
    if (run.variant != unshaken_variant) continue;
    const auto damage = damage_between(run, study.since, study.stage);
    if (!damage) continue;
    all.insert(run.realization);
    if (damage->fallen_area > summary.threshold) falling.insert(run.realization);
  }
  summary.realizations = all.size();
  summary.falling = falling.size();
  return summary;
}

/// The runs of the next combination: which count, and what is known of them.
void take_runs(const StudyData& study, const std::vector<std::size_t>& members, Summary& summary,
               Combination& c) {
  for (const std::size_t r : members) {
    summary.combination_of[r] = static_cast<int>(summary.combinations.size());
    if (!study.runs[r].variant.empty()) continue;
    if (measured(study, study.runs[r]).damage)
      c.runs.push_back(r);
    else
      ++c.failed;
    if (summary.marginal[r] != Marginal::unknown) ++c.checked;
    if (summary.marginal[r] == Marginal::yes) ++c.marginal;
  }
  std::stable_sort(c.runs.begin(), c.runs.end(), [&](std::size_t a, std::size_t b) {
    return study.runs[a].realization < study.runs[b].realization;
  });
}

}  // namespace

Summary summarize(const StudyData& study) {
  Summary summary;
  summary.marginal = marginal_runs(study);
  summary.combination_of.assign(study.runs.size(), -1);
  std::map<std::pair<std::vector<std::size_t>, std::vector<std::string>>, std::vector<std::size_t>> groups;
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    const RunResult& run = study.runs[r];
    if (run.variant != unshaken_variant) groups[{places(study, run), run.values}].push_back(r);
    const bool done = measured(study, run).damage.has_value();
    ++(done ? summary.done : summary.failed);
  }
  ResampleStore store;
  for (const auto& [key, members] : groups) {
    Combination c;
    c.values = key.second;
    take_runs(study, members, summary, c);
    average_intensity(study, c);
    choose_worst_and_median(study, c);
    describe_measures(study, store, c);
    part_at_shaking(study, store, c);
    find_dependences(study, c);
    count_cells(study, c);
    summary.combinations.push_back(std::move(c));
  }
  summary.control = control_summary(study);
  summary.shaking_axis = shaking_axes(study, summary.combinations);
  summary.fragility = fragility_groups(study, summary);
  return summary;
}

}  // namespace keyblock::study
