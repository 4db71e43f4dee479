#include "coupling/point_springs.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/points.h"
#include "coupling/row_owners.h"
#include "coupling/step_problem.h"
#include "model/drive.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

/// Of the strength of a dowel, that a change of its bound has to be worth a minimization.
constexpr double settled_bound = 1e-3;

Vec2 value_of(const Model& model, const std::vector<double>& coefficients, const MaterialPoint& point) {
  const Body& body = model.body(at(point.block));
  return field_at(point.phi.data(), body.size, &coefficients[body.first]);
}

Vec2 position_of(const Model& model, const State& state, const MaterialPoint& point) {
  return value_of(model, state.position, point);
}

Vec2 unit(Vec2 v) {
  const double length = norm(v);
  return length > 0.0 ? v / length : Vec2{};
}

/// Integrator::place_of_spring between two blocks.
double place_of(const Drive& drive, std::size_t moving, double stiffness, const Points::Body& a,
                const Points::Body& b) {
  if (drive.is_static) return 1.0;
  const double slowness = (a.mass > 0.0 ? 1.0 / a.mass : 0.0) + (b.mass > 0.0 ? 1.0 / b.mass : 0.0);
  return drive.rule[moving].place_of_spring(stiffness * drive.step * drive.step * slowness);
}

}  // namespace

void PointSprings::add_pairs(BlockPairs& pairs) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) pairs.emplace_back(end(k, 0).block, end(k, 1).block);
}

/// Before a stage installs it, after it has broken, and where one of its blocks is excavated, a spring does nothing.
bool PointSprings::is_there(const Model& model, const State& state, std::size_t k,
                            std::span<const double> memory) const {
  const int staged = springs_[k].staged;
  return (staged < 0 || state.installed[at(staged)] != 0) && model.surface.present[at(block_of(k, 0))] != 0 &&
         model.surface.present[at(block_of(k, 1))] != 0 && !is_broken(k, memory);
}

PointSprings::Line PointSprings::line_of(const Model& model, const State& state, std::size_t k) const {
  const auto place = [&](std::size_t spring, std::size_t which) {
    return position_of(model, state, end(spring, which));
  };
  const Vec2 from = place(k, 0), apart = from - place(k, 1);
  if (springs_[k].has_own_line()) return {unit(apart), norm(apart)};
  if (springs_[k].along >= 0) {
    const std::size_t bar = at(springs_[k].along);
    Line line{unit(place(bar, 1) - place(bar, 0))};
    line.length = dot(line.along, apart);
    line.aside = -dot(line.normal(), apart);
    return line;
  }
  const Vec2 axis = unit(unit(position_of(model, state, hole(k, 0)) - from) +
                         unit(place(k, 1) - position_of(model, state, hole(k, 1)))),
             along{-axis.y, axis.x};
  return {along, dot(along, apart)};
}

double PointSprings::strength_across(std::size_t k, double along) const {
  const double share = along / springs_[k].yield_along;
  return springs_[k].yield * std::sqrt(std::max(1.0 - share * share, 0.0));
}

RowFacts PointSprings::build(const Model& model, const State& state, const Drive& drive,
                             std::span<const double> memory, CouplingRows out) const {
  RowFacts facts{.may_change_laws = has_events_};
  std::vector<double> forces(springs_.size());  // along, for dowels, which come after their bars
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const std::size_t a = at(end(k, 0).block), b = at(end(k, 1).block);
    const Line line = line_of(model, state, k);
    Row& row = out.rows[k];
    row.vertex = out.points.material_point(2 * k + out.first_point);
    row.from = row.to = row.vertex + 1;
    row.position = 0.0;
    row.unknown_a = out.points.body(a).unknown;
    row.unknown_b = out.points.body(b).unknown;
    row.pair = pair_in(state.pattern, row.unknown_a, row.unknown_b);
    if (line.along != Vec2{}) row.normal = line.normal();
    row.moved = drive.prescribed.empty() ? Vec2{} : drive.prescribed[a] - drive.prescribed[b];
    out.owners.set(out.first + k, row.unknown_a, row.unknown_b);
    facts.lacks_room |= row.pair == Row::without_room;
    if (line.along == Vec2{} || !is_there(model, state, k, memory)) {
      out.springs.set_row(out.first + k, {});
      continue;
    }
    const PointSpring& spring = springs_[k];
    const bool is_dowel = spring.across >= 0;
    const double stretch = stretch_of(model, k, line.length, memory), stiffness = stiffness_of(model, k),
                 place = place_of(drive, row.unknown_a >= 0 ? a : b, stiffness, out.points.body(a),
                                  out.points.body(b)),
                 most = is_dowel ? strength_across(k, forces[bar_of(k)]) : spring.yield;
    forces[k] = force_of(model, k, stretch);
    facts.may_change_laws |= is_dowel && std::isfinite(spring.yield_along);
    out.springs.set_row(
        out.first + k,
        {.normal_stiffness =
             spring.has_own_line() ? place * std::max(forces[k], 0.0) / line.length : spring.hold,
         .shear_stiffness = place * stiffness,
         .least_shear = is_dowel ? -most : spring.least(),
         .largest_shear = most,
         .normal = (spring.hold > 0.0 ? line.aside : 0.0) - dot(row.normal, row.moved),
         .shear = stretch / place + dot(row.tangent(), row.moved)});
  }
  return facts;
}

