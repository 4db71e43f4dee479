#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "dynamics/energy.h"
#include "dynamics/step.h"
#include "overlap/overlap.h"
#include "simulation/build_model.h"
#include "simulation/damage.h"
#include "simulation/run.h"

namespace keyblock::simulation {

constexpr double g = 9.81;                           // m/s²
constexpr double degree = std::numbers::pi / 180.0;  // rad

/// Of a line at so many degrees from the x axis.
inline Vec2 direction(double angle) {
  return {std::cos(angle * degree), std::sin(angle * degree)};
}

/// A small model of explicit blocks, for tests of mechanics and contact.
struct Scene {
  RunSetup setup;

  Scene(double young, double friction, double density = 2600.0) : young_(young), density_(density) {
    setup.joints.standard.friction = friction;
  }

  int add(Ring outer, bool fixed = false, int order = 1) {
    cutting::CutBlock block;
    block.polygon.outer = std::move(outer);
    orient(block.polygon);
    block.labels.emplace_back(block.polygon.outer.size());
    setup.system.blocks.push_back(std::move(block));
    BlockProperties properties;
    properties.name = "b" + std::to_string(setup.properties.size());
    properties.material = {density_, young_, 0.2, block::PlaneState::plane_stress};
    properties.fixed = fixed;
    properties.order = order;
    setup.properties.push_back(properties);
    return static_cast<int>(setup.properties.size()) - 1;
  }

  /// A rectangle of width w and height h whose lower left corner is at p, turned by `angle` degrees about p.
  int rectangle(Vec2 p, double w, double h, double angle = 0.0, bool fixed = false, int order = 1) {
    const double c = std::cos(angle * degree), s = std::sin(angle * degree);
    const Vec2 x{c, s}, y{-s, c};
    return add({p, p + w * x, p + w * x + h * y, p + h * y}, fixed, order);
  }

 private:
  double young_, density_;
};

inline record::Stage stage(const char* name, record::StageKind kind, double duration = 0.0) {
  record::Stage s;
  s.name = name;
  s.kind = kind;
  if (kind == record::StageKind::shake) s.motion = 0;
  if (kind == record::StageKind::rest) s.duration = duration;
  return s;
}

/// Has the bounds of friction found to the last digits in every step, so that any way to them ends at the same.
inline void settle_bounds(dynamics::SolverOptions& options) {
  options.bound_tolerance = options.bound_accuracy = 1e-10;
  options.max_bound_updates = 100;
}

/// Stops a run after a step.
struct Stopper final : record::RunObserver {
  explicit Stopper(long after_step) : after(after_step) {}
  void step(const record::StepRow& row) override { stop = row.step >= after; }

  std::atomic<bool> stop = false;
  long after;
};

struct AllContacts final : record::RunObserver {
  std::vector<record::ContactFrame> frames;
  void contacts(const record::ContactFrame& frame) override { frames.push_back(frame); }
};

struct LastHistory final : record::RunObserver {
  record::HistoryRow last;
  int rows = 0;
  void history(const record::HistoryRow& row) override {
    last = row;
    ++rows;
  }
};

/// Ground acceleration A sin ωt, integrated exactly over a step.
class Sine final : public dynamics::GroundAcceleration {
 public:
  Sine(Vec2 amplitude, double frequency) : a_(amplitude), omega_(2.0 * std::numbers::pi * frequency) {}
  [[nodiscard]] double omega() const { return omega_; }  ///< rad/s
  [[nodiscard]] Vec2 mean(double t0, double t1) const override {
    return (std::cos(omega_ * t0) - std::cos(omega_ * t1)) / (omega_ * (t1 - t0)) * a_;
  }
  [[nodiscard]] Vec2 at(double t) const override { return std::sin(omega_ * t) * a_; }

 private:
  Vec2 a_;
  double omega_;
};

/// A scene set in motion.
struct Simulator {
  explicit Simulator(const Scene& scene, int threads = 1)
      : model(build_model(scene.setup)),
        state(initial_state(scene.setup, model)),
        team(threads),
        stepper(model, team, profile) {
    stepper.start(state);
    initial_energy = energy();
  }

  [[nodiscard]] Vec2 centroid(int b) const {
    const dynamics::Block& block = model.blocks[static_cast<std::size_t>(b)];
    return Vec2{state.position[block.first], state.position[block.first + 1]} / std::sqrt(block.area);
  }
  [[nodiscard]] Vec2 velocity(int b) const {
    const dynamics::Block& block = model.blocks[static_cast<std::size_t>(b)];
    return Vec2{state.velocity[block.first], state.velocity[block.first + 1]} / std::sqrt(block.area);
  }
  /// rad/s.
  [[nodiscard]] double spin(int b) const {
    const dynamics::Block& block = model.blocks[static_cast<std::size_t>(b)];
    return block.pose.mean_spin(&state.velocity[block.first], &state.position[block.first]);
  }
  void run(double duration, double dt, const dynamics::GroundAcceleration* ground = nullptr) {
    const long steps = std::lround(duration / dt);
    for (long k = 0; k < steps; ++k) {
      const dynamics::StepReport report = stepper.advance(state, dt, ground);
      unconverged += !report.converged;
      retried += report.substeps > 1;
      iterations += report.iterations;
    }
  }
  [[nodiscard]] double energy() const {
    return dynamics::kinetic_energy(model, state) + dynamics::strain_energy(model, state) +
           dynamics::gravity_energy(model, state) + dynamics::spring_energy(state);
  }
  /// What the energy audit leaves unexplained, J.
  [[nodiscard]] double residual() const {
    return energy() - initial_energy + state.ledger.friction + state.ledger.damping + state.ledger.radiated -
           state.ledger.water + state.ledger.numerical - state.ledger.input;
  }

  dynamics::Model model;
  dynamics::State state;
  ThreadTeam team;
  Profile profile;
  dynamics::Stepper stepper;
  double initial_energy = 0.0;
  long unconverged = 0, retried = 0, iterations = 0;
};

/// m, the largest overlap there is in 0.15 s.
inline double largest_overlap_of(const Scene& scene, double dt) {
  Simulator s(scene);
  double largest = 0.0;
  for (int k = 0; k < 30; ++k) {
    s.run(0.005, dt);
    std::vector<Polygon> blocks;
    for (std::size_t b = 0; b < s.model.blocks.size(); ++b) blocks.push_back(deformed_polygon(s.model, b));
    largest = std::max(largest, overlap::largest_overlap(blocks).depth);
  }
  return largest;
}

}  // namespace keyblock::simulation
