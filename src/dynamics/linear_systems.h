#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contact/detection.h"
#include "core/parallel.h"
#include "linalg/block_solver.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// The linear systems of a step: which pairs of blocks they couple (State::pattern), and which solver takes least time.
class LinearSystems {
 public:
  LinearSystems(const Model& model, ThreadTeam& team);

  /// Where the pair of blocks of every candidate is in the pattern. Both are in order.
  void find_pairs(const Model& model, const State& state);
  /// Room in the matrix for every pair of blocks that has contacts or another coupling. Pairs that have contacts no more keep their room until they are many.
  void make_room(const Model& model, const Coupling& contacts, State& state);
  /// After the pattern or the candidates have changed in another way.
  void forget();

  /// A solver that knows the pattern, and whether it has just come to know it: it has no factor then.
  struct Chosen {
    linalg::BlockSolver& solver;
    bool is_new;
  };
  /// The choice depends on the state only, so that a run that is resumed takes the same.
  Chosen choose(const Model& model, const State& state, bool is_static, bool must_be_direct);

  [[nodiscard]] bool knows_pairs() const { return knows_pairs_; }
  /// Row::pair of every candidate.
  [[nodiscard]] std::span<const int> pairs() const { return pair_of_candidate_; }

 private:
  /// A solver, and whether it knows the pattern.
  struct Linear {
    std::unique_ptr<linalg::BlockSolver> solver;
    bool analysed = false;
  };
  [[nodiscard]] bool prefers_iterations(const State& state, bool is_static);

  Linear direct_, iterative_;
  std::optional<double> products_;  ///< block products of a factorization with the pattern; empty: not known
  std::vector<int> unknown_sizes_;  ///< coefficients of each block that is not fixed
  std::vector<int> pair_of_candidate_;
  bool knows_pairs_ = false;  ///< of these candidates and this pattern
};

}  // namespace keyblock::dynamics
