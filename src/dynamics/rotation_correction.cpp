#include "dynamics/rotation_correction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contact/edge_curve.h"
#include "core/index.h"
#include "core/lanes.h"
#include "coupling/coupling.h"
#include "dynamics/energy.h"
#include "model/worth_threads.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

/// m, with position(v) of every vertex: how far the vertex of a contact is from the material point of the edge that it touches at the
/// start of the step, across the edge (x: the gap) and along it (y).
template <typename Position>
Vec2 apart(const contact::Surface& surface, const contact::Contact& c, const Position& position) {
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

/// m, what a contact may miss so that it seems no more than a hundredth of its strength, if it is a bond.
struct BondTolerance {
  double across = HUGE_VAL, along = HUGE_VAL;
  BondTolerance() = default;
  explicit BondTolerance(const contact::Contact& contact) {
    using step_numbers::bond_share;
    if (!contact.memory.bonded || contact.fused) return;
    if (contact.tension > 0.0) across = bond_share * contact.tension / contact.normal_stiffness;
    if (contact.cohesion > 0.0) along = bond_share * contact.cohesion / contact.shear_stiffness;
  }
};

double least_bond_tolerance(std::span<const contact::Contact> contacts) {
  double least = HUGE_VAL;
  for (const contact::Contact& contact : contacts) {
    const BondTolerance tolerance(contact);
    least = std::min({least, tolerance.across, tolerance.along});
  }
  return least;
}

bool has_bonds(const Attempt& attempt) {
  return attempt.problem.facts().may_break && !attempt.drive.is_static;
}

}  // namespace

RotationCorrection::RotationCorrection(const Model& model, const contact::Tolerances& tolerances)
    : tolerance_(tolerances.turn), spin_(model.blocks.size(), 0.0) {
  double mass = 0.0;
  int count = 0;
  for (const Block& block : model.blocks) {
    if (block.unknown < 0) continue;
    largest_radius_ = std::max(largest_radius_, block.radius);
    mass += block.mass();
    ++count;
  }
  weight_ = norm(model.gravity) * mass / static_cast<double>(count);
  for (const int block : held_blocks(model)) held_.push_back(at(block));
}

void RotationCorrection::measure_spin(const Attempt& attempt) {
  std::fill(spin_.begin(), spin_.end(), 0.0);
  for_moving_blocks(attempt.model, attempt.team, [&](std::size_t b) {
    const Block& block = attempt.model.blocks[b];
    spin_[b] = block.pose.mean_spin(&attempt.increment[block.first], &attempt.state.position[block.first]);
  });
}

Vec2 RotationCorrection::at_end(const Attempt& attempt, std::size_t vertex) const {
  const Model& model = attempt.model;
  const std::size_t b = at(model.surface.block[vertex]);
  const Vec2 start = model.surface.position[vertex];
  const std::span<const Vec2> prescribed = attempt.drive.prescribed;
  if (!model.moves(b)) return prescribed.empty() ? start : start + prescribed[b];
  const Block& block = model.blocks[b];
  const auto centroid_of = [&](std::span<const double> coefficients) {
    return Vec2{coefficients[block.first], coefficients[block.first + 1]} / std::sqrt(block.area);
  };
  const double w = spin_[b];
  double cosine, sine;
  block::rotation(w, cosine, sine);
  const Vec2 centroid = centroid_of(attempt.state.position), moved = centroid_of(attempt.increment),
             r = start - centroid, p = r + attempt.displacement[vertex] - moved - w * Vec2{-r.y, r.x};
  return centroid + moved + Vec2{cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
}

/// N per thickness, that a mean block has to carry. Without gravity it is what its residual is measured by.
double RotationCorrection::carried(const Attempt& attempt) const {
  if (weight_ > 0.0) return weight_;
  const Model& model = attempt.model;
  double sum = 0.0;
  int count = 0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    sum += attempt.problem.terms().weight(b) * std::sqrt(model.blocks[b].area);
    ++count;
  }
  return sum / static_cast<double>(std::max(count, 1));
}

/// J per thickness, that a contact may do over what turning makes it miss. farthest: m, what the sides of a contact go against each other.
double RotationCorrection::tolerated_work(const Attempt& attempt, double farthest) const {
  using namespace step_numbers;
  if (attempt.drive.is_static) return static_work_share * carried(attempt) * farthest;
  if (weight_ <= 0.0) return weightless_work_share * kinetic_energy(attempt.model, attempt.state);
  return std::min(weight_work_share * weight_ * attempt.model.block_size,
                  moving_work_share * kinetic_energy(attempt.model, attempt.state));
}

/// m, change of δ: by the work of the force over it, and by a tenth of that work for what the spring stores by δ only.
double RotationCorrection::tolerated(double work, double force, double stiffness) const {
  using step_numbers::least_rotation_share;
  if (force == 0.0) return tolerance_;
  const double missed = std::min(work / force, std::sqrt(0.2 * work / stiffness));
  return std::clamp(missed, least_rotation_share * tolerance_, tolerance_);
}

