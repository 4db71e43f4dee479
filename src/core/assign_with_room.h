#pragma once
#include <cstddef>
#include <vector>

namespace keyblock {

/// n equal numbers. An array that has to grow gets an eighth more room than it needs, so that the next time it need not: new pages
/// cost more than what is done with them.
template <typename T>
void assign_with_room(std::vector<T>& numbers, std::size_t n, T value) {
  if (n > numbers.capacity()) {
    const bool grows = numbers.capacity() > 0;
    numbers = std::vector<T>();
    numbers.reserve(grows ? n + n / 8 : n);
  }
  numbers.assign(n, value);
}

}  // namespace keyblock
