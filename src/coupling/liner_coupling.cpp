#include "coupling/liner_coupling.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/index.h"
#include "coupling/points.h"
#include "coupling/row_owners.h"
#include "coupling/step_problem.h"
#include "model/drive.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

// A strut gives way so much less than what acts on it. A bond without adhesion is not broken by rounding: m of opening.
constexpr double strut_factor = 1e3, least_opening = 1e-9;

double half_height_of(const loading::Liner& liner) {
  return liner.thickness / std::sqrt(3.0);
}

MaterialPoint point_at(const LinerStation& station, const Model& model, double outer, double inner) {
  MaterialPoint point{station.body, std::vector<double>(at(model.body(at(station.body)).size))};
  const double scale = 1.0 / std::sqrt(station.area);
  point.phi[at(station.outer)] = outer * scale;
  point.phi[at(station.outer) + 1] = inner * scale;
  return point;
}

/// Of a place, turned as `now` is against `before`.
Vec2 turned(Vec2 v, Vec2 before, Vec2 now) {
  const double scale = norm(before) * norm(now);
  if (!(scale > 0.0)) return v;
  const double c = dot(before, now) / scale, s = cross(before, now) / scale;
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// The nearest station with rock on one side, and m to it; −1: there is none.
std::pair<int, double> nearest_rock(std::span<const LinerStation> stations, std::size_t s,
                                    int LinerStation::*next, const LinerWay& way) {
  double far = 0.0;
  for (int k = stations[s].*next; k >= 0 && at(k) != s; k = stations[at(k)].*next) {
    far = norm(stations[at(k)].wall - stations[s].wall);
    if (way.known[at(k)] > 0.0) return {k, far};
  }
  return {-1, far};
}

/// A station without rock: between those that have it, or with the only one.
void go_between(std::span<const LinerStation> stations, std::size_t s, LinerWay& way) {
  auto [a, to_a] = nearest_rock(stations, s, &LinerStation::before, way);
  auto [b, to_b] = nearest_rock(stations, s, &LinerStation::after, way);
  if (a < 0) std::tie(a, to_a) = std::pair(b, to_b);
  if (b < 0) std::tie(b, to_b) = std::pair(a, to_a);
  if (a < 0) return;
  const double share = to_a / (to_a + to_b);
  way.moved[s] = lerp(way.moved[at(a)], way.moved[at(b)], share);
  way.velocity[s] = lerp(way.velocity[at(a)], way.velocity[at(b)], share);
}

}  // namespace

LinerCoupling::LinerCoupling(std::vector<loading::Liner> liners, std::vector<LinerStation> stations,
                             std::vector<LinerBeam> beams, std::vector<LinerLink> links, const Model& model)
    : liners_(std::move(liners)),
      stations_(std::move(stations)),
      beams_(std::move(beams)),
      links_(std::move(links)) {
  for (std::size_t s = 0; s < stations_.size(); ++s) {
    const double face = 0.25 * liner_of(s).thickness / half_height(s);
    points_.push_back(point_at(stations_[s], model, 1.0, 0.0));
    points_.push_back(point_at(stations_[s], model, 0.0, 1.0));
    points_.push_back(point_at(stations_[s], model, 0.5 + face, 0.5 - face));
  }
  for (const LinerLink& link : links_) points_.push_back(link.rock);
  const auto node = [&](std::size_t point) {
    const std::size_t s = point / 3;
    const double inwards = 0.5 * liner_of(s).thickness + (point % 3 == 0 ? -1.0 : 1.0) * half_height(s);
    return stations_[s].wall - inwards * stations_[s].out;
  };
  for (std::size_t k = 0; k < bars(); ++k) {
    const auto [from, to] = ends_of(k / bars_of_beam, k % bars_of_beam);
    rest_.push_back(norm(node(to) - node(from)));
  }
}

double LinerCoupling::half_height(std::size_t station) const {
  return half_height_of(liner_of(station));
}

std::pair<std::size_t, std::size_t> LinerCoupling::ends_of(std::size_t beam, std::size_t which) const {
  const std::size_t from = which % 2, to = which < 2 ? from : 1 - from;
  return {point_of(beams_[beam].from, from), point_of(beams_[beam].to, to)};
}

