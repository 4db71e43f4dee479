// The linear systems of a step: which pairs of blocks they couple, and who solves them.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/index.h"
#include "dynamics/step.h"
#include "linalg/minimum_degree.h"

namespace keyblock::dynamics {

/// Room in the matrix for every pair of blocks that has contacts. A pair without room has the matrix analysed anew; pairs that
/// have contacts no more keep theirs until they are many.
void Stepper::ensure_pattern(State& state, bool candidates_changed) {
  using Pair = std::pair<int, int>;
  constexpr int fixed = -1, missing = -2;
  constexpr double most_idle = 0.15;
  const auto pair_of = [&](int a, int b) {
    return Pair(std::minmax(model_.blocks[at(a)].unknown, model_.blocks[at(b)].unknown));
  };
  const auto find_places = [&] {
    const std::vector<contact::Candidate>& list = state.contacts.pairs;
    pair_of_candidate_.resize(list.size());
    Pair last{fixed, fixed};
    int place = fixed;
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (const Pair pair = pair_of(list[k].block_a, list[k].block_b); pair != last) {
        const auto found = std::lower_bound(state.pattern.begin(), state.pattern.end(), pair);
        last = pair;
        place = pair.first < 0 ? fixed
                : found != state.pattern.end() && *found == pair
                    ? static_cast<int>(found - state.pattern.begin())
                    : missing;
      }
      pair_of_candidate_[k] = place;
    }
  };
  if (candidates_changed || !has_places_) find_places();
  has_places_ = true;
  std::vector<std::size_t> without_room;
  const auto has_none = [&](std::size_t c) {
    return pair_of_candidate_[at(contacts_[c].candidate)] == missing;
  };
  find_all(team_, contacts_.size(), contacts_worth_threads, has_none, without_room);
  if (without_room.empty()) return;
  std::vector<Pair> used;
  for (const contact::Contact& c : contacts_) {
    const Pair pair = pair_of(c.block_a, c.block_b);
    if (pair.first >= 0 && (used.empty() || used.back() != pair)) used.push_back(pair);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Pair> all;
  std::set_union(used.begin(), used.end(), state.pattern.begin(), state.pattern.end(),
                 std::back_inserter(all));
  const bool idle =
      static_cast<double>(all.size() - used.size()) > most_idle * static_cast<double>(used.size());
  state.pattern = idle ? std::move(used) : std::move(all);
  find_places();
  direct_.analysed = iterative_.analysed = false;
  products_.reset();
}

/// The solver that takes least, knowing the pattern. The choice depends on the state alone, so that a run that is resumed takes
/// the same.
linalg::BlockSolver& Stepper::solver(const State& state, bool is_static, bool must_be_direct) {
  // Block products of a factorization, for each block, that conjugate gradients are worth (docs/performance.md). Static steps have
  // little inertia, and need many more iterations.
  constexpr double dynamic_worth = 120.0, static_worth = 450.0;
  constexpr std::size_t never_factored = 30'000;  // blocks; not even the order of elimination is looked for
  const Profile::Scope scope(profile_, Phase::assembly);
  const LinearSolver wanted = model_.solver.linear;
  // Multipliers ask for more digits than conjugate gradients are stopped at.
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
