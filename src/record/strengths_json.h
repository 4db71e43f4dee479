#pragma once
#include <utility>
#include <vector>

#include "record/joint_records.h"

namespace keyblock::record {

/// Strengths that were drawn, as summary.json has them.
template <class Json>
Json strengths_json(const std::vector<DrawnStrength>& strengths) {
  Json rows = Json::array();
  for (const DrawnStrength& drawn : strengths) {
    Json row;
    visit_strength(drawn, [&](const char* name, const auto& value) { row[name] = value; });
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace keyblock::record
