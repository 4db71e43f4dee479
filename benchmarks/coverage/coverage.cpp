#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "statistics/fragility.h"

/// How often 95 % intervals of a fragility curve hold what it was drawn from. Capacities are ln C = G + R + E, of rock mass, record and pair; five
/// intensities, e^−0.9 … e^0.9; each rock mass sees some of the records, in rotation. The rate is that of a hazard x^−2.
namespace {

using namespace keyblock::statistics;

constexpr int studies = 500;
constexpr double levels[] = {-0.9, -0.45, 0.0, 0.45, 0.9};

struct Design {
  int rocks, records, each;
  double rock, record, rest;
};

double draw(const Design& d, int study, std::uint32_t what, int who) {
  const auto seed = static_cast<std::uint64_t>(1000 * d.rocks + d.records);
  const keyblock::RandomStream stream(seed, static_cast<std::uint32_t>(study), what,
                                      static_cast<std::uint32_t>(who));
  return keyblock::inverse_normal_cdf(stream.uniform(0));
}

int record_of(const Design& d, int rock, int q) {
  if (d.records == 1 || d.each == d.records) return q;
  return (rock + (q == 0 ? 0 : 1 + (q - 1 + rock / d.records) % (d.records - 1))) % d.records;
}

std::vector<Observation> drawn(const Design& d, int study) {
  std::vector<Observation> runs;
  for (int i = 0; i < d.rocks; ++i) {
    for (int q = 0; q < d.each; ++q) {
      const int j = record_of(d, i, q);
      const double capacity = d.rock * draw(d, study, 1, i) + d.record * draw(d, study, 2, j) +
                              d.rest * draw(d, study, 3, i * d.records + j);
      for (const double u : levels) runs.push_back({std::exp(u), u > capacity, i, j});
    }
  }
  return runs;
}

bool holds(const Estimate& e, double x) {
  return e.low <= x && x <= e.high;
}

void tell(const Design& d) {
  const double variance = d.rock * d.rock + d.record * d.record + d.rest * d.rest;
  int fitted = 0, theta = 0, beta = 0, rate = 0;
  for (int s = 0; s < studies; ++s) {
    FragilityLimits none;
    none.widest_theta = none.widest_beta = HUGE_VAL;
    const FragilityCurve curve = fragility_curve(drawn(d, s), {}, 0.95, none);
    if (curve.status != FragilityStatus::fitted) continue;
    const auto log_rate = [](const FragilityFit& f) {
      return -2.0 * std::log(f.theta) + 2.0 * f.beta * f.beta;
    };
    ++fitted;
    theta += holds(curve.theta, 1.0) ? 1 : 0;
    beta += holds(curve.beta, std::sqrt(variance)) ? 1 : 0;
    rate += holds(two_way_interval(log_rate(curve.fit), curve.refits.numbers(log_rate), 0.95), 2.0 * variance)
                ? 1
                : 0;
  }
  const auto share = [&](int count) { return 100.0 * count / fitted; };
  fmt::print("| {} × {} ({}) | {} / {} / {} | {:.0f} % | {:.0f} % | {:.0f} % |\n", d.rocks, d.records, d.each,
             d.rock, d.record, d.rest, share(theta), share(beta), share(rate));
}

}  // namespace

int main() {
  fmt::print(
      "| realizations × records (each sees) | σ of rock / record / pair | θ | β | rate "
      "|\n|---|---|---|---|---|\n");
  for (const Design& d : {Design{100, 1, 1, 0.35, 0.30, 0.20}, Design{20, 3, 3, 0.35, 0.30, 0.20},
                          Design{20, 11, 11, 0.35, 0.30, 0.20}, Design{40, 20, 2, 0.35, 0.30, 0.20},
                          Design{66, 11, 2, 0.35, 0.30, 0.20}, Design{154, 22, 1, 0.35, 0.30, 0.20},
                          Design{50, 10, 2, 0.5, 0.2, 0.1}, Design{50, 10, 2, 0.2, 0.5, 0.1}})
    tell(d);
  return 0;
}
