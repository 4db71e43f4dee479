#pragma once
#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "model/model.h"

namespace keyblock::dynamics {

/// A spring between material points of two bodies: along the line between them, or along or across the line of another spring.
struct PointSpring {
  std::string name;
  double stiffness = 0.0;  ///< N/m per thickness
  double yield =
      0.0;          ///< N per thickness, largest force in tension and compression; infinite: it never yields
  Vec2 from, to;    ///< m, its ends before the run, when it has no force
  int staged = -1;  ///< State::installed that says whether it is there; −1: always
  const char* kind = "spring";  ///< Element::kind
  double spacing = 0.0;         ///< m, Element::spacing
  double push = HUGE_VAL;       ///< N per thickness, the largest force that presses its ends apart
  bool pulls_only = false;      ///< it is slack where it is shorter than without force
  double rupture =
      std::numeric_limits<double>::infinity();  ///< m of yielded elongation, beyond which it breaks
  double pretension = 0.0;  ///< N per thickness, held until the end of the stage that installs it
  int across = -1;  ///< the spring, by number, across whose line it acts: a dowel; −1: along its own line
  std::pair<int, int> holes{
      -1,
      -1};  ///< of a dowel: springs whose second ends are where the ends of its bar were put in; −1: those ends
  int along = -1;     ///< the spring, by number, along whose line it acts: grout of a node; −1 likewise
  double hold = 0.0;  ///< N/m per thickness, across the line of `along`: what keeps a node in its hole
  std::pair<int, int> in{
      -1, -1};  ///< blocks without which it is not there; −1: the body of the end at hand, which is a block
  double yield_along = std::numeric_limits<double>::infinity();  ///< N per thickness, of the bar of a dowel

  [[nodiscard]] double least() const { return pulls_only ? 0.0 : -std::min(yield, push); }
  [[nodiscard]] bool has_events() const {
    return rupture < std::numeric_limits<double>::infinity() || pretension > 0.0;
  }
  [[nodiscard]] bool has_own_line() const { return across < 0 && along < 0; }
  /// m, between its ends without force.
  [[nodiscard]] double length() const { return has_own_line() ? norm(from - to) : 0.0; }
};

/// Springs between points of blocks: a coupling by rows. The shear spring of a row acts along the line between its points,
///
///     T = clamp(k (length − length without force − p), least, yield)
///
/// with p the elongation that leaves no force, in the memory: what has yielded, what it was long when a stage installed it, and what pretension
/// asked for. The memory has what has yielded beside it, and how much longer than without force the spring was when it was installed. The
/// normal spring acts across the line with T/L where T pulls: by that the force turns with the line within the step. Lengths are those of
/// the positions at the start of the step, so that nothing drifts. The force is that at the share q of the step (Integrator::place_of_spring):
/// a row of stiffness q k that is stretched by s/q at the start, s being what k was stretched by.
///
/// A dowel acts across the line of another spring, the bar, from a point of the one block to a point of the other: in the place of the length is
/// how far they are apart across the mean of the directions of the bar in the two blocks. It bears yield √(1 − (N/N_y)²) with the force N of the
/// bar, frozen while a step is minimized.
///
/// The grout of a node acts along the line of a bar, from the node to the point of the rock where it was put in: in the place of the length is how
/// far the node has come out there, from the first end of the bar to its second. What it yields is slip. `hold` acts across, both ways, without
/// a limit. A plate is such a spring that pulls only.
///
/// Events: a spring whose yielded elongation passes `rupture` breaks for good, and its dowel with it. While the stage that installs a spring with
/// pretension lasts, p is such that each step begins with that force; what a jack does then is input.
class PointSprings final : public Coupling, public StagedSupports {
 public:
  /// points: two for each spring, its first end and its second. drawn: likewise, where it is drawn from and to; empty: at its ends.
  PointSprings(std::vector<PointSpring> springs, std::vector<MaterialPoint> points,
               std::vector<MaterialPoint> drawn = {})
      : springs_(std::move(springs)),
        points_(std::move(points)),
        drawn_(std::move(drawn)),
        has_events_(std::ranges::any_of(springs_, &PointSpring::has_events)) {}

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
  [[nodiscard]] std::size_t memory_size() const override { return (has_events_ ? 5 : 3) * springs_.size(); }

  [[nodiscard]] std::size_t rows() const override { return springs_.size(); }
  RowFacts build(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 CouplingRows out) const override;
  void change_laws(const StepProblem& problem, std::size_t first, std::span<const double> memory,
                   std::vector<LawChange>& changes) const override;
  [[nodiscard]] const StagedSupports* staged_supports() const override { return this; }
  void place(const Model& model, State& state) const override;
  void install(const Model& model, State& state, std::span<const std::uint8_t> now,
               std::span<double> memory) const override;
  void end_stage(const Model& model, const State& state, std::span<double> memory) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] double stored_energy(const Model& model, const State& state, double time,
                                     std::span<const double> memory) const override;
  [[nodiscard]] std::vector<Element> elements() const override;
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;
  void add_rounding_forces(const Model& model, double extent, std::span<double> force) const override;

 private:
  /// Where a spring acts: along which direction, and how long it is.
  struct Line {
    Vec2 along;           ///< of length 1; zero: it has none
    double length = 0.0;  ///< m; of a dowel across its bar, and of grout along it, with its sign
    double aside = 0.0;   ///< m, of what `hold` acts on

