#include "simulation/staged_opening.h"

#include <algorithm>

#include "core/index.h"
#include "coupling/facets.h"
#include "dynamics/forces_of_blocks.h"
#include "simulation/wall_faces.h"
#include "simulation/wall_movement.h"

namespace keyblock::simulation {

namespace {

bool contains(const std::vector<int>& numbers, int number) {
  return std::ranges::find(numbers, number) != numbers.end();
}

/// Pa, of a stage; as a factor where it is given over time.
double pressure_in(const SupportPressure& pressure, int stage) {
  if (!pressure.over_time.empty()) return 1.0;
  double now = pressure.constant;
  for (const auto& [from, value] : pressure.over_stages) {
    if (from <= stage) now = value;
  }
  return now;
}

/// What the water between the rock of an excavation and its wall does goes with the rock, too.
void keep_water(const dynamics::Model& model, int excavation, dynamics::State& state) {
  const dynamics::WaterOfModel water = dynamics::water_of(model, state);
  if (water.water == nullptr) return;
  for (const auto& [vertex, force] : water.water->wall_forces(model, state, water.memory, excavation))
    state.walls.forces.push_back({force, vertex, excavation});
}

}  // namespace

void StagedOpening::start(dynamics::State& state) const {
  if (!wall_loads(setup_, model_)) return;
  state.walls.released.assign(setup_.excavations.size(), 1.0);
  state.walls.pressure.assign(setup_.excavations.size(), 0.0);
  state.walls.left.assign(model_.blocks.size(), 0);
}

void StagedOpening::keep_forces(const record::Stage& stage, dynamics::State& state,
                                dynamics::Stepper& stepper) const {
  if (!is_used(state)) return;
  std::vector<std::uint8_t> goes(model_.blocks.size(), 0);
  for (std::size_t b = 0; b < setup_.system.blocks.size(); ++b) {
    const std::vector<int>& inside = setup_.system.blocks[b].excavations;
    goes[b] = std::ranges::any_of(inside, [&](int e) { return contains(stage.excavate, e); });
  }
  const dynamics::StepProblem* problem = nullptr;
  std::vector<std::uint8_t> seen(model_.blocks.size(), 0);
  for (const auto& [e, target] : stage.release) {
    if (!contains(stage.excavate, e)) continue;
    if (problem == nullptr) problem = &stepper.find_forces(state);
    std::vector<std::uint8_t> sources(model_.blocks.size(), 0);
    for (std::size_t b = 0; b < setup_.system.blocks.size(); ++b) {
      sources[b] = seen[b] == 0 && contains(setup_.system.blocks[b].excavations, e);
      seen[b] = seen[b] != 0 || sources[b] != 0;
    }
    const std::vector<Vec2> forces =
        dynamics::forces_of_blocks(model_, *problem, stepper.contacts(), sources);
    for (std::size_t v = 0; v < forces.size(); ++v) {
      const std::size_t b = at(model_.surface.block[v]);
      if (forces[v] != Vec2{} && model_.moves(b) && goes[b] == 0)
        state.walls.forces.push_back({forces[v], static_cast<int>(v), e});
    }
    keep_water(model_, e, state);
  }
  std::erase_if(state.walls.forces, [&](const dynamics::WallForce& force) {
    return goes[at(model_.surface.block[at(force.vertex)])] != 0;
  });
}

void StagedOpening::begin_stage(int index, dynamics::State& state) {
  if (!is_used(state)) return;
  const record::Stage& stage = setup_.stages[at(index)];
  const std::size_t excavations = setup_.excavations.size();
  memory_.points.clear();
  memory_.part = 1;
  memory_.start.resize(excavations);
  for (const auto& [e, target] : stage.release) {
    if (!contains(stage.excavate, e)) continue;
    state.walls.released[at(e)] = 0.0;
    memory_.start[at(e)] = ends_of(wall_faces(setup_, model_, at(e)), model_);
    record(e, state);
  }
  memory_.before = state.walls.released;
  release(stage, state);
  std::vector<std::uint8_t> is_open(excavations, 0);
  for (int k = 0; k <= index; ++k) {
    for (const int e : setup_.stages[at(k)].excavate) is_open[at(e)] = 1;
  }
  for (std::size_t e = 0; e < excavations; ++e)
    state.walls.pressure[e] = is_open[e] != 0 ? pressure_in(setup_.excavations[e].pressure, index) : 0.0;
}

int StagedOpening::parts(const record::Stage& stage) const {
  const bool changes = std::ranges::any_of(
      stage.release, [&](const auto& of) { return of.second != memory_.before[at(of.first)]; });
  return changes ? stage.release_steps : 1;
}

void StagedOpening::release(const record::Stage& stage, dynamics::State& state) const {
  const int all = parts(stage);
  for (const auto& [e, target] : stage.release) {
    const double before = memory_.before[at(e)];
    state.walls.released[at(e)] =
        memory_.part == all ? target : before + (target - before) * memory_.part / all;
  }
}

bool StagedOpening::go_on(const record::Stage& stage, dynamics::State& state,
                          const dynamics::Stepper& stepper) {
  if (!is_used(state)) return false;
  if (drop_free(state, stepper)) return true;
  if (memory_.part >= parts(stage)) return false;
  record_all(state);
  ++memory_.part;
  release(stage, state);
  return true;
}

void StagedOpening::record(int excavation, const dynamics::State& state) {
  const std::size_t e = at(excavation);
  const Vec2 centre = centroid({setup_.excavations[e].outline, {}});
  const WallMovement moved = movement_of(wall_faces(setup_, model_, e), model_, centre, memory_.start[e]);
  memory_.points.push_back(
      {state.step, state.walls.released[e], moved.crown, moved.springline, moved.mean, excavation});
}

void StagedOpening::record_all(const dynamics::State& state) {
  for (std::size_t e = 0; e < memory_.start.size(); ++e) {
    if (!memory_.start[e].empty()) record(static_cast<int>(e), state);
  }
}

std::vector<record::ReleasePoint> StagedOpening::end_stage(const dynamics::State& state) {
  if (!is_used(state)) return {};
  record_all(state);
  return std::move(memory_.points);
}

void StagedOpening::drop_moved(const DamageGauge& gauge, dynamics::State& state) const {
  if (!is_used(state) || !gauge.started()) return;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (state.walls.left[b] == 0 && model_.moves(b) && gauge.is_beyond_fall(b, state))
      state.walls.left[b] = 1;
  }
}

bool StagedOpening::drop_free(dynamics::State& state, const dynamics::Stepper& stepper) const {
  std::vector<std::uint8_t> is_pressed(model_.blocks.size(), 0);
  const std::vector<dynamics::ContactForce> forces = stepper.forces();
  for (std::size_t k = 0; k < forces.size(); ++k) {
    if (forces[k].state == contact::State::open) continue;
    const contact::Contact& contact = stepper.contacts()[k];
    is_pressed[at(contact.block_a)] = is_pressed[at(contact.block_b)] = 1;
  }
  bool drops = false;
  for (const dynamics::WallForce& force : state.walls.forces) {
    const std::size_t b = at(model_.surface.block[at(force.vertex)]);
    if (is_pressed[b] != 0 || state.walls.left[b] != 0) continue;
    state.walls.left[b] = 1;
    drops = true;
  }
  return drops;
}

}  // namespace keyblock::simulation
