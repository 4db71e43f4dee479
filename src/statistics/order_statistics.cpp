#include "statistics/order_statistics.h"

#include <cmath>

namespace keyblock::statistics {

namespace {

/// P(B = k), 0 < p < 1.
double binomial(std::size_t n, std::size_t k, double p) {
  const auto size = static_cast<double>(n), count = static_cast<double>(k);
  return std::exp(std::lgamma(size + 1.0) - std::lgamma(count + 1.0) - std::lgamma(size - count + 1.0) +
                  count * std::log(p) + (size - count) * std::log1p(-p));
}

/// Number of values that one may leave out at the lower end: the largest l with P(B < l) at most `tail`.
std::size_t left_out(std::size_t n, double p, double tail) {
  double below = 0.0;
  for (std::size_t l = 0; l <= n; ++l) {
    below += binomial(n, l, p);
    if (below > tail) return l;
  }
  return n;
}

}  // namespace

Interval quantile_interval(std::span<const double> ascending, double p, double confidence) {
  const std::size_t n = ascending.size();
  const double tail = 0.5 * (1.0 - confidence);
  // From above, B counts what is larger: n − B of 1 − p.
  const std::size_t low = n == 0 ? 0 : left_out(n, p, tail), high = n == 0 ? 0 : left_out(n, 1.0 - p, tail);
  return {low == 0 ? -HUGE_VAL : ascending[low - 1], high == 0 ? HUGE_VAL : ascending[n - high]};
}

}  // namespace keyblock::statistics
