#include "study/census_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/checked_json.h"
#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "results/csv.h"
#include "results/json_parts.h"
#include "scenario/key_blocks.h"
#include "study/estimate_json.h"
#include "study/summaries.h"

namespace keyblock::study {
namespace {

using census::Totals;
using nlohmann::ordered_json;
using statistics::Estimate;

RealizationCensus census_of(const scenario::Scenario& scenario, int realization, double wanted_factor) {
  try {
    const scenario::BlockModel model = scenario::build_blocks(scenario, realization);
    return named_census(scenario, realization, model, scenario::take_census(scenario, model, wanted_factor));
  } catch (const RunError& error) {
    RealizationCensus failed;
    failed.realization = realization;
    failed.error = error.what();
    return failed;
  }
}

std::vector<double> sample_of(const CensusStudy& study, const CensusMeasure& measure) {
  std::vector<double> sample;
  for (const RealizationCensus& one : study.realizations) {
    if (one.error.empty()) sample.push_back(measure.of(census::totals(one.census), one.census.wall));
  }
  return sample;
}

ordered_json description_json(const statistics::Description& description) {
  ordered_json quantiles = ordered_json::array();
  for (std::size_t q = 0; q < description.quantiles.size(); ++q) {
    ordered_json quantile = estimate_json(description.quantiles[q]);
    quantile["p"] = summary_quantiles[q];
    quantiles.push_back(std::move(quantile));
  }
  return {{"mean", estimate_json(description.mean)},
          {"standard_deviation", estimate_json(description.standard_deviation)},
          {"min", results::number_or_null(description.min)},
          {"max", results::number_or_null(description.max)},
          {"quantiles", quantiles}};
}

}  // namespace

const std::vector<CensusMeasure>& census_measures() {
  static const std::vector<CensusMeasure> all{
      {"moving_blocks", "blocks that move", "", [](const Totals& t, double) { return 1.0 * t.moving; }},
      {"moving_area_m2", "their area", "m²", [](const Totals& t, double) { return t.area; }},
      {"first_layer_area_m2", "area of the first layer", "m²",
       [](const Totals& t, double) { return t.first_layer_area; }},
      {"blocks_per_m", "blocks per metre of wall", "1/m",
       [](const Totals& t, double wall) { return t.moving / wall; }},
      {"area_m2_per_m", "area per metre of wall", "m²/m",
       [](const Totals& t, double wall) { return t.area / wall; }},
      {"largest_area_m2", "area of the largest", "m²",
       [](const Totals& t, double) { return t.largest_area; }},
      {"largest_depth_m", "depth of the largest", "m",
       [](const Totals& t, double) { return t.largest_depth; }},
      {"deepest_m", "depth of the deepest", "m", [](const Totals& t, double) { return t.deepest; }},
      {"force_n_m", "forces for the wanted factor, added", "N/m",
       [](const Totals& t, double) { return t.force; }}};
  return all;
}

std::size_t CensusStudy::failed() const {
  return static_cast<std::size_t>(
      std::count_if(realizations.begin(), realizations.end(),
                    [](const RealizationCensus& one) { return !one.error.empty(); }));
}

RealizationCensus named_census(const scenario::Scenario& scenario, int realization,
                               const scenario::BlockModel& model, census::Census census) {
  RealizationCensus one{realization, std::move(census), model.system.origin, {}, {}, {}};
  for (const census::KeyBlock& key : one.census.blocks) {
    one.names.push_back(scenario::block_name(scenario, model, key.block));
    one.joints.push_back(scenario::sliding_joints(scenario, key));
  }
  return one;
}

CensusStudy take_censuses(const scenario::Scenario& scenario, int count, double wanted_factor, int threads,
                          const std::atomic<bool>* stop) {
  CensusStudy study;
  study.wanted_factor = wanted_factor;
  if (scenario.study) study.confidence = scenario.study->confidence;
  study.realizations.resize(at(count));
  ThreadTeam team(std::min(threads, count));
  // Round by round, so that threads with quick realizations do not wait long and Ctrl-C is heard.
  const int round = 4 * team.size();
  for (int first = 0; first < count; first += round) {
    const int some = std::min(round, count - first);
    team.for_range(at(some), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const int realization = first + static_cast<int>(k);
        study.realizations[at(realization)] = census_of(scenario, realization, wanted_factor);
      }
    });
    if (stop != nullptr && stop->load()) throw RunError("interrupted");
  }
  const statistics::Resamples resamples(at(count) - study.failed());
  for (const CensusMeasure& measure : census_measures()) {
    std::vector<double> sample = sample_of(study, measure);
    std::sort(sample.begin(), sample.end());
    study.measures.push_back(statistics::describe(sample, summary_quantiles, resamples, study.confidence));
  }
  return study;
}

ordered_json censuses_json(const CensusStudy& study) {
  ordered_json measures, each = ordered_json::array(), failed = ordered_json::array();
  for (std::size_t m = 0; m < study.measures.size(); ++m)
    measures[census_measures()[m].name] = description_json(study.measures[m]);
  for (const RealizationCensus& one : study.realizations) {
    if (!one.error.empty()) {
      failed.push_back({{"realization", one.realization}, {"error", one.error}});
      continue;
    }
    const Totals sum = census::totals(one.census);
    ordered_json row{{"realization", one.realization}, {"wall_m", one.census.wall}};
    for (const CensusMeasure& measure : census_measures())
      row[measure.name] = measure.of(sum, one.census.wall);
    each.push_back(std::move(row));
  }
  return {{"realizations", study.realizations.size() - study.failed()},
          {"confidence", study.confidence},
          {"measures", measures},
          {"each", each},
          {"failed", failed}};
}

std::string census_csv(const std::vector<RealizationCensus>& realizations) {
  std::string text =
      "realization,block,name,layer,x,y,area_m2,depth_m,weight_n_m,mode,factor_of_safety,force_n_m,joints\n";
  for (const RealizationCensus& one : realizations) {
    for (std::size_t k = 0; k < one.census.blocks.size(); ++k) {
      const census::KeyBlock& key = one.census.blocks[k];
      if (!key.moves() && key.force == 0.0) continue;
      const Vec2 place = key.centroid + one.origin;
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", one.realization, key.block,
                          results::csv_field(one.names[k]), key.layer, place.x, place.y, key.area, key.depth,
                          key.weight, census::mode_name(key.removal.mode), key.removal.factor(), key.force,
                          results::csv_field(fmt::format("{}", fmt::join(one.joints[k], " "))));
    }
  }
  return text;
}

}  // namespace keyblock::study
