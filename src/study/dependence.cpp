#include "study/dependence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "statistics/dependence.h"

namespace keyblock::study {

std::vector<Dependence> dependences(std::span<const Strengths* const> strengths,
                                    std::span<const double> numbers, double confidence) {
  std::vector<Dependence> found;
  if (strengths.empty()) return found;
  const Strengths& first = *strengths.front();
  for (std::size_t k = 0; k < first.size(); ++k) {
    std::vector<double> values;
    for (const Strengths* of_one : strengths)
      if (k < of_one->size() && (*of_one)[k].first == first[k].first) values.push_back((*of_one)[k].second);
    if (values.size() != numbers.size()) continue;
    found.push_back({first[k].first, statistics::rank_correlation(values, numbers, confidence),
                     statistics::first_order_index(values, numbers, confidence)});
  }
  std::erase_if(found, [](const Dependence& one) { return std::isnan(one.rank_correlation.value); });
  std::ranges::stable_sort(found, std::ranges::greater{},
                           [](const Dependence& one) { return std::abs(one.rank_correlation.value); });
  return found;
}

std::string strength_title(const std::string& name) {
  const std::size_t point = name.rfind('.');
  std::string key = name.substr(point + 1);
  std::ranges::replace(key, '_', ' ');
  return fmt::format("{} of “{}”", key, name.substr(0, point));
}

}  // namespace keyblock::study