/// before: m, what it was stretched by at the start of the step.
PointSprings::End PointSprings::end_of(const StepProblem& problem, std::size_t first, std::size_t k,
                                       double before) const {
  const SpringArray& rows = problem.springs();
  const std::size_t c = first + k;
  const double stiffness = stiffness_of(problem.model(), k), place = rows.ks[c] / stiffness,
               stretch = rows.w[c] + (before - before / place);
  if (breaks(rows, first, k)) return {};
  const double force = std::clamp(stiffness * stretch, rows.least[c], rows.bound[c]);
  const bool is_slack = springs_[k].pulls_only && stretch < 0.0;
  return {force, is_slack ? 0.0 : stretch - force / stiffness};
}

void PointSprings::change_laws(const StepProblem& problem, std::size_t first, std::span<const double> memory,
                               std::vector<LawChange>& changes) const {
  const SpringArray& rows = problem.springs();
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (rows.ks[first + k] == 0.0) continue;
    if (springs_[k].across >= 0) {
      change_dowel(rows, first, k, changes);
    } else {
      change_bar(problem, first, k, memory, changes);
    }
  }
}

/// Its strength is that beside the force of its bar, and nothing where the bar is broken.
void PointSprings::change_dowel(const SpringArray& rows, std::size_t first, std::size_t k,
                                std::vector<LawChange>& changes) const {
  const std::size_t c = first + k;
  const bool is_off = breaks(rows, first, k);
  const double bound = is_off ? 0.0 : strength_across(k, rows.force(first + bar_of(k)).shear);
  if (std::abs(bound - rows.bound[c]) > settled_bound * springs_[k].yield || (is_off && rows.bound[c] > 0.0))
    changes.push_back({c, is_off ? HUGE_VAL : 0.0, -bound, bound});
}

/// It breaks where it has yielded by more than it can.
void PointSprings::change_bar(const StepProblem& problem, std::size_t first, std::size_t k,
                              std::span<const double> memory, std::vector<LawChange>& changes) const {
  const double rupture = springs_[k].rupture;
  if (std::isinf(rupture) || breaks(problem.springs(), first, k) || is_held(k, memory)) return;
  const double before = stretch_of(problem.model(), problem.state(), k, memory),
               yields = std::abs(memory[yielded(k)] + end_of(problem, first, k, before).beyond);
  if (yields > rupture) changes.push_back({first + k, yields / rupture - 1.0, 0.0, 0.0});
}

std::vector<PointSprings::Now> PointSprings::now(const Model& model, const State& state,
                                                 std::span<const double> memory) const {
  std::vector<Now> springs;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const double length = line_of(model, state, k).length, stretch = stretch_of(model, k, length, memory);
    const bool there = is_there(model, state, k, memory);
    springs.push_back({position_of(model, state, end(k, 0)), position_of(model, state, end(k, 1)), length,
                       stiffness_of(model, k), there ? force_of(model, k, stretch) : 0.0, there});
  }
  return springs;
}

void PointSprings::set_force(const Model& model, const State& state, std::size_t k, double force,
                             std::span<double> memory) const {
  memory[k] = line_of(model, state, k).length - springs_[k].length() - force / stiffness_of(model, k);
}

void PointSprings::place_node(const Model& model, State& state, std::size_t k) const {
  const MaterialPoint& node = end(k, 0);
  const Body& line = model.body(at(node.block));
  const Vec2 place = position_of(model, state, end(k, 1)),
             velocity = value_of(model, state.velocity, end(k, 1));
  for (std::size_t i = 0; i < node.phi.size(); ++i) {
    if (node.phi[i] == 0.0) continue;
    const std::size_t c = line.first + 2 * i;
    state.position[c] = place.x / node.phi[i];
    state.position[c + 1] = place.y / node.phi[i];
    state.velocity[c] = velocity.x / node.phi[i];
    state.velocity[c + 1] = velocity.y / node.phi[i];
  }
}

