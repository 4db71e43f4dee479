#include "statistics/proportion.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace keyblock::statistics {

Estimate proportion(std::size_t k, std::size_t n, double confidence) {
  const auto size = static_cast<double>(n);
  return share_of_independent(static_cast<double>(k) / size, size, confidence);
}

Estimate share_of_independent(double p, double n, double confidence) {
  if (!(n > 0.0)) return {not_a_number, 0.0, 1.0};
  const double z = inverse_normal_cdf(0.5 + 0.5 * confidence);
  const double centre = p + z * z / (2.0 * n);
  const double reach = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 + z * z / n;
  return {p, p == 0.0 ? 0.0 : std::max(0.0, (centre - reach) / scale),
          p == 1.0 ? 1.0 : std::min(1.0, (centre + reach) / scale)};
}

}  // namespace keyblock::statistics
