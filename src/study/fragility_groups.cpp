#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "statistics/proportion.h"
#include "study/summaries.h"

namespace keyblock::study {

namespace {

/// Points of a drawn curve, evenly spaced in the logarithm of the intensity.
constexpr std::size_t curve_points = 61;
/// By what factor it is drawn beyond the weakest and the strongest shaking.
constexpr double beyond_last = 1.6;

struct Group {
  std::vector<std::string> values;
  std::vector<std::size_t> combinations;
};

std::vector<Group> grouped(const Summary& summary) {
  std::vector<Group> groups;
  std::map<std::vector<std::string>, std::size_t> place;
  for (std::size_t c = 0; c < summary.combinations.size(); ++c) {
    std::vector<std::string> values = summary.combinations[c].values;
    for (std::size_t a = 0; a < std::min(values.size(), summary.shaking_axis.size()); ++a)
      if (summary.shaking_axis[a]) values[a].clear();
    const auto [found, fresh] = place.try_emplace(values, groups.size());
    if (fresh) groups.push_back({values, {}});
    groups[found->second].combinations.push_back(c);
  }
  return groups;
}

/// Intensity to sort by; combinations without runs come last.
double strength(const Summary& summary, std::size_t combination, std::size_t intensity) {
  const double x = summary.combinations[combination].intensity[intensity];
  return std::isnan(x) ? HUGE_VAL : x;
}

std::vector<double> curve_grid(const std::vector<statistics::Observation>& runs) {
  double low = HUGE_VAL, high = 0.0;
  for (const auto& run : runs) {
    if (run.intensity > 0.0) low = std::min(low, run.intensity);
    high = std::max(high, run.intensity);
  }
  std::vector<double> grid;
  if (!(high > low)) return grid;
  low /= beyond_last;
  high *= beyond_last;
  for (std::size_t k = 0; k < curve_points; ++k)
    grid.push_back(low *
                   std::pow(high / low, static_cast<double>(k) / static_cast<double>(curve_points - 1)));
  return grid;
}

using Observations = std::vector<statistics::Observation>;

/// The runs of a group as a curve sees them, by intensity: those that have the measure. Where measures begin at the first excavation, a realization that has
/// no run without shaking is seen without it as well: as it was before the shaking.
Observations observed(const StudyData& study, const Summary& summary, const Group& group, std::size_t level,
                      std::size_t intensity) {
  const Measure& measure = measures()[*find_measure(study.levels[level].measure)];
  const double threshold = study.levels[level].threshold;
  const bool all_counts = study.since.empty() && !study.before.empty();
  Observations runs;
  std::set<int> seen;
  std::map<std::string, int> records;
  const auto add = [&](double x, const record::Damage& damage, int realization, const std::string& record) {
    const double value = measure.of(damage);
    const int place = records.try_emplace(record, static_cast<int>(records.size())).first->second;
    if (!std::isnan(value)) runs.push_back({x, value > threshold, realization, place});
  };
  for (const std::size_t c : group.combinations) {
    for (const std::size_t r : summary.combinations[c].runs) {
      const RunResult& run = study.runs[r];
      const Measured m = measured(study, run);
      const double x = m.intensity[intensity];
      if (std::isnan(x)) continue;
      add(x, *m.damage, run.realization, m.record);
      if (!all_counts || !seen.insert(run.realization).second || x == 0.0) continue;
      if (const auto before = damage_between(run, "", study.before))
        add(0.0, *before, run.realization, m.record);
    }
  }
  return runs;
}

}  // namespace

statistics::FragilityLimits fragility_limits(const Intensity& intensity) {
  statistics::FragilityLimits limits;
  limits.widest_theta = std::pow(limits.widest_theta, intensity.power);
  return limits;
}

std::vector<FragilityGroup> fragility_groups(const StudyData& study, const Summary& summary) {
  std::vector<FragilityGroup> result;
  if (std::find(summary.shaking_axis.begin(), summary.shaking_axis.end(), true) == summary.shaking_axis.end())
    return result;
  std::vector<Group> groups = grouped(summary);
  for (std::size_t l = 0; l < study.levels.size(); ++l) {
    if (!find_measure(study.levels[l].measure)) continue;
    for (const std::size_t i : known_intensities(study)) {
      for (Group& group : groups) {
        std::stable_sort(
            group.combinations.begin(), group.combinations.end(),
            [&](std::size_t a, std::size_t b) { return strength(summary, a, i) < strength(summary, b, i); });
        const Observations runs = observed(study, summary, group, l, i);
        FragilityGroup made{l, i, group.values, group.combinations, {}, {}};
        made.curve = statistics::fragility_curve(runs, curve_grid(runs), study.confidence,
                                                 fragility_limits(intensities()[i]));
        // Rock that is shaken twice at one intensity is not two independent pieces of rock.
        for (const statistics::Stripe& s : made.curve.stripes)
          made.points.push_back(
              statistics::share_of_independent(s.exceeded / s.runs, s.clusters, study.confidence));
        result.push_back(std::move(made));
      }
    }
  }
  return result;
}

}  // namespace keyblock::study
