#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "cutting/block_system.h"
#include "geometry/vec2.h"
#include "record/row_fields.h"

namespace keyblock::record {

/// By what a joint or an element breaks.
enum class BreakMode : std::uint8_t { tension = 0, shear = 1, opening = 2 };

/// The last of the modes.
constexpr BreakMode last_of(BreakMode /*any*/) {
  return BreakMode::opening;
}
inline std::string name_of(BreakMode mode) {
  constexpr const char* names[] = {"tension", "shear", "opening"};
  return names[static_cast<std::size_t>(mode)];
}

/// An event of breaking: a contact of a joint loses its bond, or all that slip and opening take from its strength; or an element ruptures.
struct BreakRecord {
  double time = 0.0;  ///< s of simulated time
  int stage = 0;
  long step = 0;  ///< of the run, over all stages
  BreakMode mode = BreakMode::tension;
  Vec2 position{};      ///< m; of an element, the middle between its ends
  double length = 0.0;  ///< m of joint that belongs to the contact; 0 of elements
  int block_a = 0, block_b = 0;
  cutting::EdgeKind kind = cutting::EdgeKind::free;  ///< of the joint
  std::int16_t index = 0;                            ///< which set, map or outline of this kind
  std::int32_t trace = -1;                           ///< which trace of it; −1: none
  std::int32_t element = -1;                         ///< that ruptured; −1: it was a joint

  [[nodiscard]] cutting::EdgeLabel label() const { return {kind, index, trace}; }
};

inline constexpr std::tuple break_fields{
    RowField{"time", "s", "simulated time", &BreakRecord::time},
    RowField{"stage", "1", "stage, from 0", &BreakRecord::stage},
    RowField{"step", "1", "step of the run", &BreakRecord::step},
    RowField{"mode", "1", "by what it broke", &BreakRecord::mode},
    RowField{"position", "m", "where", &BreakRecord::position},
    RowField{"length", "m", "of joint that belongs to the contact; 0 of elements", &BreakRecord::length},
    RowField{"block_a", "1", "block with the vertex, or of the first end; -1: none", &BreakRecord::block_a},
    RowField{"block_b", "1", "block with the edge, or of the last end; -1: none", &BreakRecord::block_b},
    RowField{"edge_kind", "1", "what the joint is a piece of", &BreakRecord::kind},
    RowField{"edge_index", "1", "which joint set, trace map or excavation of edge_kind", &BreakRecord::index},
    RowField{"trace", "1", "which trace of the set or map; -1: none", &BreakRecord::trace},
    RowField{"element", "1", "that ruptured; -1: it was a joint", &BreakRecord::element}};

/// What broke of one joint set, trace map, outline or element in one way, in all of the run.
struct BreakCount {
  cutting::EdgeKind kind = cutting::EdgeKind::free;
  BreakMode mode = BreakMode::tension;
  std::int16_t index = 0;
  std::int32_t element = -1;  ///< −1: it is a joint
  std::int64_t events = 0;
  double length = 0.0;             ///< m of joint
  double first = 0.0, last = 0.0;  ///< s of simulated time
  std::int32_t first_stage = 0, last_stage = 0;
};

/// Calls visit(name, value) for all numbers that files have of a count.
template <class Count, class Visit>
void visit_count(Count& count, const Visit& visit) {
  visit("edge_index", count.index);
  visit("element", count.element);
  visit("events", count.events);
  visit("length_m", count.length);
  visit("first_s", count.first);
  visit("first_stage", count.first_stage);
  visit("last_s", count.last);
  visit("last_stage", count.last_stage);
}

/// Counts one more.
void count_break(const BreakRecord& row, std::vector<BreakCount>& counts);

}  // namespace keyblock::record
