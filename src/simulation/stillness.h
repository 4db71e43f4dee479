#pragma once
#include <vector>

#include "contact/surface.h"
#include "loading/ground_motion.h"
#include "record/stage.h"

namespace keyblock::simulation {

/// Whether a stage that ends when all is still has come to that: no vertex of a block that is there is farther than a distance from where it
/// was, for a time. What moves, slips or turns moves vertices. No stage is still before all is over that is planned (planned_changes.h).
class Stillness {
 public:
  /// All that is known from step to step.
  struct Memory {
    double since = 0.0;        ///< s, in the stage: when vertices were at `places`
    std::vector<Vec2> places;  ///< m, of the vertices of the surface; empty before the first step that counts
  };
  /// distance: m. time: s. begin: s, in the stage, before which nothing counts.
  Stillness(double distance, double time, double begin) : distance_(distance), time_(time), begin_(begin) {}

  /// After a step, at a time in the stage, s.
  bool is_still(const contact::Surface& surface, double time);

  [[nodiscard]] const Memory& memory() const { return memory_; }
  void restore(Memory memory) { memory_ = std::move(memory); }

 private:
  [[nodiscard]] bool stays(const contact::Surface& surface) const;

  double distance_, time_, begin_;
  Memory memory_;
};

/// s, time in a motion, of which `duration` is applied, after which its acceleration is weak: never above a twentieth of the largest, nor
/// above `least`, m/s².
[[nodiscard]] double end_of_shaking(const loading::GroundMotion& motion, double duration, double least);

}  // namespace keyblock::simulation
