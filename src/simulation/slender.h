#pragma once
#include <optional>
#include <span>
#include <vector>

#include "contact/contact.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::simulation {

/// The pressure along the longer axis of a block, over that at which a column of its proportions buckles that is fixed at its foot and free
/// at its head,
///
///     σ_b = π²/48 · E · I_min / I_max         (Euler; I: ∫ s² dA about the principal axes, a column of l × h has I_min / I_max = h²/l²)
///
/// 0 where the block is not pressed. position: the coefficients of the block.
double buckling_ratio(const dynamics::Block& block, const double* position);

/// The orders of all blocks with which a test of stability sees them bend: order 3, which is 0.1 % above Euler's load, for those that are
/// pressed by a quarter of σ_b. That is far below what any support at the ends leaves of it, unless joints there are soft, which any order sees.
/// Blocks that press against others with their long sides keep their order: these hold them, and the contacts of order 1 are too few to say so of a
/// block that bends. None, where all blocks have these orders.
std::optional<std::vector<int>> orders_that_bend(const dynamics::Model& model, const dynamics::State& state,
                                                 std::span<const contact::Contact> contacts);

}  // namespace keyblock::simulation
