#pragma once
#include "geometry/vec2.h"

namespace keyblock::rockmass {

/// Where a trace comes from: a joint set or a trace map, by its index in the scenario.
struct TraceSource {
  enum class Kind { joint_set, trace_map } kind = Kind::joint_set;
  int index = 0;
  friend constexpr bool operator==(TraceSource, TraceSource) = default;
};

/// One straight piece of a joint as seen in the section. A curved trace of a map is several pieces.
struct Trace {
  Vec2 a;
  Vec2 b;
  TraceSource source;
};

}  // namespace keyblock::rockmass
