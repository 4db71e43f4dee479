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

/// A joint across the rock far away, level or nearly so, on which it slips and opens. With τ and σ what waves add to the shear stress and the
/// vertical stress on a level section there, r that to the horizontal one (sideways over upright), w the jump of displacements across it, p
/// its slip along t = (cos α, −sin α), n = (sin α, cos α):
///
///     τ = k_s (w − p t)_x,   σ = min(k_n (w − p t)_y, N_v + tension)        N_v: compression of a level section before
///     T = T⁰ + τ cos 2α + ½ (r − 1) σ sin 2α,     N = N⁰ − σ (r sin² α + cos² α) − τ sin 2α,     |T| ≤ c + N tan φ
///
/// Cohesion and tension are lost when it slips or opens. Where it is open, N_v + tension is given up, and T is 0.
struct RockPlane {
  double height = 0.0;                   ///< m
  double dip = 0.0;                      ///< rad, α, downwards to the right
  double friction = 0.0;                 ///< tan φ
  double cohesion = 0.0, tension = 0.0;  ///< Pa
  double normal_stiffness = 0.0;         ///< Pa/m, k_n
  double shear_stiffness = 0.0;          ///< Pa/m, k_s
  double level = 0.0;                    ///< Pa, N_v
  double normal = 0.0, shear = 0.0;      ///< Pa, N⁰ and T⁰, before waves come
};

/// How a plane is.
struct RockPlaneState {
  double slip = 0.0;  ///< m, p, since the start of the run; positive where the upper rock goes to the right
  double largest_slip = 0.0;  ///< m, of |p|
  double normal = 0.0;        ///< Pa, N
  double shear = 0.0;         ///< Pa, T
  bool broken = false;        ///< it has slipped or opened: cohesion and tension are lost
  bool opened = false;        ///< at any time
};

/// What takes energy out of the waves of a column.
struct ColumnDamping {
  double viscosity = 0.0;  ///< s, β of its stress G (γ + β ∂γ/∂t), and likewise of that by compression
  double drag = 0.0;       ///< 1/s, a of the force −a m v on masses that move relative to the frame
};

/// Rock beside the model, as far away as if there were none: a column of linear elements from the base to the ground, in which waves go up
/// and down, u_x by shear and u_y by compression. It moves relative to the same frame as the model and feels the same body force −ρ a. At
/// its base are dashpots, which stand for the half-space below, or it is fixed.
///
/// The mass matrix is the mean of the consistent and the lumped one: the speed of waves is then right to the fourth power of the element
/// over the wave length (Hughes 2000, section 9.1).
///
/// At a plane a node is two, one below and one above. The column between is a chain without links, which inertia keeps regular; y is solved
/// first, with planes closed or open, then x, with the bounds of friction of this step, each until no plane changes its state. Level planes
/// need that once; slip on others lifts and lowers the rock, and both are solved again until the slip stays. What is left of the slip of these
/// hangs on when it begins and ends: their steps are taken in four parts.
class RockColumn {
 public:
  /// Layers from above; the last one goes down to the base. dashpots: Pa s/m in x and y; none: it is fixed. fastest: Hz, for which elements
  /// are short enough.
  RockColumn(std::span<const RockLayer> layers, double base, double ground, std::optional<Vec2> dashpots,
             double fastest, ColumnDamping damping = {}, std::span<const RockPlane> planes = {});

  /// Numbers that its motion takes: those of rest are zero.
  [[nodiscard]] std::size_t memory_size() const {
    return memory_of_nodes() + numbers_of_plane * planes_.size();
  }
  /// A step of length dt, s, under an acceleration of the frame, m/s². before and after: of memory_size; they may be the same.
  void step(std::span<const double> before, double dt, const Integrator& rule, Vec2 acceleration,
            std::span<double> after) const;

  /// Where something is at a height: it is found once.
  struct Place {
    std::size_t element = 0;  ///< that holds it
    double share = 0.0;       ///< of the element below it
    std::size_t stressed =
        0;  ///< the elements, this one and the next but for planes, whose stresses it is between
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
  /// m, of nodes, from the base upwards; twice where a plane is.
  [[nodiscard]] std::span<const double> heights() const { return height_; }
  /// From below.
  [[nodiscard]] std::span<const RockPlane> planes() const { return planes_; }
  [[nodiscard]] RockPlaneState plane(std::span<const double> memory, std::size_t k) const;
  /// Waves are over, and the column is at rest as it is: `moved` nodes are where they are from now on.
  void rest(std::span<double> memory, std::span<double> moved) const;

 private:
  struct Tridiagonal;
  /// Of the increment D, in the forces of a step.
  struct StepFactors {
    double inertia = 0.0;  ///< 1/s², of mass
    double drag = 0.0;     ///< 1/s², of mass, by ColumnDamping::drag
    double viscous = 1.0;  ///< of stiffness
  };
  /// Numbers of the nodes: x and y of displacement, velocity, acceleration and force; those of planes follow.
  [[nodiscard]] std::size_t memory_of_nodes() const { return 8 * height_.size(); }
  /// One part of a step; before and after may be the same.
  void step_once(std::span<const double> before, double dt, const Integrator& rule, Vec2 acceleration,
                 std::span<double> after) const;
  [[nodiscard]] bool has_dipping_planes() const;
  struct Link;
  class Slide;
  static constexpr std::size_t numbers_of_plane = 8;
  [[nodiscard]] bool is_link(std::size_t element) const { return density_[element] == 0.0; }
  /// Elements above and below one with an extent.
  [[nodiscard]] std::size_t next_above(std::size_t element) const;
  void solve_planes(std::span<const double> before, std::span<Tridiagonal> systems,
                    std::span<double> after) const;
  void add_elements(const RockLayer& rock, double bottom, double top, double longest);
  void assemble(std::span<const double> before, std::span<const Motion> coasting, std::size_t axis,
                const StepFactors& factors, double frame, Tridiagonal& system) const;

  std::vector<RockLayer> layers_;
  std::vector<double> height_;                  ///< m, of nodes
  std::vector<double> density_;                 ///< kg/m³, of elements; 0: a plane, without extent
  std::array<std::vector<double>, 2> modulus_;  ///< Pa, of elements, in x and in y
  std::optional<Vec2> dashpots_;
  ColumnDamping damping_;
  std::vector<RockPlane> planes_;  ///< from below
  std::vector<std::size_t> link_;  ///< the elements that they are
  std::vector<double> sideways_;   ///< of the rock that they are in, sideways over upright
};

}  // namespace keyblock::dynamics
