#pragma once
#include <atomic>
#include <span>
#include <vector>

#include "contact/detection.h"
#include "core/parallel.h"
#include "core/profile.h"
#include "coupling/attempt.h"
#include "coupling/contact_coupling.h"
#include "coupling/step_problem.h"
#include "dynamics/contact_audit.h"
#include "dynamics/contact_finder.h"
#include "dynamics/force_balance.h"
#include "dynamics/intrusions.h"
#include "dynamics/linear_systems.h"
#include "dynamics/predicted_motion.h"
#include "dynamics/rotation_correction.h"
#include "dynamics/step_accounts.h"
#include "dynamics/step_breaks.h"
#include "dynamics/step_rules.h"
#include "model/model.h"
#include "model/state.h"
#include "solve/earlier_attempt.h"
#include "solve/increment_history.h"
#include "solve/open_close.h"

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
  bool taken = true;               ///< false: a trial, after which everything is where it was
  double penetration = 0.0;        ///< m, largest depth of a contact
  double max_displacement = 0.0;   ///< m, of a vertex
  ContactAudit audit;              ///< over all substeps
  int closed_contacts = 0;         ///< at the end
  std::vector<JointBreak> breaks;  ///< of joints, over all substeps
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

/// What a contact does at the end of a step.
struct ContactForce {
  double normal = 0.0, shear = 0.0;  ///< N per thickness
  double gap = 0.0;                  ///< m, as the law of its joint has it: negative where it is pressed
  contact::State state = contact::State::open;
};

/// Attempts at one step so far, and what the next one is made with.
struct Attempts {
  int count = 1;                ///< where blocks moved too far or struck each other
  int rotations = 0;            ///< with a new rotation correction
  bool must_be_direct = false;  ///< conjugate residuals did not converge
  bool same_contacts = false;   ///< those of the attempt before
  bool bond_broken = false;     ///< in the attempt before

  [[nodiscard]] bool is_first() const { return count == 1 && rotations == 0; }
};

/// Advances a State. Owns scratch memory and the factorization, but nothing that a restart would miss.
///
/// A step is a list of stages, each of them a class or a function:
///
///     predict   how far blocks may go (PredictedMotion), by which rule of integration (StepRules)
///     find      the contacts (ContactFinder), and the pattern of the matrix (LinearSystems)
///     build     the minimization (StepProblem)
///     solve     open-close iteration (OpenClose)
///     check     the solution (Verdict): find, build and solve again, or take a shorter step, or
///     accept    energies and memory (StepAccounts), positions and velocities
///
/// When the iteration does not settle, when blocks turn by more than forces can keep their directions for, or when a block comes to lie
/// in another one, the step is cut in two from where it started.
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
  void forget_history();
  /// Other laws of joints from the next step on (Surface::joint says which edge has which): strengths that are reduced step by step, joints
  /// that degrade. Springs keep the energy that they store. Bonds are made by start() only; they get their new strength, and a bond with
  /// neither cohesion nor tension breaks when it is pulled or slips. A run that is resumed has to be given the laws again: they are part of
  /// the model, not of the state. Throws std::invalid_argument unless there are as many as before.
  void set_laws(std::vector<contact::JointLaw> laws);
  /// The contacts of the state as it is, found anew.
  [[nodiscard]] std::vector<contact::Contact> find_contacts(const State& state) {
    return finder_.find_anew(motion_, state);
  }
  /// After excavation: forgets the contacts of blocks that are gone.
  void remove_absent(State& state);

  /// One dynamic step of length dt, s.
  StepReport advance(State& state, double dt, const GroundAcceleration* ground);
  /// One static step: velocities are zero before and after. A trial may not be taken (StepReport::taken). Afterwards balance() is known.
  StepReport relax(State& state, const StaticStep& static_step);
  /// Finds the contacts of the state. The problem has the forces there, at D = 0, shear forces within the Coulomb bounds of the normal ones.
  const StepProblem& find_forces(State& state);
  /// Whether the equilibrium that the last static step reached is stable: ∇²Π + σ ρ > 0 with a small σ, where all contacts that press hold along
  /// their joints. What slides is not asked for: static steps name it. The block that goes farthest where it gives way; −1: it is stable, or the model is too large for the test.
  /// left_out: per block, whether it is held where it is.
  int find_unstable_block(State& state, const std::vector<bool>& left_out);
  /// m, per block: how far its vertices went in the last static step, or would go in one that was not taken.
  [[nodiscard]] std::span<const double> travel() const { return travel_; }
  /// Forces that nothing balances, at the position that the last static step reached.
  [[nodiscard]] const ForceBalance& balance() const { return balance_; }
  [[nodiscard]] std::span<const contact::Contact> contacts() const { return finder_.contacts(); }
  /// Of every contact at the end of the last step; of none where no step was taken.
  [[nodiscard]] std::vector<ContactForce> forces() const;
  /// The same from contact `first` on, as many as there is room for. Throws std::out_of_range beyond force_count().
  void forces(std::size_t first, std::span<ContactForce> to) const;
  [[nodiscard]] std::size_t force_count() const;

 private:
  void predict(const State& state, Drive& drive);
  void find(State& state, const Drive& drive);
  void build(State& state, const Drive& drive, bool knows_contacts);
  linalg::BlockSolver& choose_solver(const State& state, bool is_static, bool must_be_direct);
  /// The solution at hand, of the step from this state.
  [[nodiscard]] Attempt solution(const State& state, const Drive& drive) const;
  [[nodiscard]] Verdict check(const Attempt& attempt, const OpenCloseResult& result, bool may_meet_impacts);
  /// One attempt: build, solve, check.
  Verdict solve(State& state, Drive& drive, const SolverOptions& options, Attempts& attempts,
                StepReport& report);
  bool attempt(State& state, Drive& drive, const SolverOptions& options, StepReport& report);
  [[nodiscard]] Drive static_drive(const State& state, std::span<const double> inertia_scale) const;
  void accept(State& state, const Drive& drive, StepReport& report);
  void substep(State& state, double t0, double t1, const GroundAcceleration* ground, int halvings,
               StepReport& report);

  Model& model_;
  ThreadTeam& team_;
  Profile& profile_;
  PredictedMotion motion_;
  StepRules rules_;
  ContactFinder finder_;
  LinearSystems systems_;
  ContactCoupling contact_coupling_;
  StepProblem problem_;
  OpenClose open_close_;
  RotationCorrection rotation_;
  Intrusions intrusions_;
  StepAccounts accounts_;
  ForceBalance balance_;
  EarlierAttempt earlier_attempt_;
  IncrementHistory history_;       ///< of dynamic steps
  std::vector<double> increment_;  ///< D, by Block::first
  bool quiet_ = false;             ///< no contact changed its branch in it
  std::vector<Vec2> prescribed_;   ///< m, per block, in the step; empty: no fixed block is moved
  std::vector<double> travel_;     ///< m, per block, of static steps
};

}  // namespace keyblock::dynamics
