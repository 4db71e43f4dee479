#include "contact/joint_pressure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/quadrature.h"

namespace keyblock::contact {

namespace {

using Shares = std::array<double, JointPressure::most_points>;

/// N_i(s).
void find_shares(const EdgeDivision& division, double s, Shares& shares) {
  const std::vector<double>& points = division.points;
  for (std::size_t j = 0; j < points.size(); ++j) {
    shares[j] = division.scales[j];
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i != j) shares[j] *= s - points[i];
    }
  }
}

double closure_at(const EdgeDivision& division, std::span<const double> y, double s) {
  Shares shares;
  find_shares(division, s, shares);
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += shares[i] * y[i];
  return sum;
}

/// Between two places where the closure has different signs: where it is zero. Regula falsi, where the end that stays loses half of its weight
/// each time (Illinois algorithm): some six values of a polynomial that is nearly straight there.
double find_zero(const EdgeDivision& division, std::span<const double> y, double from, double to,
                 double at_from, double at_to) {
  const double enough = 1e-14 * std::max(std::abs(at_from), std::abs(at_to));
  double zero = from + (to - from) * at_from / (at_from - at_to);
  if (y.size() == 2) return zero;  // it is linear
  constexpr int most_values = 60;
  for (int k = 0; k < most_values; ++k) {
    const double at_zero = closure_at(division, y, zero);
    if (std::abs(at_zero) <= enough) break;
    if ((at_zero > 0.0) == (at_to > 0.0)) {
      at_from *= 0.5;
    } else {
      from = to;
      at_from = at_to;
    }
    to = zero;
    at_to = at_zero;
    zero = from + (to - from) * at_from / (at_from - at_to);
  }
  return zero;
}

/// A force at s, to the two points that it is between, as a beam on them bears it.
void add_between(const std::vector<double>& points, double s, double force, std::span<double> bearing) {
  std::size_t i = 0;
  while (i + 2 < points.size() && s > points[i + 1]) ++i;
  const double share = (s - points[i]) / (points[i + 1] - points[i]);
  bearing[i] += (1.0 - share) * force;
  bearing[i + 1] += share * force;
}

struct Part {
  double from, to;
};

/// Where the joint is closed, in ascending order.
class ClosedParts {
 public:
  ClosedParts(const EdgeDivision& division, std::span<const double> y) : division_(division), y_(y) {
    if (y.size() == 2) {
      find_between(0.0, 1.0, y[0], y[1]);
      return;
    }
    Shares coefficients{};
    for (std::size_t i = 0; i < y.size(); ++i) {
      for (std::size_t j = 0; j < y.size(); ++j)
        coefficients[i] += division.bernstein[i * y.size() + j] * y[j];
    }
    coefficients[0] = y.front();
    coefficients[y.size() - 1] = y.back();
    find(0.0, 1.0, coefficients, 0);
  }

  [[nodiscard]] std::span<const Part> parts() const { return std::span(parts_).first(count_); }
  [[nodiscard]] bool is_none() const { return count_ == 0; }
  [[nodiscard]] bool is_all() const { return count_ == 1 && parts_[0].from == 0.0 && parts_[0].to == 1.0; }

 private:
  /// Of a part in halves of halves. What a double zero that is missed then leaves out is 2^-72 of the force.
  static constexpr int most_halvings = 24;

  void add(double from, double to) {
    if (count_ > 0 && parts_[count_ - 1].to == from) {
      parts_[count_ - 1].to = to;
    } else {
      parts_[count_++] = {from, to};
    }
  }

  /// Where there is one zero at most.
  void find_between(double from, double to, double at_from, double at_to) {
    if (at_from <= 0.0 && at_to <= 0.0) return;
    if (at_from >= 0.0 && at_to >= 0.0) return add(from, to);
    const double zero = find_zero(division_, y_, from, to, at_from, at_to);
    if (at_from > 0.0) {
      add(from, zero);
    } else {
      add(zero, to);
    }
  }

  /// A polynomial has no more zeros than its coefficients on Bernstein's polynomials have changes of sign. Signs at some places alone would not show a
  /// stretch that opens between two of them: the forces would jump when it comes to reach one.
  void find(double from, double to, const Shares& coefficients, int halvings) {
    const std::size_t n = y_.size();
    std::size_t changes = 0;
    double last = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      if (coefficients[i] == 0.0) continue;
      changes += (last < 0.0 && coefficients[i] > 0.0) || (last > 0.0 && coefficients[i] < 0.0);
      last = coefficients[i];
    }
    if (changes == 0) {
      if (last > 0.0) add(from, to);
      return;
    }
    const double at_from = coefficients[0], at_to = coefficients[n - 1];
    if (changes == 1 && at_from != 0.0 && at_to != 0.0) return find_between(from, to, at_from, at_to);
    if (halvings == most_halvings) return find_between(from, to, at_from, at_to);
    // De Casteljau: what is left of each round are the coefficients of both halves.
    Shares left, right = coefficients;
    for (std::size_t k = 0; k < n; ++k) {
      left[k] = right[0];
      for (std::size_t i = 0; i + k + 1 < n; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
    }
    const double middle = 0.5 * (from + to);
    find(from, middle, left, halvings + 1);
    find(middle, to, right, halvings + 1);
  }

  const EdgeDivision& division_;
  std::span<const double> y_;
  std::array<Part, JointPressure::most_points> parts_;
  std::size_t count_ = 0;
};

}  // namespace

const EdgeDivision& two_ends() {
  static const EdgeDivision ends({0.0, 1.0});
  return ends;
}

/// Calls of_point(weight, s, N_i) for the points of Gauss's rule in the parts where the joint is closed: exact, as N_i N_j is a polynomial.
template <typename OfPoint>
void JointPressure::for_closed_points(std::span<const double> y, const OfPoint& of_point) const {
  const LineRule& rule = gauss_legendre(static_cast<int>(y.size()));
  Shares shares;
  const auto add = [&](double from, double to) {
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      const double s = from + (to - from) * rule.points[q];
      find_shares(*points_, s, shares);
      of_point((to - from) * rule.weights[q], s, shares);
    }
  };
  if (pulls_) return add(0.0, 1.0);
  const ClosedParts closed(*points_, y);
  for (const Part& part : closed.parts()) add(part.from, part.to);
}

void JointPressure::forces(std::span<const double> y, std::span<double> force) const {
  forces(y, force, {});
}

void JointPressure::forces(std::span<const double> y, std::span<double> force,
                           std::span<double> bearing) const {
  std::ranges::fill(force, 0.0);
  std::ranges::fill(bearing, 0.0);
  for_closed_points(y, [&](double weight, double s, const Shares& shares) {
    double closure = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) closure += shares[i] * y[i];
    const double pressed = stiffness_ * weight * closure;
    for (std::size_t i = 0; i < y.size(); ++i) force[i] += pressed * shares[i];
    if (!bearing.empty()) add_between(points_->points, s, pressed, bearing);
  });
}

void JointPressure::tangent(std::span<const double> y, std::span<double> h) const {
  std::ranges::fill(h, 0.0);
  const std::size_t n = y.size();
  for_closed_points(y, [&](double weight, double /*s*/, const Shares& shares) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) h[i * n + j] += stiffness_ * weight * (shares[i] * shares[j]);
    }
  });
}

bool JointPressure::is_linear_between(std::span<const double> from, std::span<const double> to) const {
  if (pulls_) return true;
  const ClosedParts before(*points_, from), after(*points_, to);
  return (before.is_all() && after.is_all()) || (before.is_none() && after.is_none());
}

}  // namespace keyblock::contact
