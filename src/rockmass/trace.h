#pragma once
#include <cstdint>
#include <vector>

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
  int number =
      -1;  ///< which trace of its set or map it is a piece of; −1: it is a whole trace without a number
  /// Where the strengths of the trace are drawn (random_strength.h): its line and its interval on the line, which a larger window does not change.
  /// Of a map: 0, and the number.
  std::uint32_t line = 0, interval = 0;
};

/// For every piece the number of its trace, counted from 0. Pieces of one trace follow each other.
std::vector<int> trace_numbers(const std::vector<Trace>& pieces);

}  // namespace keyblock::rockmass
