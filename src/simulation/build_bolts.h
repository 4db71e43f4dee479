#pragma once
#include <cstddef>
#include <vector>

#include "coupling/point_springs.h"
#include "model/model.h"
#include "simulation/setup.h"

/// Rock bolts in the blocks that they cross: springs between points (dynamics::PointSpring).
namespace keyblock::simulation {

/// A stretch of a bolt in one block, m from the head.
struct BoltPiece {
  std::size_t block = 0;
  double from = 0.0, to = 0.0;

  [[nodiscard]] double length() const { return to - from; }
};

/// The rock along bolt k, from its head to its toe, that is there when it is installed, where blocks are before the run. Of two blocks that meet along
/// the bolt one has it. Throws InputError, with the key of the end, where head or toe are in no rock.
std::vector<BoltPiece> bolt_pieces(const RunSetup& setup, std::size_t k);

/// Point of a block by its place before the run.
dynamics::MaterialPoint material_point(const dynamics::Model& model, std::size_t block, Vec2 place);

/// Springs with two points each, and two to draw them from and to.
struct BoltSprings {
  std::vector<dynamics::PointSpring> springs;
  std::vector<dynamics::MaterialPoint> points, drawn;
};

/// Adds the springs of all bolts: of one that is anchored at its ends a spring from head to toe, of others one for each joint that they cross
/// (loading::BoltAtJoint), and a dowel there. Joints where a side is held by nothing have none.
void add_bolts(const RunSetup& setup, const dynamics::Model& model, BoltSprings& to);

}  // namespace keyblock::simulation
