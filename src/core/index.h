#pragma once
#include <cstddef>

namespace keyblock {

/// A number of a block, a vertex or a row, which is never negative, as a place in a container.
constexpr std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

}  // namespace keyblock
