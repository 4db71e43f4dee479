#include "scenario/motion_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenario/key_path.h"
#include "simulation/build_boundary.h"

namespace keyblock::scenario {
namespace {

using dynamics::RockColumn;
using loading::GroundMotion;

constexpr double same_depth = 0.05;  // share by which the depth of a record and of the base may differ
constexpr double ratio = 0.01;       // of critical, of the column that a record moves, at its first frequency
constexpr int parts = 4;             // of a sample, in which it does

double least_step(const GroundMotion& motion, double step) {
  for (std::size_t k = 1; k < motion.times().size(); ++k) {
    const double sampling = motion.times()[k] - motion.times()[k - 1];
    if (sampling > 0.0) step = std::min(step, sampling);
  }
  return step;
}

/// The column that a record at its base moves.
class RecordColumn {
 public:
  /// viscosity: s, that of the rock of the model.
  RecordColumn(const simulation::Boundary& boundary, double base, double ground, double viscosity)
      : boundary_(boundary),
        column_(boundary.layers, base, ground, std::nullopt, boundary.fastest,
                {.viscosity = viscosity, .drag = drag(base, ground)}),
        base_(column_.place_of(base)) {}

  /// sampling: s, of the outcrop, whose acceleration is that of the time around each sample.
  GroundMotion outcrop_of(const GroundMotion& record, double sampling) const {
    const auto rule = dynamics::Integrator::average_acceleration();
    const double dt = sampling / parts;
    std::vector<double> memory(column_.memory_size(), 0.0), after(memory.size()), times{0.0};
    std::vector<Vec2> accelerations{{}};
    Vec2 of_record, now, last_but_one;  // m/s; of the ground at the base, and of the outcrop
    for (int k = 0; (k + 0.5) * dt < record.duration(); ++k) {
      const double end = (k + 1) * dt;
      const Vec2 acceleration = record.mean(k * dt, end), before = now;
      column_.step(memory, dt, rule, acceleration, after);
      const RockColumn::Stress stress = column_.stress(column_.strained(memory, dt, after), base_);
      std::swap(memory, after);
      of_record += dt * acceleration;
      now = of_record - Vec2{stress.xy / boundary_.dashpots.x, stress.yy / boundary_.dashpots.y};
      if (k % parts == 0 && k > 0) {
        times.push_back(k * dt);
        accelerations.push_back((now - last_but_one) / (2.0 * dt));
      }
      last_but_one = before;
    }
    if (times.back() < record.duration()) {
      times.push_back(record.duration());
      accelerations.push_back(accelerations.back());
    }
    return {record.name(), std::move(times), std::move(accelerations)};
  }

 private:
  /// 1/s, a = 2 ζ ω₁ with ω₁ = π/2T, T: s that waves of shear take from the base to the ground.
  [[nodiscard]] double drag(double base, double ground) const {
    double travel = 0.0, high = ground;
    for (std::size_t k = 0; k < boundary_.layers.size(); ++k) {
      const double low = std::max(base, k + 1 < boundary_.layers.size() ? boundary_.layers[k + 1].top : base);
      if (low >= high) continue;
      travel += (high - low) / boundary_.layers[k].speeds().x;
      high = low;
    }
    return ratio * std::numbers::pi / travel;
  }

  const simulation::Boundary& boundary_;
  RockColumn column_;
  RockColumn::Place base_;
};

[[noreturn]] void fail_at_depth(const Scenario& scenario, const MotionSpec& spec, double base,
                                const char* expected) {
  const std::string key = join_path(spec.path, "depth");
  throw InputError(Diagnostic{
      scenario.where(key), key,
      fmt::format("{:.4g} m, with the base {:.4g} m below the ground", *spec.depth, base), expected, ""});
}

}  // namespace

void take_to_base(const Scenario& scenario, simulation::RunSetup& setup) {
  for (std::size_t k = 0; k < setup.motions.size(); ++k) {
    const MotionSpec& spec = scenario.motions[k];
    GroundMotion& motion = setup.motions[k];
    if (spec.place == MotionPlace::inside || spec.place == MotionPlace::incident) {
      motion = motion.scaled(2.0);
    }
    if (spec.place != MotionPlace::within || !setup.boundary) continue;
    const auto [base, ground] = simulation::column_heights(setup, simulation::ColumnSide::left);
    const double of_model = ground - base, depth = *spec.depth;
    if (!setup.boundary->compliant) {
      if (std::abs(depth - of_model) > same_depth * of_model)
        fail_at_depth(scenario, spec, of_model, "a record at the depth of the rigid base, which it moves");
      continue;
    }
    if (depth < (1.0 - same_depth) * of_model)
      fail_at_depth(scenario, spec, of_model, "a record at the base of the model or deeper");
    motion = RecordColumn(*setup.boundary, ground - depth, ground, setup.solver.stiffness_time())
                 .outcrop_of(motion, least_step(motion, setup.time_step));
  }
}

}  // namespace keyblock::scenario
