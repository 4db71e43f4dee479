#include "study/expected.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace keyblock::study {
namespace {

constexpr std::array<const char*, 2> expected_names{"fallen_area_m2", "fallen_weight_n_m"};
/// Intensities that differ by less than this share are one.
constexpr double one_intensity = 1e-9;

/// Runs and the sum of their values at one intensity.
struct Sum {
  double x = 0.0, runs = 0.0, value = 0.0;
};

/// What runs that have something in common add to the sums: place and value.
using Share = std::vector<std::pair<std::size_t, double>>;

struct Sample {
  std::vector<Sum> sums;  ///< by intensity
  std::map<int, Share> rocks, records;
  std::map<std::pair<int, int>, Share> pairs;
};

struct Shaken {
  double x, value;
  int rock, record;
};

std::vector<Shaken> shaken_runs(const StudyData& study, const Summary& summary, const FragilityGroup& group,
                                const Measure& measure) {
  std::vector<Shaken> runs;
  std::map<std::string, int> records;
  for (const std::size_t c : group.combinations) {
    for (const std::size_t r : summary.combinations[c].runs) {
      const Measured m = measured(study, study.runs[r]);
      const double x = m.intensity[group.intensity], value = measure.of(*m.damage);
      const int record = records.try_emplace(m.record, static_cast<int>(records.size())).first->second;
      if (x > 0.0 && !std::isnan(value)) runs.push_back({x, value, study.runs[r].realization, record});
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Shaken& a, const Shaken& b) { return a.x < b.x; });
  return runs;
}

Sample sampled(const std::vector<Shaken>& runs) {
  Sample sample;
  for (const Shaken& run : runs) {
    if (sample.sums.empty() || run.x > sample.sums.back().x * (1.0 + one_intensity))
      sample.sums.push_back({run.x});
    const std::size_t place = sample.sums.size() - 1;
    sample.sums[place].runs += 1.0;
    sample.sums[place].value += run.value;
    sample.rocks[run.rock].emplace_back(place, run.value);
    sample.records[run.record].emplace_back(place, run.value);
    sample.pairs[{run.rock, run.record}].emplace_back(place, run.value);
  }
  return sample;
}

struct Expected {
  double below = 0.0, between = 0.0, beyond = 0.0;
  [[nodiscard]] double total() const { return (std::isnan(below) ? 0.0 : below) + between + beyond; }
};

Expected expected_of(const std::vector<Sum>& sums, const std::vector<Hazard>& hazards) {
  statistics::KnownPoints points;
  for (const Sum& s : sums) {
    if (!(s.runs > 0.0)) continue;
    points.intensity.push_back(s.x);
    points.value.push_back(s.value / s.runs);
  }
  Expected expected;
  if (points.intensity.empty()) return {0.0, statistics::not_a_number, 0.0};
  double weights = 0.0;
  for (const Hazard& hazard : hazards) weights += hazard.source.weight;
  for (const Hazard& hazard : hazards) {
    const statistics::PointsRate rate = statistics::rate_of_points(hazard.found.curve, points);
    const double weight = hazard.source.weight / weights;
    expected.below += weight * rate.below;
    expected.between += weight * rate.between;
    expected.beyond += weight * rate.beyond_low;
  }
  return expected;
}

template <class Key>
std::vector<double> totals_without(const Sample& sample, const std::map<Key, Share>& groups,
                                   const std::vector<Hazard>& hazards) {
  std::vector<double> totals;
  for (const auto& [key, share] : groups) {
    std::vector<Sum> sums = sample.sums;
    for (const auto& [place, value] : share) {
      sums[place].runs -= 1.0;
      sums[place].value -= value;
    }
    totals.push_back(expected_of(sums, hazards).total());
  }
  return totals;
}

ExpectedMeasure expected_measure(const StudyData& study, const Summary& summary, const Risk& risk,
                                 const FragilityGroup& group, const Measure& measure) {
  const Sample sample = sampled(shaken_runs(study, summary, group, measure));
  ExpectedMeasure found;
  found.measure = measure.name;
  found.values = group.values;
  if (sample.sums.empty()) {
    found.status = RiskStatus::no_curve;
    found.why = "no run was shaken";
    return found;
  }
  const Expected whole = expected_of(sample.sums, risk.hazards);
  statistics::LeftOut without{totals_without(sample, sample.rocks, risk.hazards), {}, {}};
  if (sample.records.size() > 1) {
    without.records = totals_without(sample, sample.records, risk.hazards);
    without.pairs = totals_without(sample, sample.pairs, risk.hazards);
  }
  found.value = statistics::two_way_interval(whole.total(), without, risk.confidence);
  if (!std::isnan(found.value.low)) found.value.low = std::max(0.0, found.value.low);
  found.below = whole.below;
  found.beyond = whole.beyond;
  if (!std::isnan(whole.below)) return found;
  found.status = RiskStatus::runs_too_strong;
  found.why =
      "more than this: below the weakest shaking that was run the measure does not fall faster than shaking "
      "gets more frequent";
  return found;
}

}  // namespace

std::vector<ExpectedMeasure> expected_measures(const StudyData& study, const Summary& summary,
                                               const Risk& risk) {
  std::vector<ExpectedMeasure> all;
  for (const FragilityGroup& group : summary.fragility) {
    if (group.intensity != risk.intensity || group.level != summary.fragility.front().level) continue;
    for (const char* name : expected_names)
      all.push_back(expected_measure(study, summary, risk, group, measures()[*find_measure(name)]));
  }
  return all;
}

}  // namespace keyblock::study
