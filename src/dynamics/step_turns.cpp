// How far blocks turned and moved in a look at a step, and whether that is what it was built for.
#include <algorithm>
#include <atomic>
#include <cmath>

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

/// Where a vertex comes to be with the increment at hand: the pose update of its block (formulation, equation 5).
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

double Stepper::gap_at_end(const State& state, const contact::Contact& c) const {
  const contact::Surface& surface = model_.surface;
  const Vec2 from = at_end(state, at(c.edge)), along = at_end(state, at(surface.next[at(c.edge)])) - from;
  Vec2 apart = at_end(state, at(c.vertex)) - from;
  if (contact::is_curved(surface, c.edge)) {
    apart += from;
    contact::for_curve_vertices(surface, c.edge, c.position,
                                [&](std::size_t v, double share) { apart -= share * at_end(state, v); });
  }
  return cross(apart, along) / norm(along);
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
/// What is missed goes into turned_now_, with which the step may be taken again; where blocks turn so far that forces have other
/// directions at its end, the step is too long.
Stepper::Turns Stepper::look_at_turns(const State& state, bool is_static) {
  constexpr double most_turned = 0.1;  // rad
  double turn = 0.0;
  for (const double spin : spin_) turn = std::max(turn, std::abs(spin));
  const double moved = std::sqrt(largest_squared_norm(team_, open_close_.relative()));
  const auto tolerated = [&](double force) {
    return is_static ? tolerances_.turn : std::min(tolerances_.turn, turn_work_ / force);
  };
  const double least_tolerated = tolerated(problem_.springs().largest_normal_force(team_));
  const auto may_miss = [&](double spin) {
    return spin * (spin * largest_radius_ + moved) > least_tolerated;
  };
  if (turned_.empty() && !may_miss(turn)) return Turns::are_known;  // as in most steps
  turned_now_.assign(contacts_.size(), 0.0);
  bool are_known = true;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t a = at(contacts_[c].block_a), b = at(contacts_[c].block_b);
    const double known = turned_.empty() ? 0.0 : turned_[c],
                 spin = std::max(std::abs(spin_[a]), std::abs(spin_[b]));
    if (known == 0.0 && !may_miss(spin)) continue;
    const StepProblem::Row& row = problem_.rows()[c];
    const Vec2 r = open_close_.relative()[c];
    const double force = problem_.springs().force(c).normal, most_missed = tolerated(force);
    const double at_most = 0.5 * (spin_[a] * spin_[a] * model_.blocks[a].radius +
                                  spin_[b] * spin_[b] * model_.blocks[b].radius) +
                           std::abs(spin_[b] * dot(row.tangent(), r));
    if (at_most <= most_missed && known == 0.0) continue;
    const double gap = gap_at_end(state, contacts_[c]),
                 linear = contacts_[c].gap + dot(row.normal, r) - known;
    turned_now_[c] = gap - linear;
    if (std::abs(turned_now_[c] - known) <= most_missed || (force <= 0.0 && gap >= 0.0)) continue;
    if (spin > most_turned) return Turns::are_too_far;
    are_known = false;
  }
  return are_known ? Turns::are_known : Turns::are_others;
}

/// Whether a block moved or turned beyond what its contacts were looked for with; that is then raised, and the block expected to go where
/// it went.
bool Stepper::moved_too_far() {
  std::atomic<bool> any = false;
  for_blocks([&](std::size_t b) {
    const Block& block = model_.blocks[b];
    const std::size_t begin = at(model_.surface.block_begin[b]), end = at(model_.surface.block_begin[b + 1]);
    const std::span<const Vec2> went = open_close_.displacement();
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
    if (!is_far && !is_turned) return;
    any = true;
    double against_first = 0.0;
    for (std::size_t v = begin; v < end; ++v) {
      ahead_[v] = went[v];
      against_first = std::max(against_first, squared_norm(went[v] - went[begin]));
    }
    way_ahead_[b] = std::sqrt(against_first);
  });
  return any;
}

}  // namespace keyblock::dynamics
