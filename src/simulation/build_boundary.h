#pragma once
#include <memory>
#include <optional>

#include "coupling/seismic_boundary.h"
#include "model/model.h"
#include "model/state.h"
#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// The rectangle whose sides are the boundary: the domain, or without one what just holds all blocks. Local coordinates.
Box boundary_box(const RunSetup& setup);

/// Damping of all blocks that move in proportion to their mass; none where the scenario has none.
std::optional<dynamics::MassDamping> mass_damping(const dynamics::Model& model);

/// m, from the base to the ground of the rock far away on a side.
struct ColumnHeights {
  double base, ground;
};
/// setup.boundary must be there.
ColumnHeights column_heights(const RunSetup& setup, ColumnSide side);

/// The rock around the model: on all edges of moving blocks that lie on a side of the rectangle. setup.boundary must be there.
std::shared_ptr<const dynamics::Coupling> build_boundary(const RunSetup& setup, const dynamics::Model& model);

/// The planes beside the model, as they are in a state.
std::vector<record::PlaneRecord> planes_beside(const RunSetup& setup, const dynamics::Model& model,
                                               const dynamics::State& state);

}  // namespace keyblock::simulation
