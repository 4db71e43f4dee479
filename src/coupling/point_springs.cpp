#include "coupling/point_springs.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/points.h"
#include "coupling/row_owners.h"
#include "model/drive.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

Vec2 position_of(const Model& model, const State& state, const MaterialPoint& point) {
  const Block& block = model.blocks[at(point.block)];
  return field_at(point.phi.data(), block.size, &state.position[block.first]);
}

}  // namespace

void PointSprings::add_pairs(BlockPairs& pairs) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) pairs.emplace_back(end(k, 0).block, end(k, 1).block);
}

/// Before a stage installs it, and where one of its blocks is excavated, a spring does nothing.
bool PointSprings::is_there(const Model& model, const State& state, std::size_t k) const {
  const int staged = springs_[k].staged;
  return (staged < 0 || state.installed[at(staged)] != 0) &&
         model.surface.present[at(end(k, 0).block)] != 0 && model.surface.present[at(end(k, 1).block)] != 0;
}

Vec2 PointSprings::chord(const Model& model, const State& state, std::size_t k) const {
  return position_of(model, state, end(k, 0)) - position_of(model, state, end(k, 1));
}

RowFacts PointSprings::build(const Model& model, const State& state, const Drive& drive,
                             std::span<const double> memory, CouplingRows out) const {
  RowFacts facts;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const std::size_t a = at(end(k, 0).block), b = at(end(k, 1).block);
    const Vec2 line = chord(model, state, k);
    const double length = norm(line);
    Row& row = out.rows[k];
    row.vertex = out.points.material_point(2 * k + out.first_point);
    row.from = row.to = row.vertex + 1;
    row.position = 0.0;
    row.unknown_a = out.points.body(a).unknown;
    row.unknown_b = out.points.body(b).unknown;
    row.pair = pair_in(state.pattern, row.unknown_a, row.unknown_b);
    if (length > 0.0) row.normal = {line.y / length, -line.x / length};
    row.moved = drive.prescribed.empty() ? Vec2{} : drive.prescribed[a] - drive.prescribed[b];
    out.owners.set(out.first + k, row.unknown_a, row.unknown_b);
    facts.lacks_room |= row.pair == Row::without_room;
    const PointSpring& spring = springs_[k];
    const double stretch = stretch_of(k, length, memory), force = force_of(model, k, stretch);
    if (length > 0.0 && is_there(model, state, k)) {
      out.springs.set_row(out.first + k, {.normal_stiffness = std::max(force, 0.0) / length,
                                          .shear_stiffness = stiffness_of(model, k),
                                          .largest_shear = spring.yield,
                                          .normal = -dot(row.normal, row.moved),
                                          .shear = stretch + dot(row.tangent(), row.moved)});
    } else {
      out.springs.set_row(out.first + k, {});
    }
  }
  return facts;
}

std::vector<PointSprings::Now> PointSprings::now(const Model& model, const State& state,
                                                 std::span<const double> memory) const {
  std::vector<Now> springs;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const double length = norm(chord(model, state, k)), stretch = stretch_of(k, length, memory);
    const bool there = is_there(model, state, k);
    springs.push_back({position_of(model, state, end(k, 0)), position_of(model, state, end(k, 1)), length,
                       stiffness_of(model, k), there ? force_of(model, k, stretch) : 0.0, there});
  }
  return springs;
}

void PointSprings::set_force(const Model& model, const State& state, std::size_t k, double force,
                             std::span<double> memory) const {
  memory[k] = norm(chord(model, state, k)) - springs_[k].length() - force / stiffness_of(model, k);
}

void PointSprings::install(const Model& model, const State& state, std::span<const std::uint8_t> now,
                           std::span<double> memory) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const int staged = springs_[k].staged;
    if (staged >= 0 && now[at(staged)] != 0)
      memory[k] = memory[installed(k)] = norm(chord(model, state, k)) - springs_[k].length();
  }
}

CouplingTotals PointSprings::account(const Attempt& attempt, std::span<const double> /*spin*/,
                                     std::size_t first, std::span<double> memory, State& state) const {
  const SpringArray& rows = attempt.problem.springs();
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const std::size_t c = first + k;
    if (rows.ks[c] == 0.0) continue;
    const Row& row = attempt.problem.rows()[c];
    const double stiffness = stiffness_of(attempt.model, k),
                 before = stretch_of(k, norm(chord(attempt.model, state, k)), memory);
    const SpringArray::Force force = rows.force(c);
    const Vec2 on_points = row.gradient(force);  // that stretches the spring
    const double elastic = force.shear / stiffness, beyond = rows.w[c] - elastic;
    const double stored_before = 0.5 * stiffness * before * before,
                 stored = 0.5 * stiffness * elastic * elastic, dissipated = std::abs(force.shear * beyond);
    memory[k] += beyond;
    if (std::abs(force.shear) >= springs_[k].yield) memory[yielded(k)] += beyond;
    state.support_energy += stored;
    state.ledger.friction += dissipated;
    const int moving = row.unknown_a >= 0 ? end(k, 0).block : end(k, 1).block;
    const double earlier = (1.0 - attempt.drive.end_share_of_work(moving)) *
                           dot(row.gradient({0.0, stiffness * before}) - on_points, row.moved);
    state.ledger.input += dot(on_points, row.moved) + earlier;
    state.ledger.numerical +=
        dot(on_points, attempt.relative[c]) - (stored - stored_before) - dissipated + earlier;
  }
  return {};
}

double PointSprings::stored_energy(const Model& model, const State& state, double /*time*/,
                                   std::span<const double> memory) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (!is_there(model, state, k)) continue;
    const double stretch = stretch_of(k, norm(chord(model, state, k)), memory);
    sum += 0.5 * stiffness_of(model, k) * stretch * stretch;
  }
  return sum;
}

std::vector<Element> PointSprings::elements() const {
  std::vector<Element> all;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const PointSpring& spring = springs_[k];
    all.push_back(
        {"spring", spring.name, spring.yield, {spring.from, end(k, 0).block}, {spring.to, end(k, 1).block}});
  }
  return all;
}

std::vector<Carried> PointSprings::carried(const Model& model, const State& state,
                                           std::span<const double> memory) const {
  std::vector<Carried> all;
  const std::vector<Now> springs = now(model, state, memory);
  for (std::size_t k = 0; k < springs.size(); ++k) {
    Carried& one = all.emplace_back(Carried{.from = springs[k].from, .to = springs[k].to});
    if (!springs[k].is_there) continue;
    one.present = true;
    one.force = springs[k].force;
    one.yielded = memory[yielded(k)];
    one.elongation = springs[k].length - springs_[k].length() - memory[installed(k)];
  }
  return all;
}

void PointSprings::add_rounding_forces(const Model& model, double extent, std::span<double> force) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    force[at(end(k, 0).block)] += stiffness_of(model, k) * extent;
    force[at(end(k, 1).block)] += stiffness_of(model, k) * extent;
  }
}

}  // namespace keyblock::dynamics
