#include "statistics/proportion.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace keyblock::statistics {

Estimate proportion(std::size_t k, std::size_t n, double confidence) {
  if (n == 0) return {not_a_number, 0.0, 1.0};
  const double z = inverse_normal_cdf(0.5 + 0.5 * confidence);
  const auto size = static_cast<double>(n);
  const double p = static_cast<double>(k) / size;
  const double centre = p + z * z / (2.0 * size);
  const double reach = z * std::sqrt(p * (1.0 - p) / size + z * z / (4.0 * size * size));
  const double scale = 1.0 + z * z / size;
  return {p, k == 0 ? 0.0 : std::max(0.0, (centre - reach) / scale),
          k == n ? 1.0 : std::min(1.0, (centre + reach) / scale)};
}

}  // namespace keyblock::statistics
