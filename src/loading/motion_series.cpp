#include "loading/motion_series.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace keyblock::loading {
namespace {

// x and v after h seconds of an oscillator under an acceleration that goes straight from a to b.
class OscillatorStep {
 public:
  OscillatorStep(double omega, double damping, double h) : h_(h) {
    const double d = damping * omega, od = omega * std::sqrt(1.0 - damping * damping), w2 = omega * omega;
    const double e = std::exp(-d * h), s = std::sin(od * h), c = std::cos(od * h);
    xx_ = e * (d / od * s + c);
    xv_ = e / od * s;
    vx_ = -e * w2 / od * s;
    vv_ = e * (c - d / od * s);
    w2_ = w2;
    lag_ = 2.0 * damping / omega;
  }

  void advance(double& x, double& v, double a, double b) const {
    // A particular solution for −a − r t is −(a + r t)/ω² + 2ζ r/ω³; the rest decays.
    const double rate = (b - a) / h_;
    const double shift = (lag_ * rate - a) / w2_, slope = -rate / w2_;
    const double x0 = x - shift, v0 = v - slope;
    x = xx_ * x0 + xv_ * v0 + shift + slope * h_;
    v = vx_ * x0 + vv_ * v0 + slope;
  }

 private:
  double h_, xx_ = 0.0, xv_ = 0.0, vx_ = 0.0, vv_ = 0.0, w2_ = 0.0, lag_ = 0.0;
};

}  // namespace

MotionSeries motion_series(const MotionComponent& component, Baseline baseline) {
  MotionSeries series;
  ProjectionOptions options;
  options.baseline = baseline;
  const GroundMotion motion = project_motion("", {{component, {}}}, options);
  double v = 0.0, u = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < motion.times().size(); ++k) {
    const double b = motion.accelerations()[k].x;
    if (k > 0) {
      const double h = motion.times()[k] - motion.times()[k - 1], a = motion.accelerations()[k - 1].x;
      u += h * v + h * h / 6.0 * (2.0 * a + b);
      v += 0.5 * h * (a + b);
      squares += h / 3.0 * (a * a + a * b + b * b);
    }
    series.time.push_back(component.time(0) + motion.times()[k]);
    series.acceleration.push_back(b);
    series.velocity.push_back(v);
    series.displacement.push_back(u);
    series.arias.push_back(std::numbers::pi / (2.0 * standard_gravity) * squares);
  }
  return series;
}

std::vector<double> oscillator_history(const std::vector<double>& time,
                                       const std::vector<double>& acceleration, double period,
                                       double damping) {
  constexpr double places = 40.0, most_parts = 64.0, same = 1e-6;
  const double omega = 2.0 * std::numbers::pi / period;
  std::vector<double> history{0.0};
  double x = 0.0, v = 0.0, full = 0.0, parts = 1.0;
  OscillatorStep step(omega, damping, period / places);
  for (std::size_t k = 1; k < time.size(); ++k) {
    const double h = time[k] - time[k - 1];
    if (!(h > 0.0)) continue;
    // Times of even samples differ by rounding only.
    if (!(std::abs(h - full) <= same * h)) {
      full = h;
      parts = std::clamp(std::ceil(h * places / period), 1.0, most_parts);
      step = OscillatorStep(omega, damping, h / parts);
    }
    const double a = acceleration[k - 1], b = acceleration[k];
    for (double part = 0.0; part < parts; part += 1.0) {
      step.advance(x, v, a + (b - a) * part / parts, a + (b - a) * (part + 1.0) / parts);
      history.push_back(x);
    }
  }
  return history;
}

std::vector<double> response_spectrum(const MotionSeries& series, const std::vector<double>& periods,
                                      double damping) {
  std::vector<double> spectrum;
  for (const double period : periods) {
    const double omega = 2.0 * std::numbers::pi / period;
    double largest = 0.0;
    for (const double x : oscillator_history(series.time, series.acceleration, period, damping))
      largest = std::max(largest, std::abs(x));
    spectrum.push_back(omega * omega * largest);
  }
  return spectrum;
}

}  // namespace keyblock::loading
