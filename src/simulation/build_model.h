#pragma once
#include <span>

#include "model/model.h"
#include "model/state.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// The fixed block around a domain: a ring of a twentieth of the larger extent.
Polygon frame_polygon(const Box& domain);

/// The mechanical model of a setup. Blocks keep their order; with a frame, one more block, fixed, stands last.
/// Throws InputError for loads and supports that lie off their block and for blocks that no polynomial can be built on.
dynamics::Model build_model(const RunSetup& setup);

/// Gives blocks other orders, one per block of the model; fixed ones keep theirs. What contact sees keeps its vertices, and the
/// state its displacement: terms of degrees that a block had not before are zero, those it has no more are dropped.
void change_orders(const RunSetup& setup, dynamics::Model& model, dynamics::State& state,
                   std::span<const int> orders);

/// Reference position, with the velocities of the setup.
dynamics::State initial_state(const RunSetup& setup, const dynamics::Model& model);

}  // namespace keyblock::simulation
