#pragma once
#include <cstddef>

#include "simulation/setup.h"

namespace keyblock::simulation {

/// The blocks at the two ends of a spring.
struct SpringBlocks {
  std::size_t from, to;
};

/// Of spring k. Throws InputError, with the key of the end, unless they are two blocks that hold the ends, one of which moves.
SpringBlocks spring_blocks(const RunSetup& setup, std::size_t k);

}  // namespace keyblock::simulation