void PointSprings::place(const Model& model, State& state) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (springs_[k].along >= 0) place_node(model, state, k);
  }
}

void PointSprings::install(const Model& model, State& state, std::span<const std::uint8_t> now,
                           std::span<double> memory) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (is_installed_by(k, now) && springs_[k].along >= 0) place_node(model, state, k);
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (!is_installed_by(k, now)) continue;
    memory[k] = memory[installed(k)] = line_of(model, state, k).length - springs_[k].length();
    if (springs_[k].pretension > 0.0) memory[held(k)] = 1.0;
  }
}

void PointSprings::end_stage(const Model& model, const State& state, std::span<double> memory) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (!is_held(k, memory)) continue;
    memory[held(k)] = 0.0;
    set_force(model, state, k, springs_[k].pretension, memory);
  }
}

CouplingTotals PointSprings::account(const Attempt& attempt, std::span<const double> /*spin*/,
                                     std::size_t first, std::span<double> memory, State& state) const {
  const SpringArray& rows = attempt.problem.springs();
  const Model& model = attempt.model;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const std::size_t c = first + k;
    if (rows.ks[c] == 0.0) continue;
    const Row& row = attempt.problem.rows()[c];
    const Line line = line_of(model, attempt.state, k);
    const double stiffness = stiffness_of(model, k), before = stretch_of(model, k, line.length, memory),
                 aside = springs_[k].hold > 0.0 ? rows.y[c] : 0.0;
    const End end = end_of(attempt.problem, first, k, before);
    const Vec2 on_points = row.gradient(rows.force(c));  // that stretches the spring
    const bool breaks_now = breaks(rows, first, k);
    const double stored_before = energy_of(model, k, line, memory),
                 stored = 0.5 * end.force * end.force / stiffness + 0.5 * springs_[k].hold * aside * aside,
                 dissipated = breaks_now ? stored_before : std::abs(end.force * end.beyond);
    memory[k] += end.beyond;
    if (end.force <= rows.least[c] || end.force >= rows.bound[c]) memory[yielded(k)] += end.beyond;
    if (breaks_now) memory[broken(bar_of(k))] = 1.0;
    state.support_energy += stored;
    state.ledger.friction += dissipated;
    const int moving = row.unknown_a >= 0 ? this->end(k, 0).block : this->end(k, 1).block;
    const double earlier = (1.0 - attempt.drive.end_share_of_work(moving)) *
                           dot(row.gradient({0.0, force_of(model, k, before)}) - on_points, row.moved);
    state.ledger.input += dot(on_points, row.moved) + earlier;
    state.ledger.numerical +=
        dot(on_points, attempt.relative[c]) - (stored - stored_before) - dissipated + earlier;
    if (!is_held(k, memory)) continue;
    // The jack brings it back to the force that was asked for.
    const double by_jack = energy_of(model, k, springs_[k].pretension / stiffness) - stored;
    state.support_energy += by_jack;
    state.ledger.input += by_jack;
  }
  return {};
}

double PointSprings::stored_energy(const Model& model, const State& state, double /*time*/,
                                   std::span<const double> memory) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    if (is_there(model, state, k, memory)) sum += energy_of(model, k, line_of(model, state, k), memory);
  }
  return sum;
}

std::vector<Element> PointSprings::elements() const {
  std::vector<Element> all;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const PointSpring& spring = springs_[k];
    all.push_back({.kind = spring.kind,
                   .name = spring.name,
                   .limit = spring.along < 0 ? spring.yield : HUGE_VAL,
                   .from = {spring.from, block_of(k, 0)},
                   .to = {spring.to, block_of(k, 1)},
                   .spacing = spring.spacing,
                   .may_rupture = std::isfinite(spring.rupture)});
  }
  return all;
}

std::vector<Carried> PointSprings::carried(const Model& model, const State& state,
                                           std::span<const double> memory) const {
  std::vector<Carried> all;
  const std::vector<Now> springs = now(model, state, memory);
  for (std::size_t k = 0; k < springs.size(); ++k) {
    Carried& one = all.emplace_back(Carried{.from = springs[k].from, .to = springs[k].to});
    if (!drawn_.empty()) {
      one.from = position_of(model, state, drawn_[2 * k]);
      one.to = position_of(model, state, drawn_[2 * k + 1]);
    }
    one.ruptured = is_broken(k, memory);
    one.yielded = springs[k].is_there || one.ruptured ? memory[yielded(k)] : 0.0;
    if (!springs[k].is_there) continue;
    one.present = true;
    one.force = springs[k].force;
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
