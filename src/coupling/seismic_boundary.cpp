#include "coupling/seismic_boundary.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/block_terms.h"
#include "model/drive.h"
#include "model/turn.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

/// Of the memory: the kind of the last step, then its numbers of each point.
constexpr std::size_t points_begin = 1, numbers_of_point = 6;

Vec2 by_axis(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.y * b.y};
}

/// m, since before the run.
Vec2 displacement_of(const BoundaryPoint& p, const Model& model, const State& state) {
  const Block& block = model.blocks[at(p.point.block)];
  return field_at(p.point.phi.data(), block.size, &state.position[block.first]) - p.place;
}

/// m, by which a turn of its block moves a point.
Vec2 turn_at(const BoundaryPoint& p, const Block& block, double spin, std::span<const double> position) {
  Vec2 turned;
  const std::vector<double>& phi = p.point.phi;
  for (std::size_t i = 0; i < phi.size(); ++i)
    turned += phi[i] * Vec2{turn_of(spin, &position[block.first], 2 * i),
                            turn_of(spin, &position[block.first], 2 * i + 1)};
  return turned;
}

/// Its motion, and of each node the displacement at which the dynamic steps began.
std::size_t size_of(const RockColumn& column) {
  return column.memory_size() + 2 * column.heights().size();
}

/// The memory of the far rock with this number.
template <typename Numbers>
Numbers memory_of(std::span<const FarRock> far, std::size_t points, Numbers memory, std::size_t k) {
  std::size_t begin = points_begin + numbers_of_point * points;
  for (std::size_t i = 0; i < k; ++i) begin += size_of(far[i].column);
  return memory.subspan(begin, size_of(far[k].column));
}

}  // namespace

/// Tractions are those beyond the one before the run.
struct SeismicBoundary::PointMemory {
  Vec2 anchor;    ///< m, u_a
  Vec2 offset;    ///< Pa, t_a or t_0
  Vec2 traction;  ///< Pa, at the end of the last step

  static PointMemory read(std::span<const double> memory, std::size_t k) {
    const double* m = &memory[points_begin + numbers_of_point * k];
    return {{m[0], m[1]}, {m[2], m[3]}, {m[4], m[5]}};
  }
  void write(std::span<double> memory, std::size_t k) const {
    double* m = &memory[points_begin + numbers_of_point * k];
    m[0] = anchor.x, m[1] = anchor.y;
    m[2] = offset.x, m[3] = offset.y;
    m[4] = traction.x, m[5] = traction.y;
  }
};

/// dead − spring (stretch + d) − dashpot (velocity + share d), Pa, for an increment d of the point; x and y alike.
struct SeismicBoundary::Law {
  Vec2 dead;
  Vec2 spring, stretch;  ///< Pa/m, and m at the start of the step
  Vec2 dashpot;          ///< Pa s/m
  Vec2 velocity;         ///< m/s, v′ − v_far of d = 0
  double share = 0.0;    ///< ∂v′/∂d, 1/s

  [[nodiscard]] Vec2 stiffness() const { return spring + share * dashpot; }
  [[nodiscard]] Vec2 viscous(Vec2 d) const { return -by_axis(dashpot, velocity + share * d); }
  [[nodiscard]] Vec2 traction(Vec2 d) const { return dead - by_axis(spring, stretch + d) + viscous(d); }
};

/// The boundary in a step from a state: of which kind it is, what the far rock does in it, and the laws of its points.
class SeismicBoundary::Step {
 public:
  Step(const SeismicBoundary& of, const Model& model, const State& state, const Drive& drive,
       std::span<const double> memory)
      : of_(of),
        model_(model),
        state_(state),
        drive_(drive),
        memory_(memory),
        after_(memory.begin(), memory.end()) {
    for (std::size_t k = 0; k < of_.far_.size(); ++k) {
      const RockColumn& column = of_.far_[k].column;
      const std::span<double> after = far_after(k);
      const std::span<const double> before = memory_of(std::span(of_.far_), of_.points_.size(), memory_, k);
      if (drive_.is_static) {
        // It is at rest where the last dynamic step left it.
        column.rest(after.first(column.memory_size()), after.subspan(column.memory_size()));
      } else {
        column.step(before, drive_.step, Integrator::of(model_.solver), drive_.ground_acceleration, after);
        strained_.push_back(column.strained(before, drive_.step, after));
      }
    }
    after_[0] = drive_.is_static ? 0.0 : 1.0;
  }

