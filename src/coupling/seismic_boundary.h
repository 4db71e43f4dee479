#pragma once
#include <optional>
#include <span>
#include <vector>

#include "coupling/boundary_sides.h"
#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "coupling/mass_damping.h"
#include "coupling/rock_column.h"

namespace keyblock::dynamics {

/// A Gauss point of an edge of rock at the boundary of the model.
struct BoundaryPoint {
  MaterialPoint point;
  Vec2 place;            ///< m, before the run
  Vec2 normal;           ///< of the model, outwards; along an axis
  double length = 0.0;   ///< m, its share of the edge
  Vec2 traction;         ///< Pa, before the run
  Vec2 springs;          ///< Pa/m, that hold it in x and in y; in dynamic steps only if it does not absorb
  bool absorbs = false;  ///< waves, in dynamic steps
  Vec2 dashpots;         ///< Pa s/m, in x and in y, of those steps
  int far = -1;          ///< the far rock whose stress and motion it has then; −1: rock at rest
  RockColumn::Place in_far;  ///< where it is in that rock
};

/// A place among columns of rock far away: between what the outer two do at its height.
struct FarPlace {
  RockColumn::Place left, right;
  double share = 0.0;  ///< of the right one
};

/// The rock beyond the boundary of the model (docs/theory.md, section "Seismic boundaries"): a coupling of single blocks with the ground, by
/// terms. The traction at a point, with u its displacement, v′ its velocity at the end of a step, and C its dashpots, is
///
///     static steps       t_a − k (u − u_a)                        in the directions that are held, else t_a
///     dynamic steps      t_0 + σ_far n + C (v_far − v′)           where it absorbs, else as in static ones
///
/// From one kind to the other, t_0 is the traction of the last static step, and (t_a, u_a) are the traction and the displacement of the last
/// dynamic one: forces and positions go on as they were. σ_far and v_far are those of a column of rock far away (RockColumn), which knows
/// nothing of the model. They are zero where the dynamic steps begin. Damping in proportion to mass acts against the motion of that rock.
///
/// Memory: which kind the last step was; of each point u_a, t_a or t_0 (less the traction before the run), and the traction; of each column
/// its motion, and the displacement that it had when the dynamic steps began.
class SeismicBoundary final : public Coupling, public FarField {
 public:
  SeismicBoundary(std::vector<BoundaryPoint> points, std::vector<FarRock> far,
                  std::optional<MassDamping> damping = {});

  [[nodiscard]] std::size_t memory_size() const override;
  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 BlockTerms& terms) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] double stored_energy(const Model& model, const State& state, double time,
                                     std::span<const double> memory) const override;
  [[nodiscard]] std::vector<Element> elements() const override { return sides_.elements(points_); }
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;
  [[nodiscard]] const FarField* far_field() const override { return this; }
  [[nodiscard]] GroundMove far_ground(std::span<const double> memory, Vec2 place) const override;
  [[nodiscard]] std::span<const FarRock> far_rock() const override { return far_; }
  [[nodiscard]] RockPlaneState plane(std::span<const double> memory, std::size_t far,
                                     std::size_t k) const override;
  void add_held_blocks(std::vector<int>& blocks) const override;
  void add_rounding_forces(const Model& model, double extent, std::span<double> force) const override;

  [[nodiscard]] std::span<const BoundaryPoint> boundary_points() const { return points_; }

 private:
  struct PointMemory;
  /// The traction at a point in the direction of an axis.
  struct Law;
  class Step;
  /// J per thickness, in the springs of a point.
  [[nodiscard]] double stored(const Model& model, const State& state, const PointMemory& memory,
                              std::size_t k) const;
  [[nodiscard]] FarPlace far_place(Vec2 place) const;
  [[nodiscard]] GroundMove far_ground(std::span<const double> memory, const FarPlace& place) const;

  std::vector<BoundaryPoint> points_;
  BoundarySides sides_;
  std::vector<FarRock> far_;  ///< from left to right
  std::optional<MassDamping> damping_;
  std::vector<FarPlace> damped_;  ///< where its points are; empty without rock far away
};

}  // namespace keyblock::dynamics
