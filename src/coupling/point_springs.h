#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "model/model.h"

namespace keyblock::dynamics {

/// A straight spring between material points of two blocks.
struct PointSpring {
  std::string name;
  double stiffness = 0.0;  ///< N/m per thickness
  double yield =
      0.0;          ///< N per thickness, largest force in tension and compression; infinite: it never yields
  Vec2 from, to;    ///< m, its ends before the run, when it has no force
  int staged = -1;  ///< State::installed that says whether it is there; −1: always

  /// m, without force.
  [[nodiscard]] double length() const { return norm(from - to); }
};

/// Springs between points of blocks: a coupling by rows. The shear spring of a row acts along the line between its points,
///
///     T = clamp(k (length now − length without force − p), ±yield)
///
/// with p the elongation that leaves no force, in the memory: what has yielded, what it was long when a stage installed it, and what pretension
/// asked for. The memory has what has yielded beside it, and how much longer than without force the spring was when it was installed. The normal spring acts across the line with T/L where T pulls: by that the force
/// turns with the line within the step. Lengths are those of the positions at the start of the step, so that nothing drifts.
class PointSprings final : public Coupling, public StagedSupports {
 public:
  /// points: two for each spring, its first end and its second.
  PointSprings(std::vector<PointSpring> springs, std::vector<MaterialPoint> points)
      : springs_(std::move(springs)), points_(std::move(points)) {}

  /// A spring as it is.
  struct Now {
    Vec2 from, to;  ///< m
    double length = 0.0, stiffness = 0.0, force = 0.0;
    bool is_there = false;
  };
  [[nodiscard]] std::vector<Now> now(const Model& model, const State& state,
                                     std::span<const double> memory) const;
  /// Yields as much as leaves a spring this force, N per thickness, where it is.
  void set_force(const Model& model, const State& state, std::size_t k, double force,
                 std::span<double> memory) const;
  [[nodiscard]] std::span<const PointSpring> springs() const { return springs_; }

  [[nodiscard]] std::span<const MaterialPoint> points() const override { return points_; }
  void add_pairs(BlockPairs& pairs) const override;
  [[nodiscard]] std::size_t memory_size() const override { return 3 * springs_.size(); }

  [[nodiscard]] std::size_t rows() const override { return springs_.size(); }
  RowFacts build(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 CouplingRows out) const override;
  [[nodiscard]] const StagedSupports* staged_supports() const override { return this; }
  void install(const Model& model, const State& state, std::span<const std::uint8_t> now,
               std::span<double> memory) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] double stored_energy(const Model& model, const State& state, double time,
                                     std::span<const double> memory) const override;
  [[nodiscard]] std::vector<Element> elements() const override;
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;
  void add_rounding_forces(const Model& model, double extent, std::span<double> force) const override;

 private:
  [[nodiscard]] const MaterialPoint& end(std::size_t k, std::size_t which) const {
    return points_[2 * k + which];
  }
  [[nodiscard]] bool is_there(const Model& model, const State& state, std::size_t k) const;
  /// N/m, which a program that steers the run may have changed.
  [[nodiscard]] double stiffness_of(const Model& model, std::size_t k) const {
    return model.spring_stiffness.empty() ? springs_[k].stiffness : model.spring_stiffness[k];
  }
  [[nodiscard]] double force_of(const Model& model, std::size_t k, double stretch) const {
    return std::clamp(stiffness_of(model, k) * stretch, -springs_[k].yield, springs_[k].yield);
  }
  /// Place in the memory, of what a spring has yielded.
  [[nodiscard]] std::size_t yielded(std::size_t k) const { return springs_.size() + k; }
  /// Likewise, of its length when it was installed over that without force.
  [[nodiscard]] std::size_t installed(std::size_t k) const { return 2 * springs_.size() + k; }
  /// From the second end to the first, m.
  [[nodiscard]] Vec2 chord(const Model& model, const State& state, std::size_t k) const;
  /// m, that has not yielded, of a spring of this length.
  [[nodiscard]] double stretch_of(std::size_t k, double length, std::span<const double> memory) const {
    return length - springs_[k].length() - memory[k];
  }

  std::vector<PointSpring> springs_;
  std::vector<MaterialPoint> points_;
};

}  // namespace keyblock::dynamics
