#include "statistics/rate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "statistics/distributions.h"
#include "statistics/interval.h"

namespace keyblock::statistics {

namespace {

/// Φ(b) − Φ(a) from the smaller tails.
double normal_between(double a, double b) {
  return a > 0.0 ? normal_cdf(-a) - normal_cdf(-b) : normal_cdf(b) - normal_cdf(a);
}

/// A piece of a power law: λ = rate (x/from)^−k up to `to`.
struct Piece {
  double from, to, rate, k;
  [[nodiscard]] double rate_at(double x) const { return rate * std::pow(x / from, -k); }
};

std::size_t piece_at(const HazardCurve& hazard, double x) {
  const auto after = std::upper_bound(hazard.intensity.begin(), hazard.intensity.end(), x);
  const auto place = after - hazard.intensity.begin();
  const auto last = static_cast<std::ptrdiff_t>(hazard.intensity.size()) - 2;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(place - 1, 0, last));
}

Piece piece(const HazardCurve& hazard, std::size_t i) {
  const double from = hazard.intensity[i], to = hazard.intensity[i + 1];
  const double k = -std::log(hazard.rate[i + 1] / hazard.rate[i]) / std::log(to / from);
  return {from, to, hazard.rate[i], k};
}

/// λ (θ/x)^{−k} e^{k²β²/2} times Φ(z_b + kβ) − Φ(z_a + kβ), in logarithms.
double shifted(const Piece& p, const Lognormal& f, double z_a, double z_b) {
  const double between = normal_between(z_a + p.k * f.beta, z_b + p.k * f.beta);
  if (!(between > 0.0)) return 0.0;
  return std::exp(std::log(p.rate) - p.k * std::log(f.theta / p.from) + 0.5 * p.k * p.k * f.beta * f.beta +
                  std::log(between));
}

double z_of(const Lognormal& f, double x) {
  return std::log(x / f.theta) / f.beta;
}

double rate_of_piece(const Piece& p, const Lognormal& f, double a, double b) {
  return std::max(0.0, f(a) * p.rate_at(a) - f(b) * p.rate_at(b) + shifted(p, f, z_of(f, a), z_of(f, b)));
}

/// From no shaking to `x` on the first piece, drawn out.
double rate_below(const HazardCurve& hazard, const Lognormal& f, double x) {
  const Piece p = piece(hazard, 0);
  const double z = z_of(f, x) + p.k * f.beta;
  const double log_rate =
      std::log(p.rate) - p.k * std::log(f.theta / p.from) + 0.5 * p.k * p.k * f.beta * f.beta;
  return std::max(0.0, std::exp(log_rate) * normal_cdf(z) - f(x) * p.rate_at(x));
}

/// ∫ (c_0 + c_1 ln x) |dλ| over a part of a piece: [−(c_0 + c_1 u + c_1/k) λ]; a flat piece has none.
double straight_over(const Piece& p, double c_0, double c_1, double a, double b) {
  if (!(p.k > 0.0)) return 0.0;
  const auto at = [&](double x) { return (c_0 + c_1 * (std::log(x) + 1.0 / p.k)) * p.rate_at(x); };
  return at(a) - at(b);
}

/// Calls `each` for the pieces from a to b, the first and the last drawn out.
template <class Each>
void over_pieces(const HazardCurve& hazard, double a, double b, const Each& each) {
  const std::size_t first = piece_at(hazard, a), last = piece_at(hazard, b);
  for (std::size_t i = first; i <= last; ++i) {
    const Piece p = piece(hazard, i);
    each(p, i == first ? a : p.from, i == last ? b : p.to);
  }
}

/// Of a standard normal number, E of what `of` gives: the trapezoidal rule from −8 to 8, exact to rounding for what is smooth.
template <class Of>
double normal_mean(const Of& of) {
  constexpr int half = 100;
  constexpr double step = 0.08;
  double sum = 0.0, weights = 0.0;
  for (int i = -half; i <= half; ++i) {
    const double z = step * i, weight = std::exp(-0.5 * z * z);
    sum += weight * of(z);
    weights += weight;
  }
  return sum / weights;
}

constexpr std::array<double, 4> gauss_node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                           0.9602898564975363};
constexpr std::array<double, 4> gauss_weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                             0.1012285362903763};

/// ∫ f(x) |dλ| over a part of a piece, by Gauss and Legendre with eight points on parts of at most `width` in ln x.
double quadrature(const Piece& p, const std::function<double(double)>& f, double a, double b, double width) {
  const double length = std::log(b / a);
  const int parts = std::max(1, static_cast<int>(std::ceil(length / width)));
  const double half = 0.5 * length / parts;
  double sum = 0.0;
  for (int j = 0; j < parts; ++j) {
    const double middle = std::log(a) + (2.0 * j + 1.0) * half;
    for (std::size_t i = 0; i < gauss_node.size(); ++i) {
      for (const double node : {-gauss_node[i], gauss_node[i]}) {
        const double x = std::exp(middle + half * node);
        sum += half * gauss_weight[i] * f(x) * p.k * p.rate_at(x);
      }
    }
  }
  return sum;
}

}  // namespace

double Lognormal::operator()(double x) const {
  return normal_cdf(std::log(x / theta) / beta);
}