double LinerCoupling::stiffness_of(std::size_t beam, std::size_t which) const {
  const LinerBeam& b = beams_[beam];
  const double c = half_height(b.from), h = b.length,
               chord = liner_of(b.from).bending_stiffness() / (2.0 * c * c * h);
  return which < 2 ? chord : 3.0 * chord * (h * h + 4.0 * c * c) / (h * h);
}

/// Of the diagonals that push its nodes apart.
double LinerCoupling::strut_stiffness(std::size_t s) const {
  const loading::Liner& liner = liner_of(s);
  const double h = stations_[s].length, t = liner.thickness;
  return strut_factor * liner.axial_stiffness() * std::max(t * t / (h * h), 1.0) / h;
}

Vec2 LinerCoupling::place_of(const Model& model, const std::vector<double>& coefficients,
                             std::size_t point) const {
  const Body& body = model.body(at(points_[point].block));
  return field_at(points_[point].phi.data(), body.size, &coefficients[body.first]);
}

LinerCoupling::Bar LinerCoupling::bar_of(const Model& model, const State& state, std::size_t bar) const {
  const auto [from, to] = ends_of(bar / bars_of_beam, bar % bars_of_beam);
  const Vec2 apart = place_of(model, state.position, to) - place_of(model, state.position, from);
  const double length = norm(apart);
  return {length > 0.0 ? apart / length : Vec2{1.0, 0.0}, length};
}

Vec2 LinerCoupling::out_of(const Model& model, const State& state, std::size_t s) const {
  return normalized(place_of(model, state.position, point_of(s, 0)) -
                    place_of(model, state.position, point_of(s, 1)));
}

double LinerCoupling::strut_stretch(const Model& model, const State& state, std::size_t s, Vec2& out) const {
  const Vec2 apart =
      place_of(model, state.position, point_of(s, 0)) - place_of(model, state.position, point_of(s, 1));
  const double length = norm(apart);
  out = apart / length;
  return length - 2.0 * half_height(s);
}

bool LinerCoupling::holds(const Model& model, const State& state, std::size_t link,
                          std::span<const double> memory) const {
  return is_there(state, links_[link].station) && model.surface.present[at(links_[link].rock.block)] != 0 &&
         bond_of(link, memory) != Bond::gone;
}

LinerCoupling::Way LinerCoupling::way_of(const Model& model, const State& state, std::size_t link,
                                         Vec2 out) const {
  const Vec2 apart = place_of(model, state.position, rock_of(link)) -
                     place_of(model, state.position, point_of(links_[link].station, 2));
  return {dot(out, apart), dot(contact::tangent_of(out), apart)};
}

LinerCoupling::Way LinerCoupling::way_since(const Model& model, const State& state, std::size_t link,
                                            Vec2 out, std::span<const double> memory) const {
  const Way way = way_of(model, state, link, out);
  return {way.out - memory[at_link(link, 0)],
          way.along - memory[at_link(link, 1)] - memory[at_link(link, 2)]};
}

void LinerCoupling::add_pairs(BlockPairs& pairs) const {
  for (const LinerBeam& beam : beams_) pairs.emplace_back(stations_[beam.from].body, stations_[beam.to].body);
  for (const LinerLink& link : links_) pairs.emplace_back(stations_[link.station].body, link.rock.block);
}

void LinerCoupling::add_terms(const Model& model, const State& state, const Drive& drive,
                              std::span<const double> /*memory*/, BlockTerms& terms) const {
  const Vec2 acceleration = model.gravity - drive.ground_acceleration;
  for (std::size_t s = 0; s < stations_.size(); ++s) {
    if (!is_there(state, s)) continue;
    const std::size_t body = at(stations_[s].body);
    const MaterialPoint &outer = points_[point_of(s, 0)], &inner = points_[point_of(s, 1)];
    for (const MaterialPoint* node : {&outer, &inner})
      terms.add_force(body, node->phi.data(), liner_of(s).density * stations_[s].area * acceleration);
    std::vector<double> apart(outer.phi);
    for (std::size_t k = 0; k < apart.size(); ++k) apart[k] -= inner.phi[k];
    Vec2 out;
    const double stretch = strut_stretch(model, state, s, out), stiffness = strut_stiffness(s);
    terms.add_spring(body, out, apart, stiffness, -stiffness * stretch);
  }
}

