#pragma once
#include <optional>
#include <span>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "loading/time_table.h"
#include "model/model.h"
#include "model/state.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Displacement over time of a fixed block; empty tables: none.
struct FixedMotion {
  const loading::TimeTable& x;
  const loading::TimeTable& y;
};

/// Whether all fixed blocks make one motion: the same displacement at all times. True where there are none.
bool move_alike(std::span<const FixedMotion> fixed);

/// m and m/s: how the ground would move at a place, before the run, if the model were not there. Zero without a seismic boundary.
dynamics::GroundMove far_ground(const dynamics::Model& model, const dynamics::State& state, Vec2 place);

/// What damage is counted against: the fixed blocks that are moved, where all fixed blocks make one motion; else the ground far away. Where
/// there is neither, damage is counted in space.
class Base {
 public:
  Base(const RunSetup& setup, const dynamics::Model& model);

  /// m, since the start of the run, at a place before it.
  [[nodiscard]] Vec2 displacement(const dynamics::State& state, Vec2 place) const;
  /// m/s.
  [[nodiscard]] Vec2 velocity(const dynamics::State& state, Vec2 place) const;

 private:
  [[nodiscard]] Vec2 of_block(const std::vector<double>& coefficients) const;

  const dynamics::Model& model_;
  std::optional<std::size_t> block_;  ///< one of those that make the motion; empty: nothing moves
};

}  // namespace keyblock::simulation
