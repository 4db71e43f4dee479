#include "model/damping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace keyblock::dynamics {

namespace {

using Complex = std::complex<double>;

/// Roots with less of a turn than this share of Ω are real.
constexpr double no_turn = 1e-6;

Complex determinant(const std::array<std::array<Complex, 3>, 3>& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// F of a motion that is multiplied by 1 + grows in every step of 1 s and goes by `grows` in the one at hand, by what a rule makes of v, a, F
/// and D (its columns).
Complex force_of(const std::array<std::array<double, 4>, 3>& rule, Complex grows) {
  std::array<std::array<Complex, 3>, 3> system;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) system[r][c] = rule[r][c] - (r == c ? 1.0 + grows : 0.0);
  }
  const Complex all = determinant(system);
  for (std::size_t r = 0; r < 3; ++r) system[r][2] = -rule[r][3] * grows;
  return determinant(system) / all;
}

/// λ − 1 of an oscillation with Ω = ω Δt, F = −Ω² for a displacement of 1 at a share of the step, near a guess: by the secant method.
Complex root(const std::array<std::array<double, 4>, 3>& rule, double omega, double place, Complex guess) {
  constexpr int most = 60;
  constexpr double exact = 1e-15;
  const auto missing = [&](Complex grows) {
    return force_of(rule, grows) + omega * omega * (1.0 - (1.0 - place) * grows / (1.0 + grows));
  };
  Complex last = guess, grows = guess * (1.0 + 0.01 * omega), missing_last = missing(last);
  for (int k = 0; k < most && std::abs(grows - last) > exact * std::abs(grows); ++k) {
    const Complex now = missing(grows), slope = now - missing_last;
    if (slope == 0.0) break;
    const Complex next = grows - now * (grows - last) / slope;
    last = grows;
    missing_last = now;
    grows = next;
  }
  return grows;
}

/// place_of: of Ω², the share of the step at which forces are taken.
template <typename PlaceOf>
double damping_of(const Integrator& rule, double step, double frequency, const PlaceOf& place_of) {
  const Motion start{lanes_from(1, 0, 0, 0, 0, 0, 0, 0), lanes_from(0, 1, 0, 0, 0, 0, 0, 0),
                     lanes_from(0, 0, 1, 0, 0, 0, 0, 0)};
  const Motion end = rule.end(start, lanes_from(0, 0, 0, 1, 0, 0, 0, 0), 1.0);
  std::array<std::array<double, 4>, 3> columns{};
  for (int c = 0; c < 4; ++c) {
    columns[0][static_cast<std::size_t>(c)] = end.velocity[c];
    columns[1][static_cast<std::size_t>(c)] = end.acceleration[c];
    columns[2][static_cast<std::size_t>(c)] = end.force[c];
  }
  // The root is followed from that of the exact oscillation on, as Ω grows.
  constexpr double stretch = 0.05;
  const double omega = 2.0 * std::numbers::pi * frequency * step;
  if (!(omega < std::numbers::pi)) return 1.0;
  const int stretches = std::max(1, static_cast<int>(std::ceil(omega / stretch)));
  Complex grows = Complex(-0.5, 1.0) * (omega / stretches);
  for (int k = 1; k <= stretches; ++k) {
    const double now = omega * k / stretches;
    grows = root(columns, now, place_of(now * now), grows);
    const double log_size = 0.5 * std::log1p(2.0 * grows.real() + std::norm(grows)),
                 turn = std::abs(std::atan2(grows.imag(), 1.0 + grows.real()));
    if (!(turn > no_turn * omega) || !std::isfinite(log_size)) return 1.0;
    if (k == stretches) return std::max(-log_size / std::hypot(log_size, turn), 0.0);
  }
  return 1.0;
}

}  // namespace

double numerical_damping(const Integrator& rule, double step, double frequency) {
  return damping_of(rule, step, frequency, [](double /*ratio*/) { return 1.0; });
}

double numerical_damping_of_spring(const Integrator& rule, double step, double frequency) {
  return damping_of(rule, step, frequency, [&](double ratio) { return rule.place_of_spring(ratio); });
}

}  // namespace keyblock::dynamics
