#pragma once
#include "record/record.h"
#include "record/record_file.h"

/// The record of a stage, each field described once: checkpoints, result.h5, summary.json, the report and Python have them from here.
namespace keyblock::record {

struct StageField {
  const char* name;  ///< in files; "equilibrium.reached" is `reached` of the object `equilibrium`
  const char* unit;  ///< SI; empty: none
  const char* meaning;
  RecordFile file = RecordFile::summary;
  const char* earlier = nullptr;  ///< its name in result.h5 of earlier versions, where it had another
  bool is_late = false;           ///< result.h5 of version 0.1 does not have it
};

/// Calls visit(field, value) for each field of a StageRecord, const or not.
template <class Record, class Visit>
void visit_stage(Record& r, const Visit& visit) {
  using enum RecordFile;
  const auto field = [&visit](const StageField& f, auto& value) { visit(f, value); };
  field({"name", "", "as in the scenario"}, r.stage.name);
  field({"kind", "", "settle, shake or rest"}, r.stage.kind);
  field({"excavate", "", "numbers of the excavations that it opens", page}, r.stage.excavate);
  field({"install", "", "names of the supports that come to life at its start", summary, nullptr, true},
        r.stage.install);
  field({"motion_index", "", "number of its motion; -1: none", result}, r.stage.motion);
  field({"given_duration", "s", "as in the scenario", result}, r.stage.duration);
  field({"max_steps", "", "as in the scenario", result}, r.stage.max_steps);
  field({"tolerance", "", "largest residual of a block over its weight at equilibrium", page},
        r.stage.tolerance);
  field({"steps", "", "that it took"}, r.steps);
  field({"start_time", "s", "of simulated time"}, r.start_time);
  field({"duration", "s", "of simulated time; static stages take none"}, r.duration);
  field({"planned_duration", "s", "what the duration is unless it is interrupted; null when static", page,
         nullptr, true},
        r.planned_duration);
  field({"scale", "", "factor on the motion, 1 in stages without"}, r.stage.scale);
  field({"k_h", "", "seismic coefficient of a static stage, to the right", summary, nullptr, true},
        r.stage.k_h);
  field({"k_v", "", "the same, up", summary, nullptr, true}, r.stage.k_v);
  field({"strength_factor", "", "what strength of joints is divided by in it", summary, nullptr, true},
        r.stage.strength_factor);
  field({"strength_of", "", "names of the joints that this is of; none: all", summary, nullptr, true},
        r.stage.strength_of);
  field({"pga_m_s2", "m/s2", "peak acceleration of the scaled motion in the section", summary, "pga"}, r.pga);
  field({"pgv_m_s", "m/s", "its peak velocity", summary, "pgv", true}, r.pgv);
  field({"arias_m_s", "m/s", "its Arias intensity", summary, "arias", true}, r.arias);
  field({"wall_time_s", "s", "that it took to compute", summary, "wall_time"}, r.wall_time);
  field({"interrupted", "", "it did not come to its end"}, r.interrupted);
  field({"still", "", "it ended before its duration, as nothing moved any more", summary, nullptr, true},
        r.still);
  field({"waits_for", "", "what it waits for before that may be; null: nothing", summary, nullptr, true},
        r.waits_for);
  field(
      {"equilibrium.reached", "", "every block that does not move balances", summary, "equilibrium_reached"},
      r.equilibrium_reached);
  field({"equilibrium.worst_residual_ratio", "", "largest ratio over blocks that are not moving", summary,
         "worst_residual_ratio"},
        r.worst_residual_ratio);
  field({"equilibrium.largest_way_m", "m", "of a block that is not moving, while it was out of balance",
         summary, "way", true},
        r.way);
  field({"equilibrium.largest_way_share", "", "the same, as a share of the block size", summary, "way_share",
         true},
        r.way_share);
  field({"equilibrium.unstable_block", "",
         "goes farthest where the equilibrium is not stable; none where it is", summary, "unstable_block",
         true},
        r.unstable_block);
  field({"equilibrium.moving", "", "blocks that move without bound", summary, "moving"}, r.moving);
  field({"standing", "", "how blocks are at its end; null: not known", summary, nullptr, true}, r.standing);
  field({"movers", "", "the blocks by which that is told", summary, nullptr, true}, r.movers);
  field({"largest_speed_m_s", "m/s", "of a block's centroid against the base at its end", summary,
         "largest_speed", true},
        r.largest_speed);
  field({"blocks_by_order", "", "blocks of each order that are there at its end, without fixed ones"},
        r.blocks_by_order);
  field({"release", "", "equilibria of excavations that are opened in parts", summary, nullptr, true},
        r.release);
  field({"damage", "", "measures since the first excavation"}, r.damage);
  field({"fallen", "", "blocks that have fallen by its end", summary, nullptr, true}, r.fallen);
  field({"motion_time", "s", "in the stage, of the motion as applied", result}, r.motion_time);
  field({"motion", "m/s2", "as applied, thinned to what a plot needs", result}, r.motion);
}

}  // namespace keyblock::record
