#include "statistics/distributions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace keyblock::statistics {

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

namespace {

// Continued fraction of the incomplete beta function (Lentz), as in Numerical Recipes, 6.4.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300, precision = 1e-15;
  constexpr int most_terms = 500;
  double c = 1.0, d = 1.0 / std::max(tiny, 1.0 - (a + b) * x / (a + 1.0)), h = d;
  for (int m = 1; m < most_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    double change = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 + term * d;
      c = 1.0 + term / c;
      if (std::abs(d) < tiny) d = tiny;
      if (std::abs(c) < tiny) c = tiny;
      d = 1.0 / d;
      change = c * d;
      h *= change;
    }
    if (std::abs(change - 1.0) < precision) break;
  }
  return h;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(a, b, x) / a
                                       : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

double quantile_of_student(double confidence, int degrees) {
  // P(|T| > t) = I_y(ν/2, 1/2) with y = ν/(ν + t²), which rises with y.
  double low = 0.0, high = 1.0;
  for (int k = 0; k < 200; ++k) {
    const double y = 0.5 * (low + high);
    (incomplete_beta(0.5 * degrees, 0.5, y) < 1.0 - confidence ? low : high) = y;
  }
  return low > 0.0 ? std::sqrt(degrees * (1.0 - low) / low) : HUGE_VAL;
}

}  // namespace

double student_t(double confidence, int degrees) {
  // Running means and bands of curves ask for the same ones again and again.
  static thread_local std::map<std::pair<double, int>, double> known;
  const auto [place, is_new] = known.try_emplace({confidence, degrees}, 0.0);
  if (is_new) place->second = quantile_of_student(confidence, degrees);
  return place->second;
}

}  // namespace keyblock::statistics
