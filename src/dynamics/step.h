#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contact/detection.h"
#include "core/parallel.h"
#include "core/profile.h"
#include "dynamics/earlier_attempt.h"
#include "dynamics/force_balance.h"
#include "dynamics/increment_history.h"
#include "dynamics/intrusions.h"
#include "dynamics/model.h"
#include "dynamics/open_close.h"
#include "dynamics/state.h"
#include "dynamics/step_problem.h"

namespace keyblock::dynamics {

/// Acceleration of the base as the stepper asks for it.
class GroundAcceleration {
 public:
  virtual ~GroundAcceleration() = default;
  [[nodiscard]] virtual Vec2 mean(double t0, double t1) const = 0;
  [[nodiscard]] virtual Vec2 at(double t) const = 0;
};

/// How a step went; data, not log lines.
struct StepReport {
  int iterations = 0;     ///< linear solves, over all substeps
  int substeps = 1;       ///< > 1: the step did not settle and was repeated in smaller ones
  int halvings = 0;       ///< of the shortest that it was taken in, which need not be equally long
  double shortest = 0.0;  ///< s, length of that one; of a static step, its pseudo time step
  bool converged = true;
  bool taken = true;              ///< false: a trial, after which everything is where it was
  double penetration = 0.0;       ///< m, largest depth of a contact
  double max_displacement = 0.0;  ///< m, of a vertex
  int closed_contacts = 0;        ///< at the end
};

/// How a static step is taken.
struct StaticStep {
  double step = 0.0;                      ///< s, pseudo time step: what keeps the step small
  std::span<const double> inertia_scale;  ///< per block, factor on its inertia
  /// Residual of a block over its weight at which the step has converged, no more than that of the scenario.
  double tolerance = HUGE_VAL;
  /// Friction bounds are all that is left to be found, and are taken anew as often as that needs.
  bool settles_bounds = false;
  /// A step that is tried: Π is bounded from below, blocks may turn as far as they go, and the step is halved once at most. It is taken
  /// only if it converges and no vertex goes farther than `farthest`.
  bool is_trial = false;
  double farthest = HUGE_VAL;  ///< m
};

/// Advances a State. Owns scratch memory and the factorization, but nothing that a restart would miss.
///
/// A step, in order: detect contacts; build the minimization; open-close iteration; take over the increment (pose update,
/// contact memory, energies). It is taken again where blocks meet at speed, went further than contacts were looked for, or turned so
/// that contacts miss the gap at its end. When the iteration does not settle, or a block in contact turns by more than forces can keep
/// their directions for, the step is cut in two from where it started.
class Stepper {
 public:
  /// stop, if given and set, ends a step between two of its iterations: advance() and relax() throw Interrupted then. The state is that
  /// of a moment within the step.
  Stepper(Model& model, ThreadTeam& team, Profile& profile, const std::atomic<bool>* stop = nullptr);

  /// Brings the surface to the state and finds the contacts of joints in place; once, before the first step.
  void start(State& state);
  /// Brings everything derived to a state read from a checkpoint.
  void resume(State& state);
  /// Sums the energy stored in springs anew, after something else than a step has changed which there are.
  void sum_stored_energy(State& state) const;
  /// Finds it anew, after something else than a step has changed where blocks are.
  void measure_stored_energy(State& state);
  /// Makes the next step look at all blocks and factor its matrix anew, as it does after a restart: with that at every
  /// checkpoint, a run that is resumed gives the same bits as one that is not.
  void forget_history() {
    candidates_.invalidate();
    open_close_.forget_factor();
    history_.forget();
  }
  /// The contacts of the state as it is, found anew.
  [[nodiscard]] std::vector<contact::Contact> find_contacts(const State& state);
  /// After excavation: forgets the contacts of blocks that are gone.
  void remove_absent(State& state);

