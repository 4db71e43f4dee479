#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/profile.h"
#include "dynamics/corrections.h"
#include "dynamics/options.h"
#include "dynamics/spring_array.h"
#include "dynamics/step_problem.h"
#include "linalg/block_solver.h"

namespace keyblock::dynamics {

/// The contacts of a step.
struct StepContacts {
  std::span<contact::Contact> contacts;
  std::uint64_t version = 0;  ///< the same for those of the same vertices and edges; 0: not known
};

/// What an open-close iteration did.
struct OpenCloseResult {
  bool converged = false;
  bool linear_failed = false;  ///< the linear solver gave up
  bool finite = true;          ///< what is out of balance is a number
  bool bond_broken = false;    ///< some contact lost its cohesion and tension on the way
  int iterations = 0;          ///< linear solves
  std::size_t bends = 0;       ///< contacts that changed piece on the way, as often as they did
  int refinements = 0;         ///< corrections of what the factor of an earlier step gets wrong
  int multiplier_updates = 0;  ///< of an augmented Lagrangian
  int bound_updates = 0;       ///< times the Coulomb bounds were taken anew
  bool given_up = false;       ///< at the first of them
};

/// A step was given up between two iterations, as the run was told to stop.
class Interrupted : public std::exception {};

/// Open-close iteration: a Newton method with an exact line search on the convex, piecewise quadratic Π(D) of a step.
///
///     1. with a factor: solve with the springs that acted in the last step; if the same springs act at the solution, that is
///        it; else correct it for those that act otherwise, a few of thousands, with the same factor (Corrections), until no
///        others do. The factor may be that of an earlier step with the same contacts and inertia: what its matrix, some
///        micrometres old, gets wrong shows in the exact gradient, and is refined away or, where that does not do, ends it;
///     2. where the solver has no factor, or they are many, repeat, from the increment that is guessed: solve ∇²Π p = −∇Π with
///        the springs acting at D, and go to the minimum of Π(D + αp), which is the root of a piecewise linear function of α.
///        The matrix of an iterative solver may be that of an earlier step, brought to these springs; the gradient, found
///        anew at the end, shows whether that did;
///     3. where the Coulomb bounds differ too much from μN at the solution, freeze them anew and go on from there
///        (a new contact has no friction otherwise, in its first step);
///     4. with an augmented Lagrangian, forces are moved from penetration to multipliers until none is left;
///     5. bonds whose strength is exceeded break, and the iteration goes on. A broken bond stays broken.
///
/// Along a Newton direction p the gradient is known without the matrix: ∇Π(D + αp) = (1 − α) ∇Π(D) − α ρ, with ρ what an
/// iterative solver left over, but for contacts that pass to another piece of their law on the way, which are few. So is
/// the slope that the line search needs.
class OpenClose {
 public:
  /// stop, if given, is looked at before every iteration; where it is set, Interrupted is thrown.
  explicit OpenClose(const std::atomic<bool>* stop = nullptr) : stop_(stop) {}

  /// d: the increment; a guess, for solvers without a factor to start from, and then the solution. Bonds that break are cleared
  /// in the memory of the contacts (one per row) and in the rows of the problem. gives_up: asked once bounds have to be taken anew,
  /// which is most of the work then; whether the step has to be taken again whatever comes of it.
  OpenCloseResult solve(StepProblem& problem, StepContacts step_contacts, linalg::BlockSolver& solver,
                        const SolverOptions& options, ThreadTeam& team, Profile& profile, std::span<double> d,
                        const std::function<bool()>& gives_up = {});

  /// m, of every vertex of the surface at the solution.
  [[nodiscard]] std::span<const Vec2> displacement() const { return displacement_; }
  /// r of every row at the solution.
  [[nodiscard]] std::span<const Vec2> relative() const { return r_; }
  [[nodiscard]] std::span<const double> gradient() const { return gradient_; }
  /// Makes the next step factor its matrix, as it does after a restart or when the pattern has changed.
  void forget_factor() {
    factor_.solver = nullptr;
    wait_ = 0;
    next_wait_ = 1;
  }

 private:
  using Piece = SpringArray::Piece;
  using Shear = SpringArray::Shear;
  using Force = SpringArray::Force;