double HazardCurve::rate_at(double x) const {
  return piece(*this, piece_at(*this, x)).rate_at(x);
}

double HazardCurve::slope_at(double x) const {
  return piece(*this, piece_at(*this, x)).k;
}

Rate annual_rate(const HazardCurve& hazard, const Lognormal& fragility) {
  Rate rate;
  rate.below = rate_below(hazard, fragility, hazard.first());
  for (std::size_t i = 0; i + 1 < hazard.intensity.size(); ++i) {
    const Piece p = piece(hazard, i);
    rate.inside += rate_of_piece(p, fragility, p.from, p.to);
  }
  rate.beyond_low = fragility(hazard.last()) * hazard.rate.back();
  rate.beyond_high = (hazard.end ? fragility(*hazard.end) : 1.0) * hazard.rate.back();
  return rate;
}

double rate_up_to(const HazardCurve& hazard, const Lognormal& fragility, double x) {
  if (x <= hazard.first()) return rate_below(hazard, fragility, x);
  double sum = rate_below(hazard, fragility, hazard.first());
  over_pieces(hazard, hazard.first(), std::min(x, hazard.last()),
              [&](const Piece& p, double a, double b) { sum += rate_of_piece(p, fragility, a, b); });
  return sum;
}

double intensity_where(const std::function<double(double)>& up_to, double wanted, double from, double to) {
  double low = std::log(from), high = std::log(to);
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (up_to(std::exp(middle)) < wanted ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

PointsRate rate_of_points(const HazardCurve& hazard, const KnownPoints& points) {
  const std::vector<double>&x = points.intensity, &m = points.value;
  PointsRate rate;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const double c_1 = (m[k + 1] - m[k]) / std::log(x[k + 1] / x[k]), c_0 = m[k] - c_1 * std::log(x[k]);
    over_pieces(hazard, x[k], x[k + 1], [&](const Piece& p, double a, double b) {
      rate.between += straight_over(p, c_0, c_1, a, b);
    });
  }
  rate.beyond_low = m.back() * hazard.rate_at(x.back());
  if (m.front() == 0.0) return rate;
  rate.below = not_a_number;
  if (x.size() < 2 || !(m[0] > 0.0 && m[1] > m[0])) return rate;
  const double q = std::log(m[1] / m[0]) / std::log(x[1] / x[0]);
  const Piece first = piece(hazard, 0);
  if (!(q > first.k)) return rate;
  // m_1 (x/x_1)^q: a piece has m_1 x_1^−q k λ_i x_i^k [x^{q−k}/(q − k)]; what is below the curve, all of it.
  const auto part = [&](const Piece& p, double a, double b) {
    const double power = q - p.k;
    const auto at = [&](double y) { return m[0] * std::pow(y / x[0], q) * p.k * p.rate_at(y) / power; };
    return std::abs(power) < 1e-9 ? m[0] * std::pow(a / x[0], q) * p.k * p.rate_at(a) * std::log(b / a)
                                  : at(b) - (a > 0.0 ? at(a) : 0.0);
  };
  const double low = std::min(hazard.first(), x[0]);
  rate.below = part(first, 0.0, low);
  if (low < x[0])
    over_pieces(hazard, low, x[0], [&](const Piece& p, double a, double b) { rate.below += part(p, a, b); });
  return rate;
}

Lifetime over_lifetime(const HazardCurve& hazard, double theta, const Scatter& scatter, double years) {
  const double beta = std::hypot(scatter.record, scatter.rest);
  const auto rate = [&](double z) {
    return annual_rate(hazard, {theta * std::exp(scatter.rock * z), beta}).total();
  };
  Lifetime life;
  life.probability = normal_mean([&](double z) { return -std::expm1(-rate(z) * years); });
  const double mean = annual_rate(hazard, {theta, std::hypot(beta, scatter.rock)}).total();
  life.poisson = -std::expm1(-mean * years);
  life.p05 = rate(inverse_normal_cdf(0.95));
  life.p50 = rate(0.0);
  life.p95 = rate(inverse_normal_cdf(0.05));
  return life;
}

double rate_of_sections(const HazardCurve& hazard, double theta, const Scatter& scatter, double n) {
  const double beta = std::hypot(scatter.rock, scatter.rest);
  const auto any = [&](double x) {
    const auto given = [&](double z) {
      const double p = Lognormal{theta * std::exp(scatter.record * z), beta}(x);
      return p < 1.0 ? -std::expm1(n * std::log1p(-p)) : 1.0;
    };
    return scatter.record > 0.0 ? normal_mean(given) : given(0.0);
  };
  const double width = 0.5 * std::hypot(beta, scatter.record);
  // Ten deviations of a section below the median nothing happens.
  const double start = std::min(hazard.first(), theta * std::exp(-10.0 * std::hypot(beta, scatter.record)));
  double sum = 0.0;
  over_pieces(hazard, start, hazard.last(),
              [&](const Piece& p, double a, double b) { sum += quadrature(p, any, a, b, width); });
  const double low = any(hazard.last()) * hazard.rate.back();
  const double high = (hazard.end ? any(*hazard.end) : 1.0) * hazard.rate.back();
  return sum + 0.5 * (low + high);
}

}  // namespace keyblock::statistics
