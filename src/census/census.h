#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "census/faces.h"
#include "census/removal.h"
#include "cutting/block_system.h"

/// Key blocks: which blocks around openings come out, by geometry and limit equilibrium, without a step of time.
namespace keyblock::census {

/// Peak strength of what faces are pieces of.
struct FaceStrength {
  double friction_coefficient = 0.0;  ///< tan φ
  double cohesion = 0.0;              ///< Pa
};

struct Input {
  const cutting::BlockSystem& system;  ///< all excavations are open
  std::vector<double> density{};       ///< kg/m³, by block
  std::vector<std::uint8_t> fixed{};   ///< by block: it stays, and is not counted
  FaceStrength standard{};             ///< of faces that are of no set or map
  std::vector<FaceStrength> joint_sets{}, trace_maps{};
  /// By set or map and trace, where traces have strengths of their own.
  std::vector<std::vector<FaceStrength>> joint_set_traces{}, trace_map_traces{};
  FaceStrength frame{};  ///< of the edge of the domain
  /// Whether there is rock beyond the edge of the domain: at its top, and at its sides and base.
  bool rock_above = true, rock_around = true;
  Vec2 gravity{0.0, -9.81};    ///< m/s²
  Vec2 seismic{};              ///< k_h, k_v: inertia forces over the weight, to the right and up
  double wanted_factor = 1.5;  ///< of safety
};

/// A block with a face on an opening, or on one that blocks before it have left.
struct KeyBlock {
  int block = 0;
  int layer = 0;        ///< from 1 on, in which it moves; 0: it stays
  Vec2 centroid;        ///< m, local coordinates
  double area = 0.0;    ///< m²
  double depth = 0.0;   ///< m, of the corner that is farthest from the wall
  double weight = 0.0;  ///< N per metre of opening
  Removal removal;      ///< as it moves; of a block that stays, when all others have moved
  double force =
      0.0;  ///< N per metre of opening, along which it needs against its motion for the wanted factor
  std::vector<cutting::EdgeLabel> joints;  ///< along which it slides, each once

  [[nodiscard]] bool moves() const { return layer > 0; }
};

struct Census {
  std::vector<KeyBlock> blocks;  ///< those that move by layer and number, then the others by number
  int layers = 0;                ///< that move
  double wall = 0.0;             ///< m, length of the wall: of all faces on openings
};

/// The wall is what remaining rock has of faces along the rock of excavations; where there is none, all faces with nothing beyond. What has a
/// face with nothing beyond it is judged by `find_removal`. All that move (F < 1) are taken out, which is a layer; what they leave open is judged again,
/// until nothing moves. A block that stays holds others, whatever it would need to stay itself.
///
/// With convex blocks it misses no fall of several blocks as one: of convex blocks that go in one direction there is always one that none
/// of the others is in the way of (Guibas & Yao 1980, "On translating a set of rectangles"). Blocks do not push each other.
///
/// An empty wall gives an empty census.
Census take_census(const Input& input);

/// What is gathered over realizations.
struct Totals {
  int moving = 0;                   ///< blocks
  double area = 0.0, weight = 0.0;  ///< m², N per metre: of those that move
  double first_layer_area = 0.0;    ///< m², of those that move before all others
  double largest_area = 0.0;        ///< m², of one of them
  double largest_depth = 0.0;       ///< m, of that block
  double deepest = 0.0;             ///< m, of any of them
  double force = 0.0;               ///< N per metre, for the wanted factor: of all that need one
  int supported = 0;                ///< blocks that stay with less than the wanted factor
  std::array<int, modes> by_mode{};
};
Totals totals(const Census& census);

}  // namespace keyblock::census
