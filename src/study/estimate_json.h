#pragma once
#include "core/checked_json.h"
#include "results/json_parts.h"
#include "statistics/interval.h"

namespace keyblock::study {

/// {"value", "low", "high"}, null where a number is not known.
inline nlohmann::ordered_json estimate_json(const statistics::Estimate& estimate) {
  return {{"value", results::number_or_null(estimate.value)},
          {"low", results::number_or_null(estimate.low)},
          {"high", results::number_or_null(estimate.high)}};
}

}  // namespace keyblock::study
