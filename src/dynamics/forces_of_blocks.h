#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "contact/contact.h"
#include "coupling/step_problem.h"

namespace keyblock::dynamics {

/// N per thickness, at every vertex of the surface: what contacts with the blocks of `sources` do to the other blocks. problem: at D = 0, its
/// first rows those of `contacts`. sources: per block, not 0.
[[nodiscard]] std::vector<Vec2> forces_of_blocks(const Model& model, const StepProblem& problem,
                                                 std::span<const contact::Contact> contacts,
                                                 std::span<const std::uint8_t> sources);

}  // namespace keyblock::dynamics
