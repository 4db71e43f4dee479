#pragma once
#include <vector>

#include "record/joint_records.h"

namespace keyblock::record {

/// Strengths that were drawn, as summary.json has them.
template <class Json>
Json strengths_json(const std::vector<DrawnStrength>& strengths) {
  Json rows = Json::array();
  for (const DrawnStrength& drawn : strengths)
    rows.push_back({{"joint", drawn.joint},
                    {"key", drawn.key},
                    {"unit", drawn.unit},
                    {"per", drawn.per},
                    {"traces", drawn.traces},
                    {"mean", drawn.mean},
                    {"std", drawn.std},
                    {"least", drawn.least},
                    {"largest", drawn.largest},
                    {"above_peak", drawn.capped}});
  return rows;
}

}  // namespace keyblock::record
