#pragma once
#include <span>
#include <vector>

#include "coupling/attempt.h"

namespace keyblock::dynamics {

/// Where the energy of blocks and loads went in a step, before blocks are moved: into the EnergyLedger. Couplings have accounts
/// of their own (Coupling::account).
class StepAccounts {
 public:
  /// spin: rad, per block.
  void account_for_blocks(const Attempt& attempt, std::span<const double> spin, State& state);

 private:
  /// J per thickness.
  struct BlockWork {
    double numerical = 0.0, input = 0.0;
  };
  static double inertia_loss(const Attempt& attempt, std::size_t body, double inertia);
  static BlockWork work_of(const Attempt& attempt, std::size_t block, double inertia);
  /// Enters what is known of time alone, and does its work by Integrator::end_share_of_work.
  static void account_for_loads(const Attempt& attempt, EnergyLedger& ledger);

  std::vector<BlockWork> work_;  ///< scratch: per block
};

/// The same of contacts and other couplings, and what these remember.
CouplingTotals account_for_couplings(const Attempt& attempt, std::span<const double> spin, State& state);

}  // namespace keyblock::dynamics
