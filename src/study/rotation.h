#pragma once
#include <cstddef>
#include <optional>

namespace keyblock::study {

/// Which of m values on an axis a realization takes, where each takes r of them: realization i has the places (i + o_q) mod m,
///
///   o_0 = 0,     o_q = 1 + (q − 1 + ⌊i/m⌋) mod (m − 1),     q = 0 … r − 1
///
/// Within m realizations each value is taken equally often, and later every two of them are taken together by some realization. The first realizations are
/// a smaller study. The plain rule (i r + q) mod m falls apart into groups that never meet where r and m have a common divisor.
///
/// The turn q of the value at `place`; none: the realization does not take it.
inline std::optional<std::size_t> turn_of(std::size_t i, std::size_t place, std::size_t m, std::size_t r) {
  for (std::size_t q = 0; q < r; ++q) {
    const std::size_t offset = q == 0 || m < 2 ? 0 : 1 + (q - 1 + i / m) % (m - 1);
    if ((i + offset) % m == place) return q;
  }
  return std::nullopt;
}

/// Whether it takes the level of K at that turn, where it takes c of them: (i + ⌊i/m⌋ + q + ⌊a K/c⌋) mod K, a = 0 … c − 1.
inline bool takes_level(std::size_t i, std::size_t q, std::size_t m, std::size_t level, std::size_t levels,
                        std::size_t c) {
  for (std::size_t a = 0; a < c; ++a)
    if ((i + i / m + q + a * levels / c) % levels == level) return true;
  return false;
}

}  // namespace keyblock::study
