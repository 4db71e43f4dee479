#include "dynamics/position_update.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/index.h"
#include "core/known_size.h"
#include "dynamics/energy.h"
#include "model/state_motion.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

/// Velocities and accelerations of a body.
void end_motion(const Attempt& attempt, const StepRules& rules, std::size_t b, State& state) {
  const Drive& drive = attempt.drive;
  const Body& block = attempt.model.body(b);
  const double* d = &attempt.increment[block.first];
  double* v = &state.velocity[block.first];
  with_known_size(block.size, [&](auto size) {
    const Integrator rule = rules.rule()[b];
    in_lanes(2 * size, [&](int k, int count) {
      const std::size_t i = block.first + at(k);
      const Motion end = drive.is_static
                             ? Motion{}
                             : rule.end(motion_of(state, i, count), load_first(d + k, count), drive.step);
      store_first(v + k, end.velocity, count);
      if (state.acceleration.empty()) return;
      store_first(&state.acceleration[i], end.acceleration, count);
      store_first(&state.force[i], end.force, count);
    });
  });
  if (!state.acceleration.empty()) state.acceleration_known[b] = !drive.is_static && !rules.is_in_impact(b);
}

void move_block(const Attempt& attempt, double spin, const StepRules& rules, std::size_t b, State& state) {
  end_motion(attempt, rules, b, state);
  const Block& block = attempt.model.blocks[b];
  block.pose.update(spin, &attempt.increment[block.first], &state.position[block.first],
                    &state.velocity[block.first]);
  if (state.acceleration.empty()) return;
  block.pose.rotate(spin, &state.acceleration[block.first]);
  block.pose.rotate(spin, &state.force[block.first]);
}

void move_line(const Attempt& attempt, const StepRules& rules, std::size_t b, State& state) {
  end_motion(attempt, rules, b, state);
  const Body& line = attempt.model.body(b);
  for (std::size_t k = line.first; k < line.first + 2 * at(line.size); ++k)
    state.position[k] += attempt.increment[k];
}

}  // namespace

void move_blocks(const Attempt& attempt, std::span<const double> spin, const StepRules& rules, State& state) {
  for_moving_blocks(attempt.model, attempt.team,
                    [&](std::size_t b) { move_block(attempt, spin[b], rules, b, state); });
  for (std::size_t b = attempt.model.blocks.size(); b < attempt.model.bodies(); ++b)
    move_line(attempt, rules, b, state);
}

void place_surface(Model& model, State& state, PredictedMotion& motion, ThreadTeam& team) {
  constexpr std::size_t worth_threads = 256;  // blocks
  contact::Surface& surface = model.surface;
  team.for_range(model.blocks.size(), worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Block& block = model.blocks[b];
      const std::size_t first = at(surface.block_begin[b]);
      double moved = 0.0, against_first = 0.0;
      Vec2 of_first;
      for_vertex_values(surface, b, block.size, &state.position[block.first], [&](std::size_t v, Vec2 x) {
        const Vec2 u = x - surface.position[v];
        if (v == first) of_first = u;
        const double squared = squared_norm(u);
        if (!(squared <= moved)) moved = squared;  // nor if it is not a number
        against_first = std::max(against_first, squared_norm(u - of_first));
        surface.position[v] = x;
      });
      state.moved[b] = std::sqrt(moved);
      motion.add_path(b, std::sqrt(against_first));
    }
  });
}

double work_of_loads(const Model& model, double time, std::span<const double> way) {
  double work = 0.0;
  for (std::size_t l = 0; l < model.loads.size(); ++l) {
    const GeneralizedLoad& load = model.loads[l];
    if (!model.moves(at(load.block))) continue;
    const double f = model.load_factor(l, time);
    const std::size_t first = model.blocks[at(load.block)].first;
    for (std::size_t k = 0; k < load.force.size(); ++k) work += f * load.force[k] * way[first + k];
  }
  return work;
}

double renew_support_energy(const Model& model, double time, State& state) {
  if (model.couplings.empty()) return 0.0;
  const double now = support_energy(model, state, time), gained = now - state.support_energy;
  state.support_energy = now;
  return gained;
}

double largest_move(const Model& model, const State& state, double time) {
  double most = 0.0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    if (!std::isfinite(state.moved[b])) {
      throw RunError("block " + std::to_string(b) + " has no finite position after the step to " +
                     std::to_string(time) +
                     " s, which does not converge; a shorter time.step or order 1 may help");
    }
    most = std::max(most, state.moved[b]);
  }
  return most;
}

}  // namespace keyblock::dynamics
