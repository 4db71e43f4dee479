#pragma once
#include <atomic>
#include <exception>
#include <functional>
#include <span>

#include "solve/iterate.h"
#include "solve/kept_factor.h"
#include "solve/law_updates.h"
#include "solve/low_rank_update.h"
#include "solve/newton.h"
#include "solve/step_matrix.h"
#include "solve/step_system.h"

namespace keyblock::dynamics {

/// A step was given up between two iterations, as the run was told to stop.
class Interrupted : public std::exception {};

/// Open-close iteration: minimizes the convex, piecewise quadratic Π(D) of a step, and again, as long as its solution changes the laws of
/// the springs.
///
///     1. minimize Π with the laws as they are: by a low-rank update of the factor at hand where the solver has one (LowRankUpdate), of
///        this step or of an earlier one (KeptFactor); by Newton's method (Newton) where not, or where too many springs act otherwise;
///     2. where contacts that slid turn round, let their springs turn with the way of the step; go on with 1;
///     3. bonds whose strength is exceeded break, and what other couplings have to break; go on with 1. What is broken stays broken;
///     4. where the Coulomb bounds differ too much from μN at the solution, freeze them anew; go on with 1
///        (a new contact has no friction otherwise, in its first step).
///
/// Without any accelerator (SolverOptions::accelerators) it is Newton's method with a new factor in each iteration.
class OpenClose {
 public:
  /// stop, if given, is looked at before every iteration; where it is set, Interrupted is thrown.
  explicit OpenClose(const std::atomic<bool>* stop = nullptr) : stop_(stop) {}

  /// d: the increment; a guess, for solvers without a factor to start from, and then the solution. Bonds that break are cleared
  /// in the memory of the contacts (one per row) and in the rows of the problem. gives_up: asked once bounds have to be taken anew,
  /// which is most of the work then; whether the step has to be taken again whatever comes of it.
  OpenCloseResult solve(const StepSystem& system, std::span<double> d,
                        const std::function<bool()>& gives_up = {});

  /// m, of every vertex of the surface at the solution.
  [[nodiscard]] std::span<const Vec2> displacement() const { return iterate_.displacement; }
  /// r of every row at the solution.
  [[nodiscard]] std::span<const Vec2> relative() const { return iterate_.relative; }
  [[nodiscard]] std::span<const double> gradient() const { return iterate_.gradient; }
  /// Makes the next step factor its matrix, as it does after a restart or when the pattern has changed.
  void forget_factor() { kept_.reset(); }

 private:
  void look_at_stop() const {
    if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) throw Interrupted();
  }
  void begin(const StepSystem& system, std::span<double> d);
  bool change_laws(const StepSystem& system, OpenCloseResult& result);
  [[nodiscard]] bool is_exact(const StepSystem& system) const;
  bool factor(const StepSystem& system);
  bool minimize(const StepSystem& system, bool warm, double enough, OpenCloseResult& result);
  enum class Minimum { found, not_found, tried_kept_factor, failed };
  Minimum begin_minimum(const StepSystem& system, bool warm, bool updates, bool& from_zero);
  Minimum update(const StepSystem& system, int& tries, bool& from_zero, OpenCloseResult& result);
  Minimum newton(const StepSystem& system, double enough, OpenCloseResult& result);
  bool newton_step(const StepSystem& system, double enough, OpenCloseResult& result);
  bool settles(const StepSystem& system, double enough, OpenCloseResult& result);

  const std::atomic<bool>* stop_;
  Iterate iterate_;
  LawUpdates laws_;
  StepMatrix matrix_;
  KeptFactor kept_;
  LowRankUpdate update_;
  Newton newton_;
  int bond_updates_ = 0;  ///< in this step
  int misses_ = 0;        ///< Newton steps of this step that were not exact enough after all
};

}  // namespace keyblock::dynamics