/// Springs to the ground are linear in D, too: where what they hold turns far, they pull the wrong way.
bool RotationCorrection::turns_held_too_far() const {
  return std::ranges::any_of(
      held_, [&](std::size_t b) { return std::abs(spin_[b]) > step_numbers::most_held_rotation; });
}

Verdict RotationCorrection::check(const Attempt& attempt) {
  if (turns_held_too_far()) return Verdict::rotated_too_far;
  double turn = 0.0;
  for (const double spin : spin_) turn = std::max(turn, std::abs(spin));
  const double moved = std::sqrt(
                   largest_squared_norm(attempt.team, attempt.relative.first(attempt.contacts.size()))),
               missed_at_most = turn * (turn * largest_radius_ + moved);
  // In most steps no contact can miss too much.
  const bool may_be_known =
      known_.empty() && (!has_bonds(attempt) || missed_at_most <= least_bond_tolerance(attempt.contacts));
  if (may_be_known && missed_at_most <= step_numbers::least_rotation_share * tolerance_)
    return Verdict::accepted;
  const double work = tolerated_work(attempt, std::max(moved, turn * largest_radius_));
  const SpringArray& springs = attempt.problem.springs();
  if (may_be_known && missed_at_most <= tolerated(work, largest_normal_force(springs, attempt.team),
                                                  largest_stiffness(springs, attempt.team)))
    return Verdict::accepted;
  found_.assign(attempt.contacts.size(), {});
  Verdict verdict = Verdict::accepted;
  for (std::size_t c = 0; c < attempt.contacts.size(); ++c) {
    const Verdict of_contact = check_contact(attempt, c, work);
    if (of_contact == Verdict::rotated_too_far) return of_contact;
    if (of_contact != Verdict::accepted) verdict = of_contact;
  }
  return verdict;
}

Verdict RotationCorrection::check_contact(const Attempt& attempt, std::size_t c, double work) {
  const Model& model = attempt.model;
  const contact::Contact& contact = attempt.contacts[c];
  const std::size_t a = at(contact.block_a), b = at(contact.block_b);
  const Row& row = attempt.problem.rows()[c];
  const SpringArray& springs = attempt.problem.springs();
  const Vec2 known = known_.empty() ? Vec2{} : known_[c], r = attempt.relative[c];
  const double spin = std::max(std::abs(spin_[a]), std::abs(spin_[b])),
               force = std::abs(springs.force(c).normal);
  const bool bonds = has_bonds(attempt);
  const BondTolerance bond = bonds ? BondTolerance(contact) : BondTolerance();
  const double most_missed = std::min(tolerated(work, force, springs.stiffness(c)), bond.across);
  const double at_most =
      0.5 * (spin_[a] * spin_[a] * model.blocks[a].radius + spin_[b] * spin_[b] * model.blocks[b].radius) +
      std::abs(spin_[b] * (bonds ? norm(r) : dot(row.tangent(), r)));
  if (known == Vec2{} && at_most <= std::min(most_missed, bond.along)) return Verdict::accepted;
  const Vec2 end = apart(model.surface, contact, [&](std::size_t v) { return at_end(attempt, v); });
  found_[c].x = end.x - (contact.gap + dot(row.normal, r) - known.x);
  if (bond.along < HUGE_VAL) found_[c].y = end.y - (dot(row.tangent(), r) - known.y);
  const Vec2 change = found_[c] - known;
  const bool stays_open = force == 0.0 && end.x >= 0.0;
  if ((std::abs(change.x) <= most_missed || stays_open) && std::abs(change.y) <= bond.along)
    return Verdict::accepted;
  // A static step is made shorter at once where δ is large: its length has no meaning.
  const bool is_too_far =
      spin > step_numbers::most_rotation || (attempt.drive.is_static && std::abs(change.x) > tolerance_);
  return is_too_far ? Verdict::rotated_too_far : Verdict::rotated;
}

double RotationCorrection::keep_shear(const Attempt& attempt, std::span<contact::Memory> memory) {
  if (!attempt.problem.facts().may_break) return 0.0;
  const contact::Surface& surface = attempt.model.surface;
  gained_.assign(attempt.contacts.size(), 0.0);
  attempt.team.for_range(
      attempt.contacts.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
          const contact::Contact& contact = attempt.contacts[c];
          contact::Memory& of_contact = memory[c];
          if (!of_contact.bonded || contact.fused) continue;
          const Vec2 now = apart(surface, contact, [&](std::size_t v) { return surface.position[v]; });
          const double missed = now.y - dot(attempt.problem.rows()[c].tangent(), attempt.relative[c]);
          gained_[c] = contact.shear_stiffness * missed * (of_contact.shear + 0.5 * missed);
          of_contact.shear += missed;
          of_contact.stored += gained_[c];
        }
      });
  return std::accumulate(gained_.begin(), gained_.end(), 0.0);
}

}  // namespace keyblock::dynamics
