#include "statistics/fragility_table.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace keyblock::statistics {

namespace {

/// Intensities that differ by less than this share are one stripe.
constexpr double same_intensity = 1e-9;

Stripe runs_at_rest(std::span<const Observation> runs) {
  Stripe stripe;
  std::set<int> clusters;
  for (const Observation& run : runs) {
    if (run.intensity > 0.0) continue;
    stripe.runs += 1.0;
    stripe.exceeded += run.exceeded ? 1.0 : 0.0;
    clusters.insert(run.cluster);
  }
  stripe.clusters = static_cast<double>(clusters.size());
  return stripe;
}

/// Without runs.
std::vector<Stripe> empty_stripes(std::span<const Observation> runs) {
  std::vector<double> intensities;
  for (const Observation& run : runs)
    if (run.intensity > 0.0) intensities.push_back(run.intensity);
  std::sort(intensities.begin(), intensities.end());
  std::vector<Stripe> stripes;
  for (const double x : intensities)
    if (stripes.empty() || x > stripes.back().intensity * (1.0 + same_intensity))
      stripes.push_back({x, 0.0, 0.0, 0.0});
  return stripes;
}

}  // namespace

FragilityTable tabulate(std::span<const Observation> runs) {
  FragilityTable table;
  table.at_rest = runs_at_rest(runs);
  table.stripes = empty_stripes(runs);
  std::vector<std::set<int>> clusters(table.stripes.size());
  for (const Observation& run : runs) {
    if (!(run.intensity > 0.0)) continue;
    const auto after = std::upper_bound(table.stripes.begin(), table.stripes.end(), run.intensity,
                                        [](double x, const Stripe& s) { return x < s.intensity; });
    const auto stripe = static_cast<std::size_t>(after - table.stripes.begin()) - 1;
    const FragilityPart part{stripe, 1.0, run.exceeded ? 1.0 : 0.0};
    table.stripes[stripe].runs += part.runs;
    table.stripes[stripe].exceeded += part.exceeded;
    clusters[stripe].insert(run.cluster);
    table.clusters[run.cluster].push_back(part);
    table.records[run.record].push_back(part);
    table.pairs[{run.cluster, run.record}].push_back(part);
  }
  for (std::size_t k = 0; k < clusters.size(); ++k)
    table.stripes[k].clusters = static_cast<double>(clusters[k].size());
  return table;
}

ShakenPairs shaken_pairs(const FragilityTable& table) {
  const std::size_t levels = table.stripes.size();
  ShakenPairs shaken;
  for (const auto& [key, parts] : table.pairs) {
    std::vector<int> exceeded(levels, -1);  // −1: was not run there
    for (const FragilityPart& part : parts)
      exceeded[part.stripe] = std::max(exceeded[part.stripe], part.exceeded > 0.0 ? 1 : 0);
    const auto first = static_cast<std::size_t>(std::ranges::find(exceeded, 1) - exceeded.begin());
    shaken.complete = shaken.complete && std::ranges::find(exceeded, -1) == exceeded.end();
    const bool goes_back =
        std::find(exceeded.begin() + static_cast<std::ptrdiff_t>(first), exceeded.end(), 0) != exceeded.end();
    shaken.not_monotone += goes_back ? 1 : 0;
    shaken.pairs.push_back({key.first, key.second, first});
  }
  return shaken;
}

}  // namespace keyblock::statistics