  /// Whether springs held the point until now, and dashpots do from now on.
  [[nodiscard]] bool lets_go(const BoundaryPoint& p) const {
    return p.absorbs && !drive_.is_static && memory_[0] == 0.0;
  }
  /// What the point remembers as it is of use in this kind of step.
  [[nodiscard]] PointMemory start(std::size_t k) const {
    const BoundaryPoint& p = of_.points_[k];
    PointMemory m = PointMemory::read(memory_, k);
    const bool takes_hold = p.absorbs && drive_.is_static && memory_[0] != 0.0;
    if (lets_go(p) || takes_hold) m.offset = m.traction;
    if (takes_hold) m.anchor = displacement(p);
    return m;
  }
  [[nodiscard]] Law law(const PointMemory& m, std::size_t k) const {
    const BoundaryPoint& p = of_.points_[k];
    Law law;
    law.dead = p.traction + m.offset;
    if (drive_.is_static || !p.absorbs) {
      law.spring = p.springs;
      law.stretch = displacement(p) - m.anchor;
      return law;
    }
    law.dashpot = p.dashpots;
    const Integrator& rule = drive_.rule[at(p.point.block)];
    law.share = rule.end_velocity_share() / drive_.step;
    law.velocity = coasting(p, rule);
    if (p.far < 0) return law;
    const RockColumn& column = of_.far_[at(p.far)].column;
    const std::span<const double> after = far_after(at(p.far));
    law.dead += column.stress(strained_[at(p.far)], p.in_far).on(p.normal);
    law.velocity -= column.motion(after, p.in_far).velocity;
    return law;
  }
  /// m/s, of the rock far away where the points of damping are.
  [[nodiscard]] std::vector<Vec2> far_velocities() const { return far_velocities(after_); }
  /// The same at the start of the step.
  [[nodiscard]] std::vector<Vec2> far_velocities_before() const { return far_velocities(memory_); }
  /// Pa, what the point feels at the start of the step as it was at the end of the last one, dashpots (viscous) and all but them (dead).
  struct AtStart {
    Vec2 dead, viscous;
  };
  [[nodiscard]] AtStart at_start(const Law& law, std::size_t k) const {
    const BoundaryPoint& p = of_.points_[k];
    const Block& block = model_.blocks[at(p.point.block)];
    Vec2 velocity = field_at(p.point.phi.data(), block.size, &state_.velocity[block.first]);
    if (p.far >= 0) {
      const std::size_t far = at(p.far);
      velocity -=
          of_.far_[far]
              .column.motion(memory_of(std::span(of_.far_), of_.points_.size(), memory_, far), p.in_far)
              .velocity;
    }
    AtStart start;
    start.viscous = -by_axis(law.dashpot, velocity);
    start.dead = p.traction + PointMemory::read(memory_, k).traction - start.viscous;
    return start;
  }
  /// The memory after the step, except for what the points have.
  [[nodiscard]] std::span<double> after() { return after_; }

