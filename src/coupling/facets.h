#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "coupling/rock_column.h"
#include "geometry/vec2.h"

/// What only some couplings are (Coupling::staged_supports, far_field, force_scale).
namespace keyblock::dynamics {

struct Drive;
struct Model;
struct State;

/// Supports that stages install.
class StagedSupports {
 public:
  virtual ~StagedSupports() = default;
  /// They come to life, without force at the positions of the state. now: as State::installed, those that do.
  virtual void install(const Model& model, const State& state, std::span<const std::uint8_t> now,
                       std::span<double> memory) const = 0;
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

/// Of all couplings of a model.
void add_weights(const Model& model, const State& state, const Drive& drive, std::span<double> weight);

}  // namespace keyblock::dynamics