  /// One dynamic step of length dt.
  StepReport advance(State& state, double dt, const GroundAcceleration* ground);
  /// One static step: velocities are zero before and after. A trial may not be taken (StepReport::taken). Afterwards balance() is known.
  StepReport relax(State& state, const StaticStep& static_step);
  /// m, per block: how far its vertices went in the last static step, or would go in one that was not taken.
  [[nodiscard]] std::span<const double> ways() const { return static_ways_; }
  /// Forces that nothing balances, at the position that the last static step reached.
  [[nodiscard]] const ForceBalance& balance() const { return balance_; }
  [[nodiscard]] std::span<const contact::Contact> contacts() const { return contacts_; }
  /// What a contact did at the end of the last step.
  struct Force {
    double normal = 0.0, shear = 0.0;  ///< N per thickness
    contact::State state = contact::State::open;
  };
  /// Of every contact; of none where no step was taken.
  [[nodiscard]] std::vector<Force> forces() const;
  /// m, of contact k at the same time, as the law of its joint has it: negative where it is pressed.
  [[nodiscard]] double gap(std::size_t k) const;

  [[nodiscard]] double kinetic_energy(const State& state) const;
  [[nodiscard]] double strain_energy(const State& state) const;
  [[nodiscard]] double gravity_energy(const State& state) const;
  /// In the springs of contacts and of supports.
  [[nodiscard]] static double contact_energy(const State& state) {
    return state.contact_energy + state.support_energy;
  }

