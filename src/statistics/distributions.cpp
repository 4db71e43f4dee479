#include "statistics/distributions.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace keyblock::statistics {

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double student_t(double confidence, int degrees) {
  const double n = degrees;
  const double tails = 1.0 - confidence;
  const double half_pi = 0.5 * std::numbers::pi;
  if (degrees == 1) return 1.0 / std::tan(tails * half_pi);
  if (degrees == 2) return std::sqrt(2.0 / (tails * (2.0 - tails)) - 2.0);
  const double a = 1.0 / (n - 0.5);
  const double b = 48.0 / (a * a);
  double c = ((20700.0 * a / b - 98.0) * a - 16.0) * a + 96.36;
  const double d = ((94.5 / (b + c) - 3.0) / b + 1.0) * std::sqrt(a * half_pi) * n;
  double y = std::pow(d * tails, 2.0 / n);
  if (y <= 0.05 + a) {
    y = ((1.0 / (((n + 6.0) / (n * y) - 0.089 * d - 0.822) * (n + 2.0) * 3.0) + 0.5 / (n + 4.0)) * y - 1.0) *
            (n + 1.0) / (n + 2.0) +
        1.0 / y;
    return std::sqrt(n * y);
  }
  const double x = inverse_normal_cdf(0.5 * tails);
  y = x * x;
  if (degrees < 5) c += 0.3 * (n - 4.5) * (x + 0.6);
  c = (((0.05 * d * x - 5.0) * x - 7.0) * x - 2.0) * x + b + c;
  y = (((((0.4 * y + 6.3) * y + 36.0) * y + 94.5) / c - y - 3.0) / b + 1.0) * x;
  return std::sqrt(n * std::expm1(a * y * y));
}

}  // namespace keyblock::statistics
