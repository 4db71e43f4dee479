// What liners carry, and where their energy goes.
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/liner_coupling.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

using loading::SectionForce;

SpringArray::Force LinerCoupling::link_force(std::size_t link, Way way, Bond bond) const {
  const loading::Liner& liner = liner_of(links_[link].station);
  const double length = links_[link].length;
  SpringArray::Force force{-liner.normal_stiffness * length * way.out,
                           liner.shear_stiffness * length * way.along};
  if (bond == Bond::held) return force;
  force.normal = std::max(force.normal, 0.0);
  const double bound = liner.friction * force.normal;
  force.shear = std::clamp(force.shear, -bound, bound);
  return force;
}

double LinerCoupling::link_energy(std::size_t link, Way way, Bond bond) const {
  const loading::Liner& liner = liner_of(links_[link].station);
  const SpringArray::Force force = link_force(link, way, bond);
  const double kn = liner.normal_stiffness * links_[link].length,
               ks = liner.shear_stiffness * links_[link].length;
  return 0.5 * force.normal * force.normal / kn + (ks > 0.0 ? 0.5 * force.shear * force.shear / ks : 0.0);
}

void LinerCoupling::account_for_bar(const Attempt& attempt, std::size_t first, std::size_t bar,
                                    std::span<const double> memory, State& state) const {
  if (!is_there(attempt.state, beams_[bar / bars_of_beam].from)) return;
  const SpringArray& rows = attempt.problem.springs();
  const std::size_t c = first + bar;
  const Row& row = attempt.problem.rows()[c];
  const double stiffness = rows.ks[c], before = stretch_of(attempt.model, attempt.state, bar, memory),
               stored = 0.5 * stiffness * rows.w[c] * rows.w[c];
  state.support_energy += stored;
  state.ledger.numerical +=
      dot(row.gradient(rows.force(c)), attempt.relative[c]) - (stored - 0.5 * stiffness * before * before);
}

void LinerCoupling::account_for_link(const Attempt& attempt, std::size_t first, std::size_t l,
                                     std::span<double> memory, State& state) const {
  if (!holds(attempt.model, attempt.state, l, memory)) return;
  const SpringArray& rows = attempt.problem.springs();
  const std::size_t c = first + bars() + l, s = links_[l].station;
  const Row& row = attempt.problem.rows()[c];
  const Bond was = bond_of(l, memory), is = rows.is_tensile(c) ? Bond::held : Bond::broken;
  const double before = link_energy(l, way_since(attempt.model, attempt.state, l, row.normal, memory), was);
  const SpringArray::Force force = rows.force(c);
  const double shear_stretch = rows.ks[c] > 0.0 ? force.shear / rows.ks[c] : rows.w[c],
               slip = is == Bond::held ? 0.0 : rows.w[c] - shear_stretch;
  double stored = link_energy(l, {-rows.y[c], shear_stretch}, is), dissipated = std::abs(force.shear * slip);
  if (was == Bond::held && is == Bond::broken) dissipated = std::max(dissipated, before - stored);
  memory[at_link(l, 2)] += slip;
  memory[at_link(l, 3)] = static_cast<double>(is);
  // A bond that has come so far along the liner is none any more.
  if (std::abs(memory[at_link(l, 2)]) > 0.5 * stations_[s].length) {
    memory[at_link(l, 3)] = static_cast<double>(Bond::gone);
    dissipated += stored;
    stored = 0.0;
  }
  const Vec2 on_points = row.gradient(force);
  const int moving = row.unknown_a >= 0 ? links_[l].rock.block : stations_[s].body;
  const SpringArray::Force at_start =
      link_force(l, way_since(attempt.model, attempt.state, l, row.normal, memory), was);
  const double earlier =
      (1.0 - attempt.drive.end_share_of_work(moving)) * dot(row.gradient(at_start) - on_points, row.moved);
  state.support_energy += stored;
  state.ledger.friction += dissipated;
  state.ledger.input += dot(on_points, row.moved) + earlier;
  state.ledger.numerical += dot(on_points, attempt.relative[c]) - (stored - before) - dissipated + earlier;
}

/// Its weight, and its strut.
void LinerCoupling::account_for_station(const Attempt& attempt, std::size_t s, State& state) const {
  if (!is_there(attempt.state, s)) return;
  const Model& model = attempt.model;
  const Drive& drive = attempt.drive;
  const auto moved = [&](std::size_t which) {
    const MaterialPoint& node = points_[point_of(s, which)];
    const Body& body = model.body(at(node.block));
    return field_at(node.phi.data(), body.size, &attempt.increment[body.first]);
  };
  const Vec2 outer = moved(0), inner = moved(1);
  const double mass = liner_of(s).density * stations_[s].area;
  const Vec2 way = mass * (outer + inner);
  const double earlier = -(1.0 - drive.end_share_of_work(stations_[s].body)) *
                         dot(drive.ground_before - drive.ground_acceleration, way);
  state.ledger.input += dot(model.gravity - drive.ground_acceleration, way) + earlier;
  state.ledger.numerical += earlier;
  Vec2 out;
  const double stretch = strut_stretch(model, attempt.state, s, out), change = dot(out, outer - inner),
               stiffness = strut_stiffness(s);
  state.support_energy += 0.5 * stiffness * (stretch + change) * (stretch + change);
  state.ledger.numerical += 0.5 * stiffness * change * change;
}

CouplingTotals LinerCoupling::account(const Attempt& attempt, std::span<const double> /*spin*/,
                                      std::size_t first, std::span<double> memory, State& state) const {
  for (std::size_t k = 0; k < bars(); ++k) account_for_bar(attempt, first, k, memory, state);
  for (std::size_t l = 0; l < links_.size(); ++l) account_for_link(attempt, first, l, memory, state);
  for (std::size_t s = 0; s < stations_.size(); ++s) account_for_station(attempt, s, state);
  return {};
}

