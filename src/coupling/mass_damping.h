#pragma once
#include <span>
#include <vector>

#include "coupling/coupling.h"

namespace keyblock::dynamics {

/// A point of the rule by which the motion of the ground is averaged over a block.
struct MassPoint {
  MaterialPoint point;
  Vec2 place;         ///< m, before the run
  double area = 0.0;  ///< m², its weight in the rule
};

/// The part of Rayleigh damping in proportion to mass: a force −α ρ (v′ − v_ground) on all of a block, with v′ its velocity at the end of a
/// step. It acts in dynamic steps. What moves as the ground does feels nothing; what falls is slowed.
class MassDamping {
 public:
  /// rate: 1/s, α. Points stand block by block.
  MassDamping(double rate, std::vector<MassPoint> points) : rate_(rate), points_(std::move(points)) {}

  [[nodiscard]] std::span<const MassPoint> points() const { return points_; }
  /// ground: m/s, velocity of the ground at each of the points, at the end of the step; empty: at rest.
  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const Vec2> ground,
                 BlockTerms& terms) const;
  /// Into the ledger of energy, before blocks are moved. ground_before: m/s, at the start of the step; empty: at rest.
  void account(const Attempt& attempt, std::span<const double> spin, std::span<const Vec2> ground,
               std::span<const Vec2> ground_before, State& state) const;

 private:
  struct Drag;
  template <typename OfBlock>
  void for_blocks(const Model& model, const State& state, const Drive& drive, std::span<const Vec2> ground,
                  const OfBlock& of_block) const;

  double rate_;
  std::vector<MassPoint> points_;
};

/// The same where the ground is at rest, as without a seismic boundary.
class FrameDamping final : public Coupling {
 public:
  explicit FrameDamping(MassDamping damping) : damping_(std::move(damping)) {}
  void add_terms(const Model& model, const State& state, const Drive& drive,
                 std::span<const double> /*memory*/, BlockTerms& terms) const override {
    damping_.add_terms(model, state, drive, {}, terms);
  }
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t /*first*/,
                         std::span<double> /*memory*/, State& state) const override {
    damping_.account(attempt, spin, {}, {}, state);
    return {};
  }

 private:
  MassDamping damping_;
};

}  // namespace keyblock::dynamics
