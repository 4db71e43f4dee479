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

/// Calls of_cell(from, to, closure at both) for the cells in which the sign of the closure is looked at: halves of what is between points.
template <typename OfCell>
void for_cells(const EdgeDivision& division, std::span<const double> y, const OfCell& of_cell) {
  const std::vector<double>& points = division.points;
  if (y.size() == 2) return of_cell(0.0, 1.0, y[0], y[1]);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double middle = 0.5 * (points[i] + points[i + 1]), at_middle = closure_at(division, y, middle);
    of_cell(points[i], middle, y[i], at_middle);
    of_cell(middle, points[i + 1], at_middle, y[i + 1]);
  }
}

/// A force at s, to the two points that it is between, as a beam on them bears it.
void add_between(const std::vector<double>& points, double s, double force, std::span<double> bearing) {
  std::size_t i = 0;
  while (i + 2 < points.size() && s > points[i + 1]) ++i;
  const double share = (s - points[i]) / (points[i + 1] - points[i]);
  bearing[i] += (1.0 - share) * force;
  bearing[i + 1] += share * force;
}

enum class Closed { all, none, partly };

Closed closed_part(const EdgeDivision& division, std::span<const double> y) {
  bool any = false, all = true;
  for_cells(division, y, [&](double /*from*/, double /*to*/, double at_from, double at_to) {
    any = any || at_from > 0.0 || at_to > 0.0;
    all = all && at_from >= 0.0 && at_to >= 0.0;
  });
  return any ? all ? Closed::all : Closed::partly : Closed::none;
}

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
  const Closed closed = pulls_ ? Closed::all : closed_part(*points_, y);
  if (closed == Closed::all) return add(0.0, 1.0);
  if (closed == Closed::none) return;
  for_cells(*points_, y, [&](double from, double to, double at_from, double at_to) {
    if (at_from <= 0.0 && at_to <= 0.0) return;
    if (at_from >= 0.0 && at_to >= 0.0) return add(from, to);
    const double zero = find_zero(*points_, y, from, to, at_from, at_to);
    if (at_from > 0.0) {
      add(from, zero);
    } else {
      add(zero, to);
    }
  });
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
  const Closed closed = closed_part(*points_, from);
  return closed != Closed::partly && closed == closed_part(*points_, to);
}

}  // namespace keyblock::contact
