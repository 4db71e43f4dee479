#pragma once
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "coupling/wall_loads.h"
#include "model/model.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// The faces along the outline of an excavation of the blocks outside of it, those of other excavations too, in the order of vertices. arc:
/// degrees about the centroid of the outline, from +x counter-clockwise, within which they lie; none: all.
std::vector<dynamics::WallFace> wall_faces(const RunSetup& setup, const dynamics::Model& model,
                                           std::size_t excavation,
                                           const std::optional<std::pair<double, double>>& arc = {});

/// The loads on walls of a run, or nothing where there are none. Throws InputError where a pressure has nothing to act on.
std::shared_ptr<const dynamics::Coupling> wall_loads(const RunSetup& setup, const dynamics::Model& model);

}  // namespace keyblock::simulation
