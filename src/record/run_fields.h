#pragma once
#include "record/record.h"
#include "record/record_file.h"

/// The record of a run: each field that is written as it is, described once. Places need the origin of the model; stages have a table of
/// their own (stage_fields.h).
namespace keyblock::record {

struct RunField {
  const char* name;  ///< in files
  RecordFile file = RecordFile::summary;
  const char* earlier = nullptr;  ///< its name in result.h5 of earlier versions, where it had another
  bool is_late = false;           ///< result.h5 of earlier versions does not have it
};

/// Calls visit(field, value) for each of them, const or not.
template <class Record, class Visit>
void visit_run(Record& r, const Visit& visit) {
  using enum RecordFile;
  visit(RunField{"steps"}, r.steps);
  visit(RunField{"wall_time_s", summary, "wall_time"}, r.wall_time);
  visit(RunField{"dof"}, r.dof);
  visit(RunField{"state_hash"}, r.state_hash);
  visit(RunField{"open_close"}, r.open_close);
  visit(RunField{"max_overlap_m", summary, "max_overlap"}, r.max_overlap.depth);
  visit(RunField{"max_area_change"}, r.max_area_change);
  visit(RunField{"energy"}, r.energy);
  visit(RunField{"made_ratio", page, nullptr, true}, r.made.ratio);
  visit(RunField{"made_time", result, nullptr, true}, r.made.time);
  visit(RunField{"interrupted"}, r.interrupted);
}

}  // namespace keyblock::record
