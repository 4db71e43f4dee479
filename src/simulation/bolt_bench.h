#pragma once
#include <vector>

#include "loading/bolt.h"

/// A bolt on the bench: what it takes to pull a joint open that it crosses, and to shear it.
namespace keyblock::simulation {

/// A joint across a bolt, between two rigid blocks. The block at the head is moved, the other one is held.
struct BoltBench {
  double at = 0.0;        ///< m from the head, where the joint is
  double way = 0.0;       ///< m, as far as the block is moved: away from the other one, or along the joint
  bool is_shear = false;  ///< along the joint, which neither opens nor closes, and has no friction
  int steps = 200;
};

/// Force over displacement, as a run has them: a point for each step, the first at 0.
struct BoltCurve {
  std::vector<double> displacement;  ///< m
  std::vector<double> force;         ///< N of one bolt, along the way; what moves the block

  [[nodiscard]] double largest() const;
  /// N, at a displacement, m, between two points; beyond the last it is that of the last.
  [[nodiscard]] double force_at(double displacement) const;
};

/// Bolts have no pretension on the bench. Throws InputError where the joint is not across the bolt.
BoltCurve test_bolt(const loading::Bolt& bolt, const BoltBench& bench);

}  // namespace keyblock::simulation
