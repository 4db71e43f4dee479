#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/rock_column.h"
#include "geometry/vec2.h"

/// What only some couplings are (Coupling::staged_supports, far_field, force_scale, still_water).
namespace keyblock::dynamics {

struct Drive;
struct Model;
struct State;

/// Supports that stages install.
class StagedSupports {
 public:
  virtual ~StagedSupports() = default;
  /// Puts bodies of their own where they belong, before the run.
  virtual void place(const Model& /*model*/, State& /*state*/) const {}
  /// They come to life, without force at the positions of the state. Bodies of their own are put where they belong. now: as State::installed, those that do.
  virtual void install(const Model& model, State& state, std::span<const std::uint8_t> now,
                       std::span<double> memory) const = 0;
  /// The stage is over that installed them: what was held while it lasted is held no more.
  virtual void end_stage(const Model& /*model*/, const State& /*state*/, std::span<double> /*memory*/) const {
  }
};

/// Rock far away, beside the model.
struct FarRock {
  RockColumn column;
  double x = 0.0;  ///< m, of the side of the model that it is beside
};

/// The ground where the model does not disturb it.
class FarField {
 public:
  virtual ~FarField() = default;
  /// How it moves at a place, which is one before the run.
  [[nodiscard]] virtual GroundMove far_ground(std::span<const double> memory, Vec2 place) const = 0;
  /// From left to right.
  [[nodiscard]] virtual std::span<const FarRock> far_rock() const = 0;
  /// Plane k of far rock `far`.
  [[nodiscard]] virtual RockPlaneState plane(std::span<const double> memory, std::size_t far,
                                             std::size_t k) const = 0;
};

/// Forces by which a model without gravity measures residuals.
class ForceScale {
 public:
  virtual ~ForceScale() = default;
  /// Raises what residuals of blocks are measured by, N over √A, to forces of its own.
  virtual void add_weights(const Model& model, const State& state, const Drive& drive,
                           std::span<double> weight) const = 0;
};

/// A force at a vertex of the surface.
struct VertexForce {
  int vertex = 0;
  Vec2 force;  ///< N per thickness
};

/// A place on an edge of the surface, before the run.
struct EdgePlace {
  int edge = 0;
  Vec2 place;
};

/// What water does to the blocks that move.
struct WaterTotals {
  bool acts = false;
  std::string name;               ///< of the water that acts; it may have none
  double largest_pressure = 0.0;  ///< Pa
  double wet = 0.0;               ///< m of edges
  double drained = 0.0;  ///< m of edges below its table that are dry: along openings, or as it has run out
  std::vector<std::pair<std::string, Vec2>> forces;  ///< N per thickness, by the names of its elements
};

/// Water in joints and around blocks.
class StillWater {
 public:
  virtual ~StillWater() = default;
  /// Pa, at places on edges, where they were before the run; 0 where it is dry. memory: empty before the first step.
  [[nodiscard]] virtual std::vector<double> pressures(const Model& model, const State& state,
                                                      std::span<const double> memory,
                                                      std::span<const EdgePlace> places) const = 0;
  /// On the wall of an excavation that is still closed.
  [[nodiscard]] virtual std::vector<VertexForce> wall_forces(const Model& model, const State& state,
                                                             std::span<const double> memory,
                                                             int excavation) const = 0;
  [[nodiscard]] virtual WaterTotals totals(const Model& model, const State& state,
                                           std::span<const double> memory) const = 0;
};

/// Of a model, with its memory in a state; null: there is none.
struct WaterOfModel {
  const StillWater* water = nullptr;
  std::span<const double> memory;
};
[[nodiscard]] WaterOfModel water_of(const Model& model, const State& state);

/// Of all couplings of a model.
void add_weights(const Model& model, const State& state, const Drive& drive, std::span<double> weight);

}  // namespace keyblock::dynamics