  void look_at_stop() const {
    if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) throw Interrupted();
  }
  void begin(const StepProblem& problem, linalg::BlockSolver& solver, std::size_t coefficients);
  void begin_factor(const StepProblem& problem, linalg::BlockSolver& solver);
  [[nodiscard]] bool fits_factor(const StepProblem& problem, const linalg::BlockSolver& solver) const;
  [[nodiscard]] bool carry_contacts();
  void note_contacts();
  void try_factor(const StepProblem& problem, linalg::BlockSolver& solver);
  void judge_factor(const OpenCloseResult& result);
  void assemble(const StepProblem& problem, linalg::BlockSolver& solver);
  bool change_matrix(const StepProblem& problem, linalg::BlockSolver& solver);
  bool factor(const StepProblem& problem, linalg::BlockSolver& solver);
  bool solve_linear(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                    const OpenCloseResult& result);
  [[nodiscard]] static bool solves_near(const StepProblem& problem, const linalg::BlockSolver& solver);
  bool solve_near(const StepProblem& problem, linalg::BlockSolver& solver, double enough);
  bool improve_linear(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance);
  void find_ratios(const StepProblem& problem);
  [[nodiscard]] double out_of_balance(const StepProblem& problem);
  /// That of any block may be another.
  void gradient_changed() {
    out_of_balance_.reset();
    knows_ratios_ = false;
  }
  [[nodiscard]] static linalg::BlockSolver::Excess excess_over(const StepProblem& problem, double enough);
  /// Whether what is solved is the matrix of this step, to all the digits that are asked for.
  [[nodiscard]] bool is_exact(linalg::BlockSolver& solver) const {
    return !kept_ && (solver.halves() == nullptr || solver.halves()->is_exact());
  }
  /// Where it is not, the gradient is found anew before it counts as settled.
  [[nodiscard]] linalg::BlockSolver::Residual residual_kind(linalg::BlockSolver& solver) const {
    return is_exact(solver) ? linalg::BlockSolver::Residual::exact : linalg::BlockSolver::Residual::estimated;
  }
  bool minimize(const StepProblem& problem, linalg::BlockSolver& solver, const SolverOptions& options,
                bool warm, double enough, std::span<double> d, OpenCloseResult& result);
  /// What the two sides of some contacts are displaced by against each other: each, and along normals and tangents.
  struct Relatives {
    Pair each[lane_count];
    Lanes normal, tangent;
  };
  /// Calls of_some(c, count, relatives) with what displacement_ is of as many contacts as there are lanes, or fewer, from c on.
  template <typename OfSome>
  void for_relatives(std::span<const StepProblem::Row> rows, const OfSome& of_some) {
    team_->for_range(rows.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; c += lane_count) {
        const std::size_t count = std::min(end - c, std::size_t{lane_count});
        const auto row = [&](std::size_t i) -> const auto& {
          return rows[c + (i < count ? i : 0)];
        };
        Relatives r;
        for (std::size_t i = 0; i < lane_count; ++i) r.each[i] = row(i).relative(displacement_);
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
  void place(const StepProblem& problem, std::span<const double> d);
  void find_bent();
  void start_on_lines(const StepProblem& problem);
  void find_wanted();
  void correct_wanted(const StepProblem& problem, linalg::HalfSolver& halves);
  bool find_corrections(const linalg::HalfSolver& halves, std::size_t fresh);
  void find_rest(const StepProblem& problem);
  void forget_corrections();
  void find_free_blocks(const StepProblem& problem);
  void leave_out_bends(const StepProblem& problem);
  void find_gradient(const StepProblem& problem, std::span<const double> d);
  void hold(const StepProblem& problem, std::size_t c, int count);
  [[nodiscard]] Force bend_from_matrix(std::size_t c) const;
  void turn_against_gradient(std::size_t unknowns);
  bool solve_corrected(linalg::HalfSolver& halves, std::size_t fresh, std::span<double> direction);
  bool begin_correcting(const StepProblem& problem, linalg::BlockSolver& solver, double enough,
                        bool from_zero, std::span<double> direction);
  void go_corrected(const StepProblem& problem, std::span<const double> direction, std::span<double> d,
                    OpenCloseResult& result);
  bool correct_until_done(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                          bool from_zero, std::span<double> d, OpenCloseResult& result);
  bool correct(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance, bool from_zero,
               std::span<double> d, OpenCloseResult& result);
  bool newton_step(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance, double enough,
                   std::span<double> d, OpenCloseResult& result);
  [[nodiscard]] std::size_t bent_contacts() const;
  void find_direction(const StepProblem& problem);
  void find_contacts_of_blocks(const StepProblem& problem);
  void find_near(const StepProblem& problem);
  void find_direction_near(const StepProblem& problem);
  /// Of coefficients of the direction of search: with those of the gradient, and of the residual.
  struct Products {
    double gradient = 0.0, residual = 0.0;
    Products& operator+=(const Products& other) {
      gradient += other.gradient;
      residual += other.residual;
      return *this;
    }
  };
  [[nodiscard]] Products products_of(std::size_t k) const {
    return {gradient_[k] * direction_[k], residual_[k] * direction_[k]};
  }
  [[nodiscard]] Products products_near(const StepProblem& problem) const;
  /// Calls body(begin, end) for the coefficients that the direction of search moves or whose residual it changes, in parts.
  template <typename Body>
  void for_reached_coefficients(const StepProblem& problem, const Body& body) {
    if (!is_near_) return team_->for_range(direction_.size(), coefficients_worth_threads, body);
    for (const std::size_t b : near_.blocks) std::apply(body, problem.coefficients(b));
  }
  /// Likewise for the contacts.
  template <typename Body>
  void for_reached_contacts(const Body& body) {
    if (!is_near_) return team_->for_range(springs_->size(), contacts_worth_threads, body);
    for (const std::size_t c : near_.contacts) body(c, c + 1);
  }
  [[nodiscard]] double search_line(const StepProblem& problem);
  void find_bends(double alpha);
  [[nodiscard]] double slope(double alpha) const;
  void go(const StepProblem& problem, double alpha, std::span<double> d);
  void take_force(const StepProblem& problem, std::size_t c, Force before);
  static void add_force(const StepProblem& problem, std::size_t c, Force force, double scale,
                        std::span<double> out);
  [[nodiscard]] Force bend(std::size_t c, double alpha) const;
  void sum_bounds(const StepProblem& problem);
  [[nodiscard]] bool reverses(const StepProblem& problem, std::size_t c) const;
  bool let_reverse(const StepProblem& problem, double tolerance);
  bool update_bounds(StepProblem& problem, double tolerance);
  [[nodiscard]] Vec2 violation(const StepProblem& problem, const contact::Contact& contact,
                               std::size_t c) const;
  void shift_forces(const StepProblem& problem, double share);
  bool augment(StepProblem& problem, std::span<contact::Contact> contacts, double tolerance);
  bool renew_bonds(const StepProblem& problem, std::span<const contact::Contact> contacts);
  bool break_bonds(const StepProblem& problem, std::span<contact::Contact> contacts);

  const std::atomic<bool>* stop_;
  ThreadTeam* team_ = nullptr;
  Profile* profile_ = nullptr;
  SpringArray* springs_ = nullptr;              ///< of the problem
  std::vector<Piece> factored_;                 ///< per contact: what the matrix at hand was made with
  bool assembled_ = false;                      ///< in this step
  std::span<const contact::Contact> contacts_;  ///< of this step
  std::uint64_t contacts_version_ = 0;
  /// What the factor at hand was made for.
  struct Factor {
    const linalg::BlockSolver* solver = nullptr;  ///< that has it; null: there is none
    std::vector<std::pair<int, int>> contacts;    ///< vertex and edge of each
    std::uint64_t version = 0;                    ///< of these
    std::vector<double> inertia;                  ///< per block
    std::vector<double> normal_stiffness,
        shear_stiffness;  ///< N/m per thickness, per contact: of springs in the matrix; else 0
    std::vector<StepProblem::Place> places;  ///< of these springs
    std::vector<int> held;                   ///< per unknown block: contacts that have such springs
    [[nodiscard]] bool has_spring(std::size_t c) const {
      return normal_stiffness[c] != 0.0 || shear_stiffness[c] != 0.0;
    }
  };
  Factor factor_;
  bool kept_ = false;                 ///< it is that of an earlier step
  bool tried_ = false;                ///< it was so at the start of the step
  std::size_t corrected_before_ = 0;  ///< springs that it was corrected for then
  int misses_ = 0;                    ///< Newton steps of this step that were not exact enough after all
  int wait_ = 0, next_wait_ = 1;      ///< steps until a factor is kept again; after the next failure
  std::vector<std::size_t> free_;     ///< blocks that nothing holds
  std::vector<StepProblem::SpringChange> changes_;  ///< scratch: of change_matrix
  std::vector<std::size_t> bends_;  ///< contacts that change piece along the direction of search
  /// The normal or the shear spring of a contact.
  struct Corrected {
    std::size_t contact;
    bool normal;
    friend bool operator==(Corrected, Corrected) = default;
  };
  void leave_out(const StepProblem& problem, Corrected spring, double force);
  static constexpr double linear_share =
      0.3;  ///< of the tolerance of a step, what its linear systems may leave over
  static constexpr std::size_t most_corrected = 64;  ///< springs, beyond which a factorization takes less
  static constexpr std::size_t most_kept =
      32;  ///< as many as are expected in the next step, with which a factor is worth keeping
  static constexpr int most_refinements = 3;  ///< more of them take what a factorization does
  Corrections corrections_;                   ///< to the matrix at hand
  std::vector<Corrected> corrected_;          ///< the springs of these
  std::vector<Corrected> wanted_;             ///< scratch
  std::vector<Corrections::Law> laws_;
  std::vector<double> stretch_, part_a_, part_b_;
  std::vector<double>
      correction_force_;      ///< N per thickness, per corrected spring: what it does otherwise than its line
  std::vector<double> base_;  ///< half of the way from D on which no spring is corrected
  std::vector<Vec2> displacement_;  ///< m, of vertices: of D, or of the direction of search
  std::vector<Vec2> vertex_force_;  ///< scratch
  std::vector<Vec2> r_;
  bool knows_relative_ = false;        ///< r_ is that of the springs
  std::vector<Vec2> shift_;            ///< m, of springs: normal, shear
  std::vector<double> sliding_bound_;  ///< N per thickness, per block; scratch
  std::vector<std::size_t> reversed_;  ///< contacts; scratch
  double worst_ = 0.0;                 ///< m, largest penetration or drift at the last update of multipliers
  double worst_without_ = 0.0;         ///< m, the same before the first of them
  int stalls_ = 0;                     ///< updates in a row that did not make it smaller
  double multiplier_share_ = 0.0;      ///< of the inertia behind a contact, in the step of Uzawa's iteration
  /// Of a bound, N per thickness: by how much it was wrong, and the change it got for it.
  struct BoundStep {
    double missing = 0.0, taken = 0.0;
  };
  std::vector<BoundStep>
      bound_steps_;             ///< per contact, of the last update in this step; empty before the first
  int bound_updates_ = 0;       ///< in this step
  double bound_error_ = 0.0;    ///< of the last of them, over all bounds
  double bound_damping_ = 1.0;  ///< share of its way that each contact goes
  std::vector<double> gradient_, direction_;
  std::vector<double> ratios_;            ///< per block: by how much it is out of balance by gradient_
  bool knows_ratios_ = false;             ///< these are of the gradient at hand
  std::optional<double> out_of_balance_;  ///< the largest of them, where it is known
  std::vector<double> residual_;          ///< ρ of the last linear solution: A p = −g − ρ
  bool is_near_ = false;                  ///< it was of the neighbourhood of some blocks
  /// That neighbourhood.
  struct Near {
    std::vector<std::size_t> blocks;    ///< that move, and then those beside them
    std::size_t moved = 0;              ///< how many the former are
    std::vector<std::size_t> contacts;  ///< of the former
  };
  Near near_;
  linalg::BlockSolver::Reach reach_;    ///< scratch
  std::vector<std::uint8_t> is_taken_;  ///< scratch, per unknown block
  /// Contacts of each unknown block; empty: not needed yet.
  std::vector<std::size_t> first_contact_;
  std::uint64_t near_version_ = 0;  ///< StepContacts::version of these
  std::vector<std::uint32_t> contacts_of_block_;
  std::vector<std::size_t> out_of_balance_blocks_;  ///< scratch: Block::unknown of these
  /// The way of the first system of all blocks is gone to its end: few contacts would hold all blocks back, and what these do
  /// otherwise is mended near them.
  bool may_go_whole_way_ = false;
  double slope_at_zero_ = 0.0, curvature_ = 0.0;
};

}  // namespace keyblock::dynamics
