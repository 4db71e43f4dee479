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
constexpr double ratio = 0.02;       // of critical, of the column that a record moves
constexpr double parts = 4.0;        // of a step of the run, in which it does

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
  RecordColumn(const simulation::Boundary& boundary, double base, double ground)
      : boundary_(boundary),
        column_(boundary.layers, base, ground, std::nullopt, boundary.fastest, viscosity(base, ground)),
        base_(column_.place_of(base)) {}

  GroundMotion outcrop_of(const GroundMotion& record, double dt) const {
    const auto rule = dynamics::Integrator::average_acceleration();
    std::vector<double> memory(column_.memory_size(), 0.0), times{0.0};
    std::vector<Vec2> accelerations{{}};
    Vec2 before = record.velocity(0.0);
    for (double k = 0.0; (k + 0.5) * dt < record.duration(); ++k) {
      std::vector<double> after(memory.size());
      column_.step(memory, dt, rule, record.mean(k * dt, (k + 1.0) * dt), after);
      const RockColumn::Stress stress = column_.stress(column_.strained(memory, dt, after), base_);
      memory = std::move(after);
      const Vec2 now = record.velocity((k + 1.0) * dt) -
                       Vec2{stress.xy / boundary_.dashpots.x, stress.yy / boundary_.dashpots.y};
      times.push_back((k + 0.5) * dt);
      accelerations.push_back((now - before) / dt);
      before = now;
    }
    if (times.back() < record.duration()) {
      times.push_back(record.duration());
      accelerations.push_back(accelerations.back());
    }
    return {record.name(), std::move(times), std::move(accelerations)};
  }

 private:
  /// s, β of the ratio at the first frequency of shear.
  [[nodiscard]] double viscosity(double base, double ground) const {
    double travel = 0.0, high = ground;
    for (std::size_t k = 0; k < boundary_.layers.size(); ++k) {
      const double low = std::max(base, k + 1 < boundary_.layers.size() ? boundary_.layers[k + 1].top : base);
      if (low >= high) continue;
      travel += (high - low) / boundary_.layers[k].speeds().x;
      high = low;
    }
    return ratio * 4.0 * travel / std::numbers::pi;
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
    motion = RecordColumn(*setup.boundary, ground - depth, ground)
                 .outcrop_of(motion, least_step(motion, setup.time_step) / parts);
  }
}

}  // namespace keyblock::scenario
