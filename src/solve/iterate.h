#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "solve/step_system.h"

namespace keyblock::dynamics {

/// What an iteration changes: the increment D, what is known of it, and the direction p in which it goes on. The springs of the problem are
/// part of it: their stretches y, w are those at D, dy and dw those of p.
class Iterate {
 public:
  using Force = SpringArray::Force;

  /// At the start of a step; D is a guess.
  void begin(const StepSystem& system, std::span<double> increment);

  /// Displacements, stretches of the springs and their branches at D.
  void place(const StepSystem& system);
  /// Where that has not been done since D changed.
  void place_if_moved(const StepSystem& system) {
    if (!is_placed) place(system);
  }
  /// ∇Π(D), of the springs where they are.
  void find_gradient(const StepSystem& system);
  /// gradient += scale · ∂ψ/∂D of a row whose springs push with `force`.
  void add_force(const StepSystem& system, std::size_t c, Force force, double scale = 1.0);
  /// Changes the law of a spring, by change(), and what that does to its branch and to the gradient.
  template <typename Change>
  void change_spring(const StepSystem& system, std::size_t c, const Change& change) {
    const Force before = system.springs().force(c);
    change();
    take_force(system, c, before);
  }
  /// The bond of a row has broken: faces that it is in pull no more.
  void let_go_of_faces(const StepSystem& system, std::size_t c);
  /// Forgets what is known of how far blocks are out of balance.
  void gradient_changed() {
    largest_ratio_.reset();
    knows_ratios_ = false;
  }
  /// The same where the gradient changed at these blocks only.
  void gradient_changed_at(const StepSystem& system, std::span<const std::size_t> blocks);
  /// Per block, by how much it is out of balance by the gradient: BlockTerms::residual_ratio.
  [[nodiscard]] std::span<const double> ratios(const StepSystem& system);
  /// The largest of them.
  [[nodiscard]] double out_of_balance(const StepSystem& system);
  /// Whether the gradient is a number.
  [[nodiscard]] bool is_finite(ThreadTeam& team) const;
  /// −gradient into the direction, of the first n coefficients.
  void turn_against_gradient(std::size_t n);

  /// What the two sides of some rows are displaced by against each other: each, and along normals and tangents.
  struct Relatives {
    Pair each[lane_count];
    Lanes normal, tangent;
  };
  /// Calls of_some(c, count, relatives) with what `displacement` is of as many rows as there are lanes, or fewer, from c on.
  template <typename OfSome>
  void for_relatives(const StepSystem& system, const OfSome& of_some) const {
    const std::span<const Row> rows = system.problem.rows();
    system.team.for_range(rows.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; c += lane_count) {
        const std::size_t count = std::min(end - c, std::size_t{lane_count});
        const auto row = [&](std::size_t i) -> const auto& {
          return rows[c + (i < count ? i : 0)];
        };
        Relatives r;
        for (std::size_t i = 0; i < lane_count; ++i) r.each[i] = row(i).relative(displacement);
        const Lanes x = each_lane([&](std::size_t i) { return r.each[i][0]; }),
                    y = each_lane([&](std::size_t i) { return r.each[i][1]; }),
                    nx = each_lane([&](std::size_t i) { return row(i).normal.x; }),
                    ny = each_lane([&](std::size_t i) { return row(i).normal.y; });
        r.normal = nx * x + ny * y;
        r.tangent = -ny * x + nx * y;
        of_some(c, count, r);
      }
    });
  }

  std::span<double> increment;     ///< D
  std::vector<double> gradient;    ///< ∇Π(D)
  std::vector<double> direction;   ///< p
  std::vector<double> residual;    ///< ρ of the last linear solution: A p = −g − ρ
  std::vector<Vec2> displacement;  ///< m, of vertices: of D, or of p
  std::vector<Vec2> relative;      ///< m, r of every row
  std::vector<Vec2> vertex_force;  ///< scratch
  bool is_placed = false;          ///< `relative` is that at D

 private:
  void take_force(const StepSystem& system, std::size_t c, Force before);

  std::vector<double> ratios_;
  bool knows_ratios_ = false;
  std::optional<double> largest_ratio_;
};

}  // namespace keyblock::dynamics
