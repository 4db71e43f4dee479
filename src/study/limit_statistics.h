#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "statistics/interval.h"
#include "study/dependence.h"
#include "study/limit.h"

/// What the limits of many realizations say together, beside their quantiles.
namespace keyblock::study {

/// x̄ and s of the limits, and x̄ ∓ t s/√n with t of Student's distribution. A limit beyond an end of the search counts as that end: mean and deviation
/// are bounds then, and have no interval.
struct LimitMean {
  std::size_t n = 0;
  statistics::Estimate mean;
  double standard_deviation = statistics::not_a_number;
  bool at_least = false, at_most = false;
};
LimitMean mean_limit(const LimitResult& result);

/// In which share of the realizations the factor of safety is below 1, with Wilson's interval. Each search tries 1 (LimitRequest::decided_value).
struct FailureShare {
  std::size_t n = 0, below = 0;
  statistics::Estimate share;
};
/// None of another key than that of the factor of safety, of one realization, and where 1 is beyond the ends of the search.
std::optional<FailureShare> failure_share(const LimitResult& result);

/// How far the limits hang on each strength that was drawn.
std::vector<Dependence> dependences(const LimitResult& result);

/// statistics.csv: quantity, value, low, high.
std::string statistics_csv(const LimitResult& result);

}  // namespace keyblock::study
