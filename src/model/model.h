#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "block/basis.h"
#include "block/elasticity.h"
#include "block/pose.h"
#include "contact/contact_strengths.h"
#include "contact/joint_law.h"
#include "contact/surface.h"
#include "contact/tolerances.h"
#include "loading/time_table.h"
#include "model/options.h"

namespace keyblock::dynamics {

class Coupling;

/// What has unknowns of its own: basis functions φ_k with coefficients, so that a point of it is Σ φ_k a_k (MaterialPoint). The basis is scaled
/// so that the mass matrix is the density times the identity. Constant during a run.
struct Body {
  // First, and together, what every step reads.
  std::size_t first =
      0;         ///< its coefficients start here in State::position: a_0x, a_0y, a_1x, …; fixed blocks last
  int size = 0;  ///< N, number of basis functions; 2N unknowns
  int unknown = -1;  ///< number among the blocks that move; −1: fixed
  bool fixed = false;
  double area = 0.0;  ///< m², in the section: of a block that of the reference polygon
  block::Material material;
  [[nodiscard]] double mass() const { return material.density * area; }
};

/// Nodes of a bar that is thin beside the blocks. φ_k is 1/√A_k at node k and 0 at the others, A_k the area of the bar about it per metre of
/// thickness. Its inertia keeps a step definite; its weight is left to the rock in whose place it is. What holds it are rows of couplings alone.
struct LineBody : Body {
  int block = 0;  ///< whose forces measure its balance: the heaviest that it is linked to
};

/// One block as mechanics sees it: a body with an outline.
struct Block : Body {
  Vec2 centroid;        ///< m, of the reference polygon
  double radius = 0.0;  ///< m, from the centroid to the farthest vertex
  block::Pose pose;
  block::Elasticity elasticity;
  Polygon reference;
  block::Basis basis;
  int edge_order = 1;  ///< contact divides the edges as for a block of this order at least; 1: it does not
  /// Force per unit acceleration on coefficient 0, ρ √A; the others feel no uniform body force.
  [[nodiscard]] double body_force() const { return material.density * std::sqrt(area); }
};

/// A force that follows its block: vector Q of 2N generalized forces times a factor table.
struct GeneralizedLoad {
  int block = 0;
  std::vector<double> force;  ///< N/m per thickness, ∫ φ_k q dΓ
  loading::TimeTable factor;  ///< empty: 1
};

/// A fixed block that is moved rigidly by a prescribed displacement.
struct PrescribedMotion {
  int block = 0;
  Vec2 start;               ///< m, centroid before the run
  loading::TimeTable x, y;  ///< m; empty: none

  /// Where the centroid is at a time.
  [[nodiscard]] Vec2 centroid(double time) const {
    return start + Vec2{x.empty() ? 0.0 : x(time), y.empty() ? 0.0 : y(time)};
  }
};

/// Everything that does not change during a run, except by excavation and by a program that steers it (simulation::Control).
struct Model {
  std::vector<Block> blocks;
  std::vector<LineBody> lines;  ///< bodies by number are the blocks, and then these
  contact::Surface surface;
  std::vector<Vec2> reference;    ///< position of its vertices
  std::vector<int> outline_edge;  ///< of its edges: the edge of a polygon it lies on; all count, ring by ring
  std::vector<contact::JointLaw> laws;
  contact::ContactStrengths contact_strengths;  ///< of a program that steers the run; empty: those of laws
  std::vector<GeneralizedLoad> loads;
  std::vector<double> load_scale;  ///< factor on each load, of a program that steers the run; empty: 1
  std::vector<double>
      spring_stiffness;  ///< N/m of each of the springs between points, likewise; empty: their own
  std::vector<std::shared_ptr<const Coupling>> couplings;  ///< all except contacts
  std::vector<PrescribedMotion> motions;
  std::optional<block::InSituStress> in_situ;
  Vec2 gravity;  ///< m/s²
  /// m/s², acceleration of the ground that static steps stand for: each block has the inertia force of it as a load.
  Vec2 static_ground;
  int water = -1;             ///< which of its waters acts in the stage that runs; −1: none
  bool water_drains = false;  ///< it runs out of joints that have opened, in the stage that runs
  bool joints_wear = true;    ///< slip wears the joints whose law has memory, in the stage that runs
  double block_size = 1.0;    ///< m, √(mean area of the blocks that move)
  SolverOptions solver;

  std::size_t unknowns =
      0;  ///< coefficients of the bodies that are not fixed; they come first: of blocks, then of lines
  std::size_t coefficients = 0;  ///< of all bodies

  /// On the forces of a load.
  [[nodiscard]] double load_factor(std::size_t load, double time) const {
    const double factor = loads[load].factor.empty() ? 1.0 : loads[load].factor(time);
    return load_scale.empty() ? factor : factor * load_scale[load];
  }
  [[nodiscard]] std::size_t bodies() const { return blocks.size() + lines.size(); }
  [[nodiscard]] const Body& body(std::size_t b) const {
    return b < blocks.size() ? static_cast<const Body&>(blocks[b]) : lines[b - blocks.size()];
  }
  /// Asked for all bodies in every step, of two short arrays.
  [[nodiscard]] bool moves(std::size_t b) const {
    return b >= blocks.size() || (surface.fixed[b] == 0 && surface.present[b] != 0);
  }
};

/// β, s: by which stiffness damps the rock and its joints, in dynamic steps.
inline double stiffness_damping(const Model& model) {
  return model.solver.stiffness_time();
}

}  // namespace keyblock::dynamics
