// The linear systems of a step: which pairs of blocks they couple, and who solves them.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/index.h"
#include "dynamics/step.h"
#include "linalg/minimum_degree.h"

namespace keyblock::dynamics {

namespace {

using Unknowns = std::pair<int, int>;  // Block::unknown of two blocks, the smaller first

Unknowns unknowns_of(const Model& model, int a, int b) {
  return std::minmax(model.blocks[at(a)].unknown, model.blocks[at(b)].unknown);
}

}  // namespace

/// Where the pair of blocks of every candidate is in the pattern; both are in order.
void Stepper::find_pairs(const State& state) {
  const std::vector<contact::Candidate>& list = state.contacts.pairs;
  pair_of_candidate_.resize(list.size());
  auto next = state.pattern.begin();
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Unknowns pair = unknowns_of(model_, list[k].block_a, list[k].block_b);
    if (pair.first < 0) {
      pair_of_candidate_[k] = StepProblem::of_fixed;
      continue;
    }
    while (next != state.pattern.end() && *next < pair) ++next;
    pair_of_candidate_[k] = next != state.pattern.end() && *next == pair
                                ? static_cast<int>(next - state.pattern.begin())
                                : StepProblem::without_room;
  }
  knows_pairs_ = true;
}

/// Room in the matrix for every pair of blocks that has contacts. Pairs that have contacts no more keep theirs until they are many.
void Stepper::make_room(State& state) {
  constexpr double most_idle = 0.15;
  std::vector<Unknowns> used;
  for (const contact::Contact& c : contacts_) {
    const Unknowns pair = unknowns_of(model_, c.block_a, c.block_b);
    if (pair.first >= 0 && (used.empty() || used.back() != pair)) used.push_back(pair);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Unknowns> all;
  std::set_union(used.begin(), used.end(), state.pattern.begin(), state.pattern.end(),
                 std::back_inserter(all));
  const bool idle =
      static_cast<double>(all.size() - used.size()) > most_idle * static_cast<double>(used.size());
  state.pattern = idle ? std::move(used) : std::move(all);
  find_pairs(state);
  direct_.analysed = iterative_.analysed = false;
  products_.reset();
}

/// The solver that takes least, knowing the pattern. The choice depends on the state alone, so that a run that is resumed takes
/// the same.
linalg::BlockSolver& Stepper::solver(const State& state, bool is_static, bool must_be_direct) {
  // Block products of a factorization, for each block, that conjugate residuals are worth (docs/performance.md). Static steps have
  // little inertia, and need many more iterations.
  constexpr double dynamic_worth = 120.0, static_worth = 450.0;
  constexpr std::size_t never_factored = 30'000;  // blocks; not even the order of elimination is looked for
  const Profile::Scope scope(profile_, Phase::assembly);
  const LinearSolver wanted = model_.solver.linear;
  // Multipliers ask for more digits than conjugate residuals are stopped at.
  const bool may_iterate = !must_be_direct && model_.solver.contact == ContactMethod::penalty;
  bool iterative = may_iterate && wanted == LinearSolver::iterative;
  if (may_iterate && wanted == LinearSolver::automatic) {
    if (!products_) {
      products_ =
          unknown_sizes_.size() > never_factored
              ? HUGE_VAL
              : linalg::approximate_minimum_degree(static_cast<int>(unknown_sizes_.size()), state.pattern)
                    .products;
    }
    iterative =
        *products_ > (is_static ? static_worth : dynamic_worth) * static_cast<double>(unknown_sizes_.size());
  }
  Linear& linear = iterative ? iterative_ : direct_;
  if (!linear.analysed) {
    linear.solver->analyse(unknown_sizes_, state.pattern);
    open_close_.forget_factor();
  }
  linear.analysed = true;
  return *linear.solver;
}

}  // namespace keyblock::dynamics
