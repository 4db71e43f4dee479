#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/coupling.h"
#include "loading/time_table.h"

namespace keyblock::dynamics {

/// A spring from a material point to the ground in one direction; edges are many of them, with Gauss weights.
struct GroundSpring {
  int block = 0;
  std::size_t support = 0;    ///< that it is of
  int axis = 0;               ///< 0: x, 1: y
  std::vector<double> phi;    ///< N values at the point
  double anchor = 0.0;        ///< m, coordinate of the point at the start
  double stiffness = 0.0;     ///< N/m per thickness
  loading::TimeTable motion;  ///< m; empty: none

  /// Coordinate of the ground end at a time.
  [[nodiscard]] double target(double time) const { return anchor + (motion.empty() ? 0.0 : motion(time)); }
};

/// What a support holds: the point, or the stretch between two, twice the same where it is one.
struct SupportedPlace {
  std::string name;
  int block = 0;
  std::vector<double> from, to;  ///< N values of φ there
  Vec2 from_place, to_place;     ///< m, before the run
};

/// Supports: a coupling of single blocks with the ground, by terms.
class GroundSprings final : public Coupling {
 public:
  /// places: of each support, in the order of GroundSpring::support.
  GroundSprings(std::vector<GroundSpring> springs, std::vector<SupportedPlace> places)
      : springs_(std::move(springs)), places_(std::move(places)) {}

  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 BlockTerms& terms) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] double stored_energy(const Model& model, const State& state, double time,
                                     std::span<const double> memory) const override;
  [[nodiscard]] std::vector<Element> elements() const override;
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;
  void add_held_blocks(std::vector<int>& blocks) const override;
  void add_rounding_forces(const Model& model, double extent, std::span<double> force) const override;

 private:
  std::vector<GroundSpring> springs_;
  std::vector<SupportedPlace> places_;
};

}  // namespace keyblock::dynamics