 private:
  /// Calls of_block(b) for the blocks that move.
  template <typename OfBlock>
  void for_blocks(const OfBlock& of_block) {
    team_.for_range(model_.blocks.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        if (model_.moves(b)) of_block(b);
      }
    });
  }
  void place(State& state);
  void prescribe(const State& state, Drive& drive);
  void move_prescribed(State& state, const Drive& drive);
  void build_problem(State& state, const Drive& drive, bool knows_contacts);
  void predict_reach(const State& state, const Drive& drive);
  void detect_at_rest(State& state);
  bool detect(State& state, bool is_static);
  void find_pairs(const State& state);
  void make_room(State& state);
  linalg::BlockSolver& solver(const State& state, bool is_static, bool must_be_direct);
  bool attempt(State& state, Drive& drive, const SolverOptions& options, StepReport& report);
  void forget_pattern() {
    knows_pairs_ = direct_.analysed = iterative_.analysed = false;
    products_.reset();
  }
  void measure_spin(const State& state);
  bool comes_inside(const State& state);
  /// How what blocks turned by in the step compares with what its contacts know of it.
  enum class Turns { are_known, are_others, are_too_far };
  Turns look_at_turns(const State& state, bool is_static);
  [[nodiscard]] Vec2 at_end(const State& state, std::size_t vertex) const;
  template <typename Position>
  [[nodiscard]] Vec2 apart(const contact::Contact& c, const Position& position) const;
  struct BondMissed {
    double across = HUGE_VAL, along = HUGE_VAL;  ///< m
  };
  [[nodiscard]] BondMissed bond_missed(std::size_t c) const;
  [[nodiscard]] double least_bond_missed() const;  ///< m, of all bonds
  double keep_turned_shear(State& state);
  [[nodiscard]] double support_energy(const State& state, double time) const;
  void account_for_turns(State& state, const Drive& drive);
  bool moved_too_far();
  void choose_rules(const State& state, const Drive& drive);
  /// Of `count` coefficients from `first` on.
  static Motion motion(const State& state, std::size_t first, int count) {
    if (state.acceleration.empty()) return {.velocity = load_first(&state.velocity[first], count)};
    return {load_first(&state.velocity[first], count), load_first(&state.acceleration[first], count),
            load_first(&state.force[first], count)};
  }
  [[nodiscard]] double impact_speed(const Drive& drive) const;
  bool meet_impacts(const State& state, const Drive& drive);
  void accept(State& state, const Drive& drive, StepReport& report);
  void account(State& state, const Drive& drive);
  /// Where the energy of as many contacts as there are lanes went in the step, and how deep they are.
  struct ContactAccounts {
    contact::SpringLanes::Balance balance;
    Lanes stored_before{};  ///< J per thickness, at the start
    Lanes input{};          ///< J per thickness, by what fixed blocks are moved
    Lanes turned{};         ///< J per thickness, of the forces over Drive::turned: no block gets it
    Lanes penetration{};    ///< m
    Lanes closed{};         ///< at the end: 1, else 0
    void add(const ContactAccounts& other);
    /// Zero where a lane is none of the first `count`.
    void leave_out_beyond(std::size_t count);
    void enter(EnergyLedger& ledger) const;
  };
  void remember_contacts(std::size_t first, std::size_t count, const Drive& drive,
                         std::span<contact::Memory> remembered, ContactAccounts& accounts);
  void remember_multiplier(std::size_t c, std::size_t lane, contact::Memory& memory,
                           ContactAccounts& accounts);
  void remember(State& state, const Drive& drive, StepReport& report);
  void find_ways();
  void measure_balance(State& state);
  void substep(State& state, double t0, double t1, const GroundAcceleration* ground, int halvings,
               StepReport& report);

  Model& model_;
  ThreadTeam& team_;
  Profile& profile_;
  contact::Tolerances tolerances_;
  contact::Candidates candidates_;
  contact::Detection detection_;
  StepProblem problem_;
  EarlierAttempt earlier_attempt_;
  OpenClose open_close_;
  /// A solver, and whether it knows the pattern.
  struct Linear {
    std::unique_ptr<linalg::BlockSolver> solver;
    bool analysed = false;
  };
  Linear direct_, iterative_;
  std::optional<double> products_;  ///< block products of a factorization with the pattern
  std::vector<contact::Contact> contacts_;
  std::uint64_t contacts_version_ = 1;  ///< StepContacts::version
  std::vector<int> unknown_sizes_;
  double largest_radius_ = 0.0;         ///< m, of the blocks that move
  std::vector<int> pair_of_candidate_;  ///< StepProblem::Row::pair
  bool knows_pairs_ = false;            ///< of these candidates and this pattern
  // Detection::Motion
  std::vector<double> reach_, turn_, way_;  ///< m and rad, per block
  std::vector<std::uint8_t> is_far_;        ///< per block: it went or turned farther than foreseen
  std::vector<Vec2> ahead_;                 ///< m, per vertex
  std::vector<Vec2> ahead_at_first_;        ///< the same in the first look at the step; empty: this is it
  std::vector<double> way_ahead_;           ///< m, per block
  std::vector<double> increment_;
  IncrementHistory history_;      ///< of dynamic steps
  bool quiet_ = false;            ///< no contact changed its branch in it
  std::vector<double> speed_;     ///< m/s, per block: largest of its vertices at the start of the step
  std::vector<double> spin_;      ///< rad, per block, of the last attempt
  std::vector<Integrator> rule_;  ///< per block, of the last attempt
  std::vector<Vec2> turned_,
      turned_now_;  ///< m, per contact: Drive::turned, empty: of none; and as the last attempt shows it
  std::vector<double> turned_energy_;    ///< J per thickness, per contact, scratch
  std::vector<std::uint8_t> in_impact_;  ///< per block, of the last attempt
  std::vector<Vec2> prescribed_;         ///< m, per block, in the step; empty: no fixed block is moved
  /// J per thickness, that a contact may do over what turning makes it miss; HUGE_VAL: without gravity there is no such measure.
  double turn_work_ = HUGE_VAL;
  std::vector<ContactAccounts> accounts_;  ///< scratch
  /// J per thickness.
  struct BlockWork {
    double numerical = 0.0, input = 0.0;
  };
  std::vector<BlockWork> block_work_;  ///< scratch
  std::vector<double> static_ways_;    ///< m, per block
  Intrusions intrusions_;
  ForceBalance balance_;
};

}  // namespace keyblock::dynamics
