#pragma once
#include <span>

#include "geometry/vec2.h"

namespace keyblock::contact {

/// How far every block may move in a step.
struct StepMotion {
  std::span<const double> reach;  ///< m, per block, in the step
  /// rad, per block, in the step. At most `reach` over the radius of the block: clearances count on it.
  std::span<const double> turn;
  std::span<const double> away;  ///< m, per block: Candidates::away
  /// m, per block: length of the path of its vertices relative to its first vertex, since some time in the past. In each step the vertex
  /// counts that moved furthest.
  std::span<const double> path;
  /// m, per vertex: displacement in the step by the velocity, if nothing stops the vertex. When the step is attempted again: displacement
  /// in the attempt before. Empty: none.
  std::span<const Vec2> predicted = {};
  /// m, per block: the largest predicted displacement of a vertex relative to the first vertex.
  std::span<const double> predicted_path = {};
  std::span<const Vec2> first_predicted = {};  ///< `predicted` of the first attempt; empty: this is the first
};

}  // namespace keyblock::contact
