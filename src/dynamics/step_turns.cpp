// How far blocks turned and moved in a look at a step, and whether that is what it was built for.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "contact/edge_curve.h"
#include "core/index.h"
#include "core/lanes.h"
#include "dynamics/step.h"

namespace keyblock::dynamics {

void Stepper::measure_spin(const State& state) {
  std::fill(spin_.begin(), spin_.end(), 0.0);
  for_blocks([&](std::size_t b) {
    const Block& block = model_.blocks[b];
    spin_[b] = block.pose.mean_spin(&increment_[block.first], &state.position[block.first]);
  });
}

/// Where a vertex comes to be with the increment at hand: the pose update of its block (docs/theory.md, section "Pose update").
Vec2 Stepper::at_end(const State& state, std::size_t vertex) const {
  const std::size_t b = at(model_.surface.block[vertex]);
  const Vec2 start = model_.surface.position[vertex];
  if (!model_.moves(b)) return prescribed_.empty() ? start : start + prescribed_[b];
  const Block& block = model_.blocks[b];
  const auto centroid_of = [&](const std::vector<double>& coefficients) {
    return Vec2{coefficients[block.first], coefficients[block.first + 1]} / std::sqrt(block.area);
  };
  const double w = spin_[b];
  double cosine, sine;
  block::rotation(w, cosine, sine);
  const Vec2 centroid = centroid_of(state.position), moved = centroid_of(increment_), r = start - centroid,
             p = r + open_close_.displacement()[vertex] - moved - w * Vec2{-r.y, r.x};
  return centroid + moved + Vec2{cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
}

/// m, with position(v) of every vertex: how far the vertex of a contact is from the material point of the edge that it touches at the
/// start of the step, across the edge (x: the gap) and along it (y).
template <typename Position>
Vec2 Stepper::apart(const contact::Contact& c, const Position& position) const {
  const contact::Surface& surface = model_.surface;
  const Vec2 from = position(at(c.edge)), to = position(at(surface.next[at(c.edge)])),
             tangent = normalized(to - from);
  Vec2 point = lerp(from, to, c.position);
  if (contact::is_curved(surface, c.edge)) {
    point = {};
    contact::for_curve_vertices(surface, c.edge, c.position,
                                [&](std::size_t v, double share) { point += share * position(v); });
  }
  const Vec2 r = position(at(c.vertex)) - point;
  return {cross(r, tangent), dot(r, tangent)};
}

namespace {

/// m²
double largest_squared_norm(ThreadTeam& team, std::span<const Vec2> vectors) {
  static_assert(sizeof(Vec2) == 2 * sizeof(double));
  constexpr std::size_t width = lane_count;
  const std::size_t groups = vectors.size() / width;
  double most = largest_of(team, groups, contacts_worth_threads / width, [&](std::size_t group) {
    const std::size_t i = group * width;
    const Lanes first = load(&vectors[i].x), second = load(&vectors[i + lane_count / 2].x),
                x = even_lanes(first, second), y = odd_lanes(first, second);
    return largest(x * x + y * y);
  });
  for (const Vec2 v : vectors.subspan(groups * width)) most = std::max(most, squared_norm(v));
  return most;
}

}  // namespace

/// The step is linear in the displacement, and misses the gap at its end: vertices of a turning block leave the straight way by ½ w² r,
/// and the line of a turning edge moves away from a vertex that slides along it. That matters where a contact presses, and where it
/// would come to press by that alone: by the way, and by the work that the normal force does over it, which nobody would account for.
/// It matters where a bond pulls, and what is missed along its edge, too: by the share of the bond's strength that it would seem to be.
/// What is missed goes into turned_now_, with which the step may be taken again; where blocks turn so far that forces have other
/// directions at its end, the step is too long.
Stepper::Turns Stepper::look_at_turns(const State& state, bool is_static) {
  constexpr double most_turned = 0.1;  // rad
  constexpr double kinetic_share =
      1e-6;  // of the kinetic energy, where there is no weight to measure work by
  const double least_missed = 2e-5 * tolerances_.turn;
  double turn = 0.0;
  for (const double spin : spin_) turn = std::max(turn, std::abs(spin));
  const double moved = std::sqrt(largest_squared_norm(team_, open_close_.relative()));
  const SpringArray& springs = problem_.springs();
  const double work = turn_work_ == HUGE_VAL ? kinetic_share * kinetic_energy(state) : turn_work_;
  // The work of the force over what is missed, and a tenth of it for what the spring stores by that alone.
  const auto tolerated = [&](double force, double stiffness) {
    if (is_static || force == 0.0) return tolerances_.turn;
    const double missed = std::min(work / force, std::sqrt(0.2 * work / stiffness));
    return std::clamp(missed, least_missed, tolerances_.turn);
  };
  const double missed_at_most = turn * (turn * largest_radius_ + moved);
  const bool has_bonds = problem_.may_break() && !is_static;
  if (turned_.empty() && (!has_bonds || missed_at_most <= least_bond_missed()) &&
      (missed_at_most <= least_missed ||
       missed_at_most <= tolerated(springs.largest_normal_force(team_), springs.largest_stiffness(team_))))
    return Turns::are_known;  // as in most steps
  turned_now_.assign(contacts_.size(), {});
  bool are_known = true;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t a = at(contacts_[c].block_a), b = at(contacts_[c].block_b);
    const StepProblem::Row& row = problem_.rows()[c];
    const Vec2 known = turned_.empty() ? Vec2{} : turned_[c], r = open_close_.relative()[c];
    const double spin = std::max(std::abs(spin_[a]), std::abs(spin_[b])),
                 force = std::abs(springs.force(c).normal);
    const BondMissed bond = has_bonds ? bond_missed(c) : BondMissed{};
    const double most_missed = std::min(tolerated(force, springs.kn[c]), bond.across);
    const double at_most = 0.5 * (spin_[a] * spin_[a] * model_.blocks[a].radius +
                                  spin_[b] * spin_[b] * model_.blocks[b].radius) +
                           std::abs(spin_[b] * (has_bonds ? norm(r) : dot(row.tangent(), r)));
    if (known == Vec2{} && at_most <= std::min(most_missed, bond.along)) continue;
    const Vec2 end = apart(contacts_[c], [&](std::size_t v) { return at_end(state, v); });
    turned_now_[c].x = end.x - (contacts_[c].gap + dot(row.normal, r) - known.x);
    if (bond.along < HUGE_VAL) turned_now_[c].y = end.y - (dot(row.tangent(), r) - known.y);
    const Vec2 change = turned_now_[c] - known;
    const bool stays_open = force == 0.0 && end.x >= 0.0;
    if ((std::abs(change.x) <= most_missed || stays_open) && std::abs(change.y) <= bond.along) continue;
    if (spin > most_turned) return Turns::are_too_far;
    are_known = false;
  }
  return are_known ? Turns::are_known : Turns::are_others;
}

/// m, what a contact may miss so that it seems no more than a hundredth of its strength, if it is a bond.
Stepper::BondMissed Stepper::bond_missed(std::size_t c) const {
  constexpr double share = 0.01;
  const contact::Contact& contact = contacts_[c];
  BondMissed missed;
  if (!contact.memory.bonded || contact.fused) return missed;
  if (contact.tension > 0.0) missed.across = share * contact.tension / contact.normal_stiffness;
  if (contact.cohesion > 0.0) missed.along = share * contact.cohesion / contact.shear_stiffness;
  return missed;
}

double Stepper::least_bond_missed() const {
  double least = HUGE_VAL;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const BondMissed missed = bond_missed(c);
    least = std::min({least, missed.across, missed.along});
  }
  return least;
}

