#pragma once
#include <span>
#include <utility>
#include <vector>

namespace keyblock::linalg {

/// An order of elimination of a symmetric matrix of blocks.
struct EliminationOrder {
  std::vector<int> order;  ///< order[k] is the block eliminated as k-th
  double products = 0.0;   ///< block products of its factorization
};

/// Approximate minimum degree (Amestoy, Davis & Duff 1996) on the graph of n blocks. pairs: (i, j), i ≠ j, each unordered pair once.
EliminationOrder approximate_minimum_degree(int n, std::span<const std::pair<int, int>> pairs);

}  // namespace keyblock::linalg
