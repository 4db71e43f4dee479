#pragma once
#include <cstddef>
#include <vector>

#include "model/model.h"
#include "simulation/bolt_springs.h"
#include "simulation/setup.h"

/// Rock bolts in the blocks that they cross: springs between points (dynamics::PointSpring).
namespace keyblock::simulation {

/// The blocks along a straight line that are there when a stage installs what lies on it (State::installed; −1: from the start), m from its start.
std::vector<BoltPiece> rock_along(const RunSetup& setup, Vec2 from, Vec2 to, int staged);

/// The rock along bolt k, from its head to its toe, that is there when it is installed, where blocks are before the run. Of two blocks that meet along
/// the bolt one has it. Throws InputError, with the key of the end, where head or toe are in no rock.
std::vector<BoltPiece> bolt_pieces(const RunSetup& setup, std::size_t k);

/// Adds the springs of all bolts: of one that is anchored at its ends a spring from head to toe, of others one for each joint that they cross
/// (loading::BoltAtJoint), and a dowel there. Joints where a side is held by nothing have none. Those of bolts of nodes are in bolt_nodes.h.
void add_bolts(const RunSetup& setup, const dynamics::Model& model, BoltSprings& to);

}  // namespace keyblock::simulation