RowFacts LinerCoupling::build(const Model& model, const State& state, const Drive& drive,
                              std::span<const double> memory, CouplingRows out) const {
  RowFacts facts{.may_change_laws = !links_.empty()};
  const auto begin = [&](std::size_t k, std::size_t first, std::size_t second) -> Row& {
    Row& row = out.rows[k];
    const std::size_t a = at(points_[first].block), b = at(points_[second].block);
    row.vertex = out.points.material_point(first + out.first_point);
    row.from = row.to = out.points.material_point(second + out.first_point);
    row.position = 0.0;
    row.unknown_a = out.points.body(a).unknown;
    row.unknown_b = out.points.body(b).unknown;
    row.pair = pair_in(state.pattern, row.unknown_a, row.unknown_b);
    row.moved = drive.prescribed.empty() ? Vec2{} : drive.prescribed[a] - drive.prescribed[b];
    out.owners.set(out.first + k, row.unknown_a, row.unknown_b);
    facts.lacks_room |= row.pair == Row::without_room;
    return row;
  };
  for (std::size_t k = 0; k < bars(); ++k) {
    const std::size_t beam = k / bars_of_beam;
    const auto [from, to] = ends_of(beam, k % bars_of_beam);
    Row& row = begin(k, to, from);
    const Bar bar = bar_of(model, state, k);
    row.normal = {bar.along.y, -bar.along.x};
    if (!is_there(state, beams_[beam].from)) {
      out.springs.set_row(out.first + k, {});
      continue;
    }
    const double stiffness = stiffness_of(beam, k % bars_of_beam),
                 stretch = bar.length - rest_[k] - memory[k];
    // A bar that is pulled turns its force with it within the step.
    out.springs.set_row(out.first + k, {.normal_stiffness = std::max(stiffness * stretch, 0.0) / bar.length,
                                        .shear_stiffness = stiffness,
                                        .least_shear = -HUGE_VAL,
                                        .largest_shear = HUGE_VAL,
                                        .shear = stretch});
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const std::size_t s = links_[l].station, c = out.first + bars() + l;
    Row& row = begin(bars() + l, rock_of(l), point_of(s, 2));
    row.normal = out_of(model, state, s);
    if (!holds(model, state, l, memory)) {
      out.springs.set_row(c, {});
      continue;
    }
    const loading::Liner& liner = liner_of(s);
    const Way way = way_since(model, state, l, row.normal, memory);
    const bool is_held = bond_of(l, memory) == Bond::held;
    SpringArray::TwoSided spring{.normal_stiffness = liner.normal_stiffness * links_[l].length,
                                 .shear_stiffness = liner.shear_stiffness * links_[l].length,
                                 .least_shear = -HUGE_VAL,
                                 .largest_shear = HUGE_VAL,
                                 .normal = -way.out - dot(row.normal, row.moved),
                                 .shear = way.along + dot(row.tangent(), row.moved)};
    if (!is_held) {
      spring.friction = liner.friction;
      spring.largest_shear = liner.friction * std::max(-way.out * spring.normal_stiffness, 0.0);
      spring.least_shear = -spring.largest_shear;
    }
    out.springs.set_row(c, spring);
  }
  return facts;
}

void LinerCoupling::change_laws(const StepProblem& problem, std::size_t first, std::span<const double> memory,
                                std::vector<LawChange>& changes) const {
  const SpringArray& rows = problem.springs();
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const std::size_t c = first + bars() + l;
    if (rows.kn[c] == 0.0 || !rows.is_tensile(c) || bond_of(l, memory) != Bond::held) continue;
    const loading::Liner& liner = liner_of(links_[l].station);
    const SpringArray::Force force = rows.force(c);
    const double length = links_[l].length, presses = std::max(force.normal, 0.0), pull = -force.normal,
                 adhesion = liner.adhesion * length, least_pull = least_opening * rows.kn[c],
                 shear = liner.cohesion * length + liner.friction * presses,
                 least_shear = least_opening * rows.ks[c];
    const double excess = std::max(pull / std::max(adhesion, least_pull),
                                   std::abs(force.shear) / std::max(shear, least_shear)) -
                          1.0;
    if (excess <= 0.0) continue;
    const double bound = liner.friction * presses;
    changes.push_back({c, excess, -bound, bound, liner.friction});
  }
}

