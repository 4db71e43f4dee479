#pragma once
#include <cstddef>

namespace keyblock::study {

/// Which of m values on an axis a realization takes, where each takes r of them: realization i has the places (i + o_q) mod m,
///
///   o_0 = 0,     o_q = 1 + (q − 1 + ⌊i/m⌋) mod (m − 1),     q = 0 … r − 1
///
/// Within m realizations each value is taken equally often, and later every two of them are taken together by some realization. The first realizations are
/// a smaller study. The plain rule (i r + q) mod m falls apart into groups that never meet where r and m have a common divisor.
inline bool takes_value(std::size_t i, std::size_t place, std::size_t m, std::size_t r) {
  for (std::size_t q = 0; q < r; ++q) {
    const std::size_t offset = q == 0 || m < 2 ? 0 : 1 + (q - 1 + i / m) % (m - 1);
    if ((i + offset) % m == place) return true;
  }
  return false;
}

}  // namespace keyblock::study