 private:
  [[nodiscard]] std::vector<Vec2> far_velocities(std::span<const double> memory) const {
    std::vector<Vec2> velocities;
    if (drive_.is_static) return velocities;
    for (const FarPlace& place : of_.damped_) velocities.push_back(of_.far_ground(memory, place).velocity);
    return velocities;
  }
  [[nodiscard]] std::span<double> far_after(std::size_t k) {
    return memory_of(of_.far_, of_.points_.size(), std::span<double>(after_), k);
  }
  [[nodiscard]] std::span<const double> far_after(std::size_t k) const {
    return memory_of(of_.far_, of_.points_.size(), std::span<const double>(after_), k);
  }
  [[nodiscard]] Vec2 displacement(const BoundaryPoint& p) const { return displacement_of(p, model_, state_); }
  /// m/s: v′ of D = 0, which is linear in the motion at the start.
  [[nodiscard]] Vec2 coasting(const BoundaryPoint& p, const Integrator& rule) const {
    const Block& block = model_.blocks[at(p.point.block)];
    const auto of_point = [&](const std::vector<double>& coefficients) {
      if (coefficients.empty()) return Lanes{};
      const Vec2 v = field_at(p.point.phi.data(), block.size, &coefficients[block.first]);
      return lanes_from(v.x, v.y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    };
    const Motion start{of_point(state_.velocity), of_point(state_.acceleration), of_point(state_.force)};
    const Lanes end = rule.end(start, Lanes{}, drive_.step).velocity;
    return {end[0], end[1]};
  }

  const SeismicBoundary& of_;
  const Model& model_;
  const State& state_;
  const Drive& drive_;
  std::span<const double> memory_;
  std::vector<double> after_;
  std::vector<std::vector<double>> strained_;  ///< RockColumn::strained of each column, in a dynamic step
};

SeismicBoundary::SeismicBoundary(std::vector<BoundaryPoint> points, std::vector<FarRock> far,
                                 std::optional<MassDamping> damping)
    : points_(std::move(points)), sides_(points_), far_(std::move(far)), damping_(std::move(damping)) {
  if (!damping_ || far_.empty()) return;
  for (const MassPoint& point : damping_->points()) damped_.push_back(far_place(point.place));
}

std::size_t SeismicBoundary::memory_size() const {
  std::size_t size = points_begin + numbers_of_point * points_.size();
  for (const FarRock& far : far_) size += size_of(far.column);
  return size;
}

void SeismicBoundary::add_terms(const Model& model, const State& state, const Drive& drive,
                                std::span<const double> memory, BlockTerms& terms) const {
  const Step step(*this, model, state, drive, memory);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const BoundaryPoint& p = points_[k];
    const std::size_t b = at(p.point.block);
    if (!model.moves(b)) continue;
    const Law law = step.law(step.start(k), k);
    const Vec2 stiffness = p.length * law.stiffness(), force = p.length * law.traction({});
    terms.add_spring(b, 0, p.point.phi, stiffness.x, force.x);
    terms.add_spring(b, 1, p.point.phi, stiffness.y, force.y);
  }
  if (damping_) damping_->add_terms(model, state, drive, step.far_velocities(), terms);
}

CouplingTotals SeismicBoundary::account(const Attempt& attempt, std::span<const double> spin,
                                        std::size_t /*first*/, std::span<double> memory, State& state) const {
  const Model& model = attempt.model;
  Step step(*this, model, state, attempt.drive, memory);
  EnergyLedger& ledger = state.ledger;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const BoundaryPoint& p = points_[k];
    const Block& block = model.blocks[at(p.point.block)];
    if (!model.moves(at(p.point.block))) continue;
    PointMemory m = step.start(k);
    if (step.lets_go(p)) ledger.input -= stored(model, state, PointMemory::read(memory, k), k);
    const Law law = step.law(m, k);
    const Vec2 d = field_at(p.point.phi.data(), block.size, &attempt.increment[block.first]),
               turned = turn_at(p, block, spin[at(p.point.block)], state.position), stretch = law.stretch + d,
               not_stretched = by_axis(d - 0.5 * turned, turned);
    state.support_energy += 0.5 * p.length * dot(law.spring, by_axis(stretch, stretch));
    ledger.input += p.length * dot(law.dead, d);
    ledger.radiated -= p.length * dot(law.viscous(d), d);
    const double of_start = 1.0 - attempt.drive.end_share_of_work(p.point.block);
    if (of_start > 0.0 && p.absorbs) {
      const Step::AtStart start = step.at_start(law, k);
      const double dead = of_start * p.length * dot(start.dead - law.dead, d),
                   viscous = of_start * p.length * dot(start.viscous - law.viscous(d), d);
      ledger.input += dead;
      ledger.radiated -= viscous;
      ledger.numerical += dead + viscous;
    }
    // BlockTerms::elastic_loss has taken both for springs that do not turn with their block.
    ledger.numerical -= p.length * (dot(law.spring, not_stretched) +
                                    law.share * dot(law.dashpot, 0.5 * by_axis(d, d) + not_stretched));
    m.traction = law.traction(d) - p.traction;
    m.write(step.after(), k);
  }
  if (damping_) damping_->account(attempt, spin, step.far_velocities(), step.far_velocities_before(), state);
  std::copy(step.after().begin(), step.after().end(), memory.begin());
  return {};
}