void LinerCoupling::put(const Model& model, State& state, std::size_t s, Vec2 wall, Vec2 out,
                        Vec2 velocity) const {
  const double half = half_height(s), scale = std::sqrt(stations_[s].area);
  const Vec2 centre = wall - 0.5 * liner_of(s).thickness * out;
  const std::size_t first = model.body(at(stations_[s].body)).first + 2 * at(stations_[s].outer);
  const Vec2 nodes[] = {centre + half * out, centre - half * out};
  for (std::size_t k = 0; k < 2; ++k) {
    state.position[first + 2 * k] = scale * nodes[k].x;
    state.position[first + 2 * k + 1] = scale * nodes[k].y;
    state.velocity[first + 2 * k] = scale * velocity.x;
    state.velocity[first + 2 * k + 1] = scale * velocity.y;
  }
}

void LinerCoupling::place(const Model& model, State& state) const {
  for (std::size_t s = 0; s < stations_.size(); ++s)
    put(model, state, s, stations_[s].wall, stations_[s].out, {});
}

LinerWay LinerCoupling::way_of_rock(const Model& model, const State& state,
                                    std::span<const std::uint8_t> is_put) const {
  LinerWay way{std::vector<double>(stations_.size(), 0.0), std::vector<Vec2>(stations_.size()),
               std::vector<Vec2>(stations_.size())};
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const std::size_t s = links_[l].station;
    if (is_put[s] == 0 || model.surface.present[at(links_[l].rock.block)] == 0) continue;
    way.known[s] += links_[l].length;
    way.moved[s] += links_[l].length * (place_of(model, state.position, rock_of(l)) - stations_[s].wall);
    way.velocity[s] += links_[l].length * place_of(model, state.velocity, rock_of(l));
  }
  for (std::size_t s = 0; s < stations_.size(); ++s) {
    if (way.known[s] <= 0.0) continue;
    way.moved[s] = way.moved[s] / way.known[s];
    way.velocity[s] = way.velocity[s] / way.known[s];
  }
  return way;
}

/// Stations go where their rock is; those without rock between those that have it.
void LinerCoupling::put_all(const Model& model, State& state, std::span<const std::uint8_t> is_put) const {
  const std::size_t n = stations_.size();
  LinerWay way = way_of_rock(model, state, is_put);
  for (std::size_t s = 0; s < n; ++s) {
    if (way.known[s] <= 0.0 && is_put[s] != 0) go_between(stations_, s, way);
  }
  std::vector<Vec2> wall(n);
  for (std::size_t s = 0; s < n; ++s) wall[s] = stations_[s].wall + way.moved[s];
  for (std::size_t s = 0; s < n; ++s) {
    if (is_put[s] == 0) continue;
    const std::size_t a = stations_[s].before < 0 ? s : at(stations_[s].before),
                      b = stations_[s].after < 0 ? s : at(stations_[s].after);
    put(model, state, s, wall[s],
        turned(stations_[s].out, stations_[b].wall - stations_[a].wall, wall[b] - wall[a]), way.velocity[s]);
  }
}

void LinerCoupling::install(const Model& model, State& state, std::span<const std::uint8_t> now,
                            std::span<double> memory) const {
  std::vector<std::uint8_t> is_put(stations_.size(), 0);
  for (std::size_t s = 0; s < is_put.size(); ++s) {
    const int staged = liner_of(s).staged;
    is_put[s] = staged >= 0 && now[at(staged)] != 0 ? 1 : 0;
  }
  put_all(model, state, is_put);
  for (std::size_t k = 0; k < bars(); ++k) {
    if (is_put[beams_[k / bars_of_beam].from] != 0) memory[k] = bar_of(model, state, k).length - rest_[k];
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const std::size_t s = links_[l].station;
    if (is_put[s] == 0) continue;
    const Way way = way_of(model, state, l, out_of(model, state, s));
    memory[at_link(l, 0)] = way.out;
    memory[at_link(l, 1)] = way.along;
    memory[at_link(l, 2)] = 0.0;
    // Rock that has come away from the wall gets no liner.
    const bool is_near = std::hypot(way.out, way.along) < liner_of(s).thickness;
    memory[at_link(l, 3)] = static_cast<double>(is_near ? Bond::held : Bond::gone);
  }
}

void LinerCoupling::add_rounding_forces(const Model& /*model*/, double extent,
                                        std::span<double> force) const {
  for (const LinerLink& link : links_)
    force[at(link.rock.block)] += liner_of(link.station).normal_stiffness * link.length * extent;
}

}  // namespace keyblock::dynamics
