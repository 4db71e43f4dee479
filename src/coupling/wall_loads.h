#pragma once
#include <vector>

#include "coupling/coupling.h"
#include "loading/time_table.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// A piece of the wall of an opening: of the edge from a vertex of the surface to the next, between two shares of it.
struct WallFace {
  int vertex = 0;
  double from = 0.0, to = 1.0;
};

/// A support pressure on some of the wall of an opening.
struct WallPressure {
  int excavation = 0;
  std::vector<WallFace> faces;
  loading::TimeTable factor;  ///< of WallState::pressure, over time; empty: 1
};

/// Forces on the walls of openings: a coupling of single blocks with nothing, by terms (docs/theory.md, section "Walls of openings"). Blocks
/// that have left their wall feel none.
///
///   - *Dead loads*: what the excavated rock did, WallState::forces, times one less the share that is released. Their direction stays.
///   - *Support pressure*: at every moment across the face as it lies then, against the rock.
///
/// Both are taken at the start of a step, and their work is input.
class WallLoads final : public Coupling {
 public:
  explicit WallLoads(std::vector<WallPressure> pressures) : pressures_(std::move(pressures)) {}

  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 BlockTerms& terms) const override;
  void add_weights(const Model& model, const State& state, const Drive& drive,
                   std::span<double> weight) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;

 private:
  /// Calls of_force(block, vertex, force) for all that act, N per thickness.
  template <typename OfForce>
  void for_forces(const Model& model, const State& state, double time, const OfForce& of_force) const;

  std::vector<WallPressure> pressures_;
};

}  // namespace keyblock::dynamics
