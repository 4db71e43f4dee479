#pragma once
#include <cstddef>

#include "contact/candidates.h"

namespace keyblock::dynamics {

// Contacts (or vertices), blocks and coefficients from which loops over them are worth the threads of a team.
using contact::blocks_worth_threads;
using contact::contacts_worth_threads;
inline constexpr std::size_t coefficients_worth_threads = 20'000;

}  // namespace keyblock::dynamics