double LinerCoupling::stored_energy(const Model& model, const State& state, double /*time*/,
                                    std::span<const double> memory) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < bars(); ++k) {
    if (!is_there(state, beams_[k / bars_of_beam].from)) continue;
    const double stretch = stretch_of(model, state, k, memory);
    sum += 0.5 * stiffness_of(k / bars_of_beam, k % bars_of_beam) * stretch * stretch;
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    if (!holds(model, state, l, memory)) continue;
    const Vec2 out = out_of(model, state, links_[l].station);
    sum += link_energy(l, way_since(model, state, l, out, memory), bond_of(l, memory));
  }
  for (std::size_t s = 0; s < stations_.size(); ++s) {
    Vec2 out;
    const double stretch = is_there(state, s) ? strut_stretch(model, state, s, out) : 0.0;
    sum += 0.5 * strut_stiffness(s) * stretch * stretch;
  }
  return sum;
}

std::pair<SectionForce, SectionForce> LinerCoupling::forces_of(const Model& model, const State& state,
                                                               std::size_t beam,
                                                               std::span<const double> memory) const {
  const double c = half_height(beams_[beam].from), h = beams_[beam].length, diagonal = std::hypot(h, 2.0 * c);
  double force[bars_of_beam];
  for (std::size_t k = 0; k < bars_of_beam; ++k) {
    const std::size_t bar = bars_of_beam * beam + k;
    force[k] = stiffness_of(beam, k) * stretch_of(model, state, bar, memory);
  }
  SectionForce middle{force[0] + force[1] + (force[2] + force[3]) * h / diagonal, c * (force[1] - force[0]),
                      (force[2] - force[3]) * 2.0 * c / diagonal};
  SectionForce from = middle, to = middle;
  from.moment -= 0.5 * h * middle.shear;
  to.moment += 0.5 * h * middle.shear;
  return {from, to};
}

std::vector<Element> LinerCoupling::elements() const {
  std::vector<Element> all;
  for (std::size_t s = 0; s < stations_.size(); ++s) {
    const LinerStation& station = stations_[s];
    const loading::Liner& liner = liner_of(s);
    const Vec2 centre = station.wall - 0.5 * liner.thickness * station.out,
               half = 0.5 * station.length * contact::tangent_of(station.out);
    all.push_back({.kind = "liner",
                   .name = station.name,
                   .limit = HUGE_VAL,
                   .from = {centre - half, -1},
                   .to = {centre + half, -1},
                   .may_rupture = may_hold(s)});
  }
  return all;
}

std::vector<Carried> LinerCoupling::carried(const Model& model, const State& state,
                                            std::span<const double> memory) const {
  const std::size_t n = stations_.size();
  std::vector<SectionForce> sums(n);
  std::vector<int> beside(n, 0), bonds(n, 0), links(n, 0);
  std::vector<double> pressure(n, 0.0), gap(n, 0.0), slip(n, 0.0);
  for (std::size_t b = 0; b < beams_.size(); ++b) {
    const auto [from, to] = forces_of(model, state, b, memory);
    for (const auto& [s, force] : {std::pair(beams_[b].from, from), std::pair(beams_[b].to, to)}) {
      sums[s].normal += force.normal;
      sums[s].moment += force.moment;
      sums[s].shear += force.shear;
      ++beside[s];
    }
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const std::size_t s = links_[l].station;
    if (!is_there(state, s)) continue;
    ++links[s];
    bonds[s] += bond_of(l, memory) == Bond::held && model.surface.present[at(links_[l].rock.block)] != 0;
    slip[s] = std::max(slip[s], std::abs(memory[at_link(l, 2)]));
    if (!holds(model, state, l, memory)) continue;
    const Way way = way_since(model, state, l, out_of(model, state, s), memory);
    pressure[s] -= link_force(l, way, bond_of(l, memory)).normal / stations_[s].length;
    gap[s] = std::max(gap[s], way.out);
  }
  std::vector<Carried> all;
  for (std::size_t s = 0; s < n; ++s) {
    const auto middle_of = [&](std::size_t k) {
      return 0.5 * (place_of(model, state.position, point_of(k, 0)) +
                    place_of(model, state.position, point_of(k, 1)));
    };
    const auto towards = [&](int next) {
      return next < 0 ? middle_of(s) : 0.5 * (middle_of(s) + middle_of(at(next)));
    };
    Carried& one =
        all.emplace_back(Carried{.from = towards(stations_[s].before), .to = towards(stations_[s].after)});
    one.present = is_there(state, s);
    if (!one.present) continue;
    one.ruptured = may_hold(s) && links[s] > 0 && bonds[s] == 0;
    one.elongation = gap[s];
    one.yielded = slip[s];
    const double count = std::max(beside[s], 1), length = stations_[s].length;
    const Vec2 out = out_of(model, state, s);
    // Between stations beams have no loads: what spreads over the length of one bends it less, or more, than at the station itself.
    const double spread =
        pressure[s] + 2.0 * liner_of(s).density * stations_[s].area * dot(model.gravity, out) / length;
    const SectionForce force{sums[s].normal / count, sums[s].moment / count + spread * length * length / 12.0,
                             sums[s].shear / count};
    one.force = force.normal;
    one.moment = force.moment;
    one.shear = force.shear;
    if (const auto strength = liner_of(s).strength()) one.utilization = strength->utilization(force);
  }
  return all;
}

}  // namespace keyblock::dynamics