    [[nodiscard]] Vec2 normal() const { return {along.y, -along.x}; }
  };
  /// A spring at the end of a step.
  struct End {
    double force = 0.0;   ///< N per thickness
    double beyond = 0.0;  ///< m, yielded in the step
  };

  [[nodiscard]] const MaterialPoint& end(std::size_t k, std::size_t which) const {
    return points_[2 * k + which];
  }
  /// Where an end of the bar of a dowel is in its hole.
  [[nodiscard]] const MaterialPoint& hole(std::size_t k, std::size_t which) const {
    const int other = which == 0 ? springs_[k].holes.first : springs_[k].holes.second;
    return other >= 0 ? end(at(other), 1) : end(bar_of(k), which);
  }
  [[nodiscard]] bool is_there(const Model& model, const State& state, std::size_t k,
                              std::span<const double> memory) const;
  /// The block that an end is in.
  [[nodiscard]] int block_of(std::size_t k, std::size_t which) const {
    const int in = which == 0 ? springs_[k].in.first : springs_[k].in.second;
    return in >= 0 ? in : end(k, which).block;
  }
  [[nodiscard]] bool is_installed_by(std::size_t k, std::span<const std::uint8_t> now) const {
    return springs_[k].staged >= 0 && now[at(springs_[k].staged)] != 0;
  }
  /// Puts its node where its hole is, at rest in it.
  void place_node(const Model& model, State& state, std::size_t k) const;
  /// N/m, which a program that steers the run may have changed.
  [[nodiscard]] double stiffness_of(const Model& model, std::size_t k) const {
    return model.spring_stiffness.empty() ? springs_[k].stiffness : model.spring_stiffness[k];
  }
  [[nodiscard]] double force_of(const Model& model, std::size_t k, double stretch) const {
    return std::clamp(stiffness_of(model, k) * stretch, springs_[k].least(), springs_[k].yield);
  }
  /// J per thickness.
  [[nodiscard]] double energy_of(const Model& model, std::size_t k, double stretch) const {
    return springs_[k].pulls_only && stretch < 0.0 ? 0.0 : 0.5 * stiffness_of(model, k) * stretch * stretch;
  }
  /// The same, and what holds a node.
  [[nodiscard]] double energy_of(const Model& model, std::size_t k, const Line& line,
                                 std::span<const double> memory) const {
    return energy_of(model, k, stretch_of(model, k, line.length, memory)) +
           0.5 * springs_[k].hold * line.aside * line.aside;
  }
  /// N per thickness, of a dowel whose bar has this force.
  [[nodiscard]] double strength_across(std::size_t k, double along) const;
  void change_dowel(const SpringArray& rows, std::size_t first, std::size_t k,
                    std::vector<LawChange>& changes) const;
  void change_bar(const StepProblem& problem, std::size_t first, std::size_t k,
                  std::span<const double> memory, std::vector<LawChange>& changes) const;
  [[nodiscard]] End end_of(const StepProblem& problem, std::size_t first, std::size_t k, double before) const;
  /// Whether it broke in the step at hand.
  [[nodiscard]] bool breaks(const SpringArray& rows, std::size_t first, std::size_t k) const {
    return rows.bound[first + bar_of(k)] == 0.0;
  }
  /// The spring itself, or the bar of a dowel.
  [[nodiscard]] std::size_t bar_of(std::size_t k) const {
    return springs_[k].across < 0 ? k : static_cast<std::size_t>(springs_[k].across);
  }

  // Places in the memory, after p: of what a spring has yielded; of its length when it was installed over that without force; whether it is
  // broken; whether it has pretension that is held.
  [[nodiscard]] std::size_t yielded(std::size_t k) const { return springs_.size() + k; }
  [[nodiscard]] std::size_t installed(std::size_t k) const { return 2 * springs_.size() + k; }
  [[nodiscard]] std::size_t broken(std::size_t k) const { return 3 * springs_.size() + k; }
  [[nodiscard]] std::size_t held(std::size_t k) const { return 4 * springs_.size() + k; }
  [[nodiscard]] bool is_broken(std::size_t k, std::span<const double> memory) const {
    return has_events_ && memory[broken(bar_of(k))] != 0.0;
  }
  [[nodiscard]] bool is_held(std::size_t k, std::span<const double> memory) const {
    return has_events_ && memory[held(k)] != 0.0;
  }

  [[nodiscard]] Line line_of(const Model& model, const State& state, std::size_t k) const;
  /// m, that has not yielded, of a spring of this length.
  [[nodiscard]] double stretch_of(const Model& model, std::size_t k, double length,
                                  std::span<const double> memory) const {
    return is_held(k, memory) ? springs_[k].pretension / stiffness_of(model, k)
                              : length - springs_[k].length() - memory[k];
  }
  [[nodiscard]] double stretch_of(const Model& model, const State& state, std::size_t k,
                                  std::span<const double> memory) const {
    return stretch_of(model, k, line_of(model, state, k).length, memory);
  }

  std::vector<PointSpring> springs_;
  std::vector<MaterialPoint> points_, drawn_;
  bool has_events_ = false;
};

}  // namespace keyblock::dynamics