/// Bonds that hold while their blocks turn: what the step missed along the edge is shear as any other, once the blocks are where they come
/// to be. Else they would creep, always the same way, and tear what is bonded around them. J per thickness that springs gained by it.
double Stepper::keep_turned_shear(State& state) {
  if (!problem_.may_break()) return 0.0;
  const bool has_multipliers = model_.solver.contact == ContactMethod::augmented_lagrangian;
  turned_energy_.assign(contacts_.size(), 0.0);
  team_.for_range(contacts_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const contact::Contact& contact = contacts_[c];
      contact::Memory& memory = state.contacts.memory[c];
      if (!memory.bonded || contact.fused) continue;
      const Vec2 now = apart(contact, [&](std::size_t v) { return model_.surface.position[v]; });
      const double missed = now.y - dot(problem_.rows()[c].tangent(), open_close_.relative()[c]);
      if (has_multipliers) {
        memory.drift += missed;
        continue;
      }
      turned_energy_[c] = contact.shear_stiffness * missed * (memory.shear + 0.5 * missed);
      memory.shear += missed;
      memory.stored += turned_energy_[c];
    }
  });
  return std::accumulate(turned_energy_.begin(), turned_energy_.end(), 0.0);
}

/// Whether a block comes to lie in another one where no contact holds it.
bool Stepper::comes_inside(const State& state) {
  const SpringArray& springs = problem_.springs();
  const std::function<Vec2(std::size_t)> end = [&](std::size_t v) { return at_end(state, v); };
  const std::function<bool(int, int)> holds = [&](int vertex, int block) {
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (contacts_[c].vertex == vertex && contacts_[c].block_b == block && springs.force(c).normal > 0.0)
        return true;
    }
    return false;
  };
  return intrusions_.any({model_.surface, open_close_.displacement(), prescribed_, end, holds},
                         state.contacts);
}

/// Whether a block moved or turned beyond what its contacts were looked for with; that is then raised, and the block expected to go where
/// it went.
bool Stepper::moved_too_far() {
  std::atomic<bool> any = false;
  const std::span<const Vec2> went = open_close_.displacement();
  const auto vertices_of = [&](std::size_t b) {
    const auto first = model_.surface.block_begin.begin() + static_cast<std::ptrdiff_t>(b);
    return std::pair(at(first[0]), at(first[1]));
  };
  for_blocks([&](std::size_t b) {
    const Block& block = model_.blocks[b];
    const auto [begin, end] = vertices_of(b);
    double moved = 0.0;
    for (std::size_t v = begin; v < end; ++v) moved = std::max(moved, squared_norm(went[v]));
    moved = std::sqrt(moved);
    const bool is_far = moved > reach_[b] + 0.5 * tolerances_.activation,
               is_turned = std::abs(spin_[b]) > turn_[b] + 0.5 * contact::Tolerances::sine_inside;
    if (is_far) reach_[b] = 1.5 * moved;
    if (is_turned) {
      turn_[b] = 1.5 * std::abs(spin_[b]);
      reach_[b] = std::max(reach_[b], turn_[b] * block.radius);
    }
    is_far_[b] = is_far || is_turned;
    if (is_far_[b] != 0) any = true;
  });
  if (!any) return false;
  if (ahead_at_first_.empty()) ahead_at_first_ = ahead_;
  for_blocks([&](std::size_t b) {
    if (is_far_[b] == 0) return;
    const auto [begin, end] = vertices_of(b);
    double against_first = 0.0;
    for (std::size_t v = begin; v < end; ++v) {
      ahead_[v] = went[v];
      against_first = std::max(against_first, squared_norm(went[v] - went[begin]));
    }
    way_ahead_[b] = std::sqrt(against_first);
  });
  return true;
}

}  // namespace keyblock::dynamics
