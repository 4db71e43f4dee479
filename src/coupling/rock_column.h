#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/vec2.h"
#include "model/integrator.h"

namespace keyblock::dynamics {

/// How ground moves at a place.
struct GroundMove {
  Vec2 displacement;  ///< m, since the start of the run
  Vec2 velocity;      ///< m/s
};

/// Rock from a height downwards, to the next layer.
struct RockLayer {
  double top = 0.0;       ///< m, height
  double density = 0.0;   ///< kg/m³
  double shear = 0.0;     ///< Pa, shear stress over shear strain
  double upright = 0.0;   ///< Pa, vertical stress over vertical strain, where nothing moves sideways
  double sideways = 0.0;  ///< Pa, horizontal stress over vertical strain, likewise

  /// Pa s/m: what a unit of velocity of a level face costs, horizontally (x) and vertically (y), where waves go up and down.
  [[nodiscard]] Vec2 impedance() const;
  /// m/s, of waves that go up and down, by shear (x) and by compression (y).
  [[nodiscard]] Vec2 speeds() const;
};

/// Of layers from above, the one at a height. The first one also holds above its top.
[[nodiscard]] const RockLayer& layer_at(std::span<const RockLayer> layers, double height);

/// Rock beside the model, as far away as if there were none: a column of linear elements from the base to the ground, in which waves go up
/// and down, u_x by shear and u_y by compression. It moves relative to the same frame as the model and feels the same body force −ρ a. At
/// its base are dashpots, which stand for the half-space below, or it is fixed.
///
/// The mass matrix is the mean of the consistent and the lumped one: the speed of waves is then right to the fourth power of the element
/// over the wave length (Hughes 2000, section 9.1).
class RockColumn {
 public:
  /// Layers from above; the last one goes down to the base. dashpots: Pa s/m in x and y; none: it is fixed. fastest: Hz, for which elements
  /// are short enough. viscosity: s, β of its stress G (γ + β ∂γ/∂t), and likewise of that by compression.
  RockColumn(std::span<const RockLayer> layers, double base, double ground, std::optional<Vec2> dashpots,
             double fastest, double viscosity = 0.0);

  /// Numbers that its motion takes: those of rest are zero.
  [[nodiscard]] std::size_t memory_size() const { return 8 * height_.size(); }
  /// A step of length dt, s, under an acceleration of the frame, m/s². before and after: of memory_size; they may be the same.
  void step(std::span<const double> before, double dt, const Integrator& rule, Vec2 acceleration,
            std::span<double> after) const;

  /// Where something is at a height: it is found once.
  struct Place {
    std::size_t element = 0;    ///< that holds it
    double share = 0.0;         ///< of the element below it
    std::size_t stressed = 0;   ///< the elements, this one and the next, whose stresses it is between
    double stress_share = 0.0;  ///< how far between them
    double sideways = 0.0;      ///< horizontal over vertical stress there
  };
  [[nodiscard]] Place place_of(double height) const;
  /// What is linear between nodes. of_nodes: x and y of each.
  [[nodiscard]] Vec2 at_place(std::span<const double> of_nodes, const Place& place) const;
  [[nodiscard]] GroundMove motion(std::span<const double> memory, const Place& place) const;

  struct Stress {
    double xx = 0.0, yy = 0.0, xy = 0.0;  ///< Pa
    [[nodiscard]] Vec2 on(Vec2 normal) const {
      return {xx * normal.x + xy * normal.y, xy * normal.x + yy * normal.y};
    }
  };
  /// Of what the column is strained by (strained()).
  [[nodiscard]] Stress stress(std::span<const double> strained, const Place& place) const;
  /// m, x and y of each node: displacements whose strain makes the stress at the end of a step of length dt from `before` to `after`,
  /// u + β D/Δt.
  [[nodiscard]] std::vector<double> strained(std::span<const double> before, double dt,
                                             std::span<const double> after) const;
  /// m, x and y of each node.
  [[nodiscard]] std::span<const double> displacements(std::span<const double> memory) const {
    return memory.first(2 * height_.size());
  }
  /// m, of nodes, from the base upwards.
  [[nodiscard]] std::span<const double> heights() const { return height_; }

 private:
  struct Tridiagonal;
  void assemble(std::span<const double> before, std::span<const Motion> coasting, std::size_t axis,
                double inertia, double viscous, double frame, Tridiagonal& system) const;

  std::vector<RockLayer> layers_;
  std::vector<double> height_;                  ///< m, of nodes
  std::vector<double> density_;                 ///< kg/m³, of elements
  std::array<std::vector<double>, 2> modulus_;  ///< Pa, of elements, in x and in y
  std::optional<Vec2> dashpots_;
  double viscosity_;  ///< s
};

}  // namespace keyblock::dynamics
