#pragma once
#include "cutting/block_system.h"

/// What cutting did, each number described once: summary.json, result.h5 and the report have them from here.
namespace keyblock::cutting {

struct CutField {
  const char* name;                     ///< in files
  const char* earlier = nullptr;        ///< its name in result.h5 of earlier versions, where it had another
  bool is_late = false;                 ///< result.h5 of version 0.1 does not have it
  bool has_a_place_of_its_own = false;  ///< in summary.json, beside what cutting did
};

/// Calls visit(field, value) for each number, const or not.
template <class Statistics, class Visit>
void visit_cutting(Statistics& s, const Visit& visit) {
  visit(CutField{"traces"}, s.traces);
  visit(CutField{"joints_used", nullptr, false, true}, s.joints_used);
  visit(CutField{"trace_length_m", "trace_length"}, s.trace_length);
  visit(CutField{"removed_length_m", "removed_length"}, s.removed_length);
  visit(CutField{"removed_pieces"}, s.removed_pieces);
  visit(CutField{"merged_slivers", nullptr, false, true}, s.merged_slivers);
  visit(CutField{"merged_vertices"}, s.merged_vertices);
  visit(CutField{"domain_area_m2", "domain_area", false, true}, s.domain_area);
  visit(CutField{"sliver_area_m2", "sliver_area"}, s.sliver_area);
  visit(CutField{"merged_across_joints", nullptr, true}, s.merged_across_joints);
  visit(CutField{"highest_tooth_m", "highest_tooth", true}, s.highest_tooth);
  visit(CutField{"slivers_left", nullptr, true}, s.slivers_left);
  visit(CutField{"bridge_length_m", nullptr, true}, s.bridge_length);
}

/// All of them, or those of the object `cutting` in summary.json.
template <class Json>
Json cutting_json(const CutStatistics& statistics, bool all) {
  Json json;
  visit_cutting(statistics, [&](const CutField& field, const auto& value) {
    if (all || !field.has_a_place_of_its_own) json[field.name] = value;
  });
  return json;
}

}  // namespace keyblock::cutting
