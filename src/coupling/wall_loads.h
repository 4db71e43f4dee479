#pragma once
#include <string>
#include <vector>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "loading/time_table.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// A piece of the wall of an opening: of the edge from a vertex of the surface to the next, between two shares of it.
struct WallFace {
  int vertex = 0;
  double from = 0.0, to = 1.0;
};

/// A point of the wall.
struct WallPoint {
  int vertex = 0;      ///< the start of its edge
  double share = 0.0;  ///< of the edge
};

/// The part of a wall under pressure that is one element: crown, sides, invert.
struct WallStretch {
  std::string name;  ///< "tunnel.crown"
  WallPoint from, to;
  ElementEnd from_end, to_end;  ///< the same before the run
};

/// A support pressure on some of the wall of an opening.
struct WallPressure {
  int excavation = 0;
  std::vector<WallFace> faces;
  loading::TimeTable factor;         ///< of WallState::pressure, over time; empty: 1
  std::vector<std::size_t> element;  ///< per face: the stretch that it is of
};

/// Forces on the walls of openings: a coupling of single blocks with nothing, by terms (docs/theory.md, section "Walls of openings"). Blocks
/// that have left their wall feel none.
///
///   - *Dead loads*: what the excavated rock did, WallState::forces, times one less the share that is released. Their direction stays.
///   - *Support pressure*: at every moment across the face as it lies then, against the rock.
///
/// Both are taken at the start of a step, and their work is input.
class WallLoads final : public Coupling, public ForceScale {
 public:
  WallLoads(std::vector<WallPressure> pressures, std::vector<WallStretch> stretches)
      : pressures_(std::move(pressures)), stretches_(std::move(stretches)) {}

  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 BlockTerms& terms) const override;
  [[nodiscard]] const ForceScale* force_scale() const override { return this; }
  void add_weights(const Model& model, const State& state, const Drive& drive,
                   std::span<double> weight) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] std::vector<Element> elements() const override;
  /// Of each stretch the resultant of the pressure, and how far the stretch has moved in the mean.
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;

 private:
  /// Pa, at a time.
  [[nodiscard]] static double pressure_of(const WallPressure& wall, const WallState& walls, double time) {
    return walls.pressure[static_cast<std::size_t>(wall.excavation)] *
           (wall.factor.empty() ? 1.0 : wall.factor(time));
  }
  /// Calls of_force(block, vertex, force) for all that act, N per thickness.
  template <typename OfForce>
  void for_forces(const Model& model, const State& state, double time, const OfForce& of_force) const;

  std::vector<WallPressure> pressures_;
  std::vector<WallStretch> stretches_;
};

}  // namespace keyblock::dynamics
