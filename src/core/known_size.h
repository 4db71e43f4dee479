#pragma once
#include <type_traits>

namespace keyblock {

/// Calls what(N) for a block of N basis functions: with a constant where it is of order 1, as most are, or 2, so that loops over
/// it are unrolled, else with an int.
template <typename Do>
decltype(auto) with_known_size(int size, const Do& what) {
  if (size == 3) return what(std::integral_constant<int, 3>{});
  if (size == 6) return what(std::integral_constant<int, 6>{});
  return what(size);
}

}  // namespace keyblock