double SeismicBoundary::stored(const Model& model, const State& state, const PointMemory& m,
                               std::size_t k) const {
  const BoundaryPoint& p = points_[k];
  const Vec2 stretch = displacement_of(p, model, state) - m.anchor;
  return 0.5 * p.length * dot(p.springs, by_axis(stretch, stretch));
}

double SeismicBoundary::stored_energy(const Model& model, const State& state, double /*time*/,
                                      std::span<const double> memory) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const BoundaryPoint& p = points_[k];
    if (!model.moves(at(p.point.block)) || (p.absorbs && memory[0] != 0.0)) continue;
    sum += stored(model, state, PointMemory::read(memory, k), k);
  }
  return sum;
}

std::vector<Carried> SeismicBoundary::carried(const Model& model, const State& state,
                                              std::span<const double> memory) const {
  std::vector<Vec2> tractions;
  for (std::size_t k = 0; k < points_.size(); ++k) tractions.push_back(PointMemory::read(memory, k).traction);
  return sides_.carried(points_, tractions, model, state);
}

FarPlace SeismicBoundary::far_place(Vec2 place) const {
  const FarRock &left = far_.front(), &right = far_.back();
  FarPlace p{left.column.place_of(place.y), right.column.place_of(place.y)};
  if (far_.size() > 1) p.share = std::clamp((place.x - left.x) / (right.x - left.x), 0.0, 1.0);
  return p;
}

GroundMove SeismicBoundary::far_ground(std::span<const double> memory, Vec2 place) const {
  return far_.empty() ? GroundMove{} : far_ground(memory, far_place(place));
}

GroundMove SeismicBoundary::far_ground(std::span<const double> memory, const FarPlace& place) const {
  const auto move = [&](std::size_t k, const RockColumn::Place& at_height) -> GroundMove {
    const RockColumn& column = far_[k].column;
    const std::span<const double> of_column = memory_of(std::span(far_), points_.size(), memory, k);
    const GroundMove now = column.motion(of_column, at_height);
    const Vec2 before = column.at_place(of_column.subspan(column.memory_size()), at_height);
    return {now.displacement + before, now.velocity};
  };
  const GroundMove left = move(0, place.left);
  if (far_.size() == 1) return left;
  const GroundMove right = move(far_.size() - 1, place.right);
  return {lerp(left.displacement, right.displacement, place.share),
          lerp(left.velocity, right.velocity, place.share)};
}

RockPlaneState SeismicBoundary::plane(std::span<const double> memory, std::size_t far, std::size_t k) const {
  return far_[far].column.plane(memory_of(std::span(far_), points_.size(), memory, far), k);
}

void SeismicBoundary::add_held_blocks(std::vector<int>& blocks) const {
  for (const BoundaryPoint& p : points_) {
    if (p.springs != Vec2{}) blocks.push_back(p.point.block);
  }
}

void SeismicBoundary::add_rounding_forces(const Model& model, double extent, std::span<double> force) const {
  for (const BoundaryPoint& p : points_) {
    double largest = 0.0;
    for (const double phi : p.point.phi) largest = std::max(largest, std::abs(phi));
    force[at(p.point.block)] += p.length * std::max(p.springs.x, p.springs.y) * extent * largest *
                                std::sqrt(model.blocks[at(p.point.block)].area);
  }
}

}  // namespace keyblock::dynamics
