#include "study/precision.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "statistics/bootstrap.h"
#include "study/summaries.h"

namespace keyblock::study {

namespace {

bool narrow(const Precision& asked, const statistics::Estimate& mean) {
  const double width = mean.high - mean.low;
  const bool by_share = asked.half_width && 0.5 * width <= *asked.half_width * std::abs(mean.value);
  const bool by_width = asked.width && width <= *asked.width;
  return by_share || by_width;
}

}  // namespace

bool precise_enough(const StudyData& study) {
  if (!study.precision) return false;
  const auto measure = find_measure(study.precision->measure);
  if (!measure) throw std::invalid_argument("no measure of damage is called " + study.precision->measure);
  std::map<std::vector<std::string>, std::vector<double>> samples;
  for (const RunResult& run : study.runs) {
    const StageMeasures* stage = run.variant.empty() ? measured(study, run).stage : nullptr;
    if (stage != nullptr) samples[run.values].push_back(measures()[*measure].of(stage->damage));
  }
  std::map<std::size_t, statistics::Resamples> resamples;
  for (auto& [values, sample] : samples) {
    std::sort(sample.begin(), sample.end());
    const auto& draws = resamples.try_emplace(sample.size(), sample.size()).first->second;
    if (!narrow(*study.precision, statistics::describe(sample, {}, draws, study.confidence).mean))
      return false;
  }
  return !samples.empty();
}

}  // namespace keyblock::study
