#include "dynamics/linear_systems.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/index.h"
#include "coupling/coupling.h"
#include "linalg/minimum_degree.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

using Unknowns = std::pair<int, int>;  // Body::unknown of two bodies, the smaller first

Unknowns unknowns_of(const Model& model, int a, int b) {
  return std::minmax(model.body(at(a)).unknown, model.body(at(b)).unknown);
}

std::unique_ptr<linalg::BlockSolver> make_direct_solver(const SolverOptions& options) {
  if (options.linear == LinearSolver::direct) return linalg::make_direct();
  return linalg::make_block_cholesky(options.accelerators.single_precision ? linalg::Precision::automatic
                                                                           : linalg::Precision::full);
}

}  // namespace

LinearSystems::LinearSystems(const Model& model, ThreadTeam& team)
    : direct_{make_direct_solver(model.solver)}, iterative_{linalg::make_block_conjugate_residual(&team)} {
  for (std::size_t b = 0; b < model.bodies(); ++b) {
    if (model.body(b).unknown >= 0) unknown_sizes_.push_back(2 * model.body(b).size);
  }
}

void LinearSystems::find_pairs(const Model& model, const State& state) {
  const std::vector<contact::Candidate>& list = state.contacts.pairs;
  pair_of_candidate_.resize(list.size());
  auto next = state.pattern.begin();
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Unknowns pair = unknowns_of(model, list[k].block_a, list[k].block_b);
    if (pair.first < 0) {
      pair_of_candidate_[k] = Row::of_fixed;
      continue;
    }
    while (next != state.pattern.end() && *next < pair) ++next;
    pair_of_candidate_[k] = next != state.pattern.end() && *next == pair
                                ? static_cast<int>(next - state.pattern.begin())
                                : Row::without_room;
  }
  knows_pairs_ = true;
}

void LinearSystems::make_room(const Model& model, const Coupling& contacts, State& state) {
  Coupling::BlockPairs coupled;
  contacts.add_pairs(coupled);
  for (const auto& coupling : model.couplings) coupling->add_pairs(coupled);
  std::vector<Unknowns> used;
  for (const auto& [a, b] : coupled) {
    const Unknowns pair = unknowns_of(model, a, b);
    if (pair.first >= 0) used.push_back(pair);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Unknowns> all;
  std::set_union(used.begin(), used.end(), state.pattern.begin(), state.pattern.end(),
                 std::back_inserter(all));
  // Pairs that were used stay in the pattern, so that a contact which comes and goes does not cost an analysis each time.
  const bool is_idle = static_cast<double>(all.size() - used.size()) >
                       step_numbers::most_idle_share * static_cast<double>(used.size());
  state.pattern = is_idle ? std::move(used) : std::move(all);
  forget();
  find_pairs(model, state);
}

void LinearSystems::forget() {
  knows_pairs_ = direct_.analysed = iterative_.analysed = false;
  products_.reset();
}

/// Whether conjugate residuals take less than a factorization. Static steps have little inertia, and need many more iterations.
bool LinearSystems::prefers_iterations(const State& state, bool is_static) {
  using namespace step_numbers;
  // A factorization costs the products of its fill-in, an iteration those of the blocks: what decides is their ratio.
  const std::size_t blocks = unknown_sizes_.size();
  if (!products_) {
    products_ = blocks > most_factored
                    ? HUGE_VAL
                    : linalg::approximate_minimum_degree(static_cast<int>(blocks), state.pattern).products;
  }
  const double worth = is_static ? static_iterations_worth : dynamic_iterations_worth;
  return *products_ > worth * static_cast<double>(blocks);
}

LinearSystems::Chosen LinearSystems::choose(const Model& model, const State& state, bool is_static,
                                            bool must_be_direct) {
  const LinearSolver wanted = model.solver.linear;
  const bool iterates =
      !must_be_direct && (wanted == LinearSolver::iterative ||
                          (wanted == LinearSolver::automatic && prefers_iterations(state, is_static)));
  Linear& linear = iterates ? iterative_ : direct_;
  const bool is_new = !linear.analysed;
  if (is_new) linear.solver->analyse(unknown_sizes_, state.pattern);
  linear.analysed = true;
  return {*linear.solver, is_new};
}

}  // namespace keyblock::dynamics
