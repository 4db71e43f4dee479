#pragma once
#include <span>
#include <vector>

#include "contact/contact_lanes.h"
#include "contact/law.h"
#include "dynamics/attempt.h"

namespace keyblock::dynamics {

/// What a step does to all contacts together.
struct ContactTotals {
  double penetration = 0.0;  ///< m, largest depth
  int closed = 0;            ///< at the end
};

/// Takes over what a step did to contacts and energies, before blocks are moved: what contacts remember for the next step, and where the
/// energy of the step went (EnergyLedger).
class StepAccounts {
 public:
  /// Energy of blocks, loads and supports. spin: rad, per block.
  void account_for_blocks(const Attempt& attempt, std::span<const double> spin, StepProblem& problem,
                          State& state);
  /// Memory and energy of contacts.
  ContactTotals remember_contacts(const Attempt& attempt, State& state);

 private:
  /// Where the energy of as many contacts as there are lanes went in the step, and how deep they are.
  struct ContactAccounts {
    contact::SpringLanes::Balance balance;
    Lanes stored_before{};  ///< J per thickness, at the start
    Lanes input{};          ///< J per thickness, by what fixed blocks are moved
    Lanes rotation{};       ///< J per thickness, of the forces over Drive::rotation: no block gets it
    Lanes penetration{};    ///< m
    Lanes closed{};         ///< at the end: 1, else 0
    void add(const ContactAccounts& other);
    /// Zero where a lane is none of the first `count`.
    void leave_out_beyond(std::size_t count);
    void enter(EnergyLedger& ledger) const;
  };
  /// J per thickness.
  struct BlockWork {
    double numerical = 0.0, input = 0.0;
  };
  static ContactAccounts remember_some(const Attempt& attempt, std::size_t first, std::size_t count,
                                       std::span<contact::Memory> remembered);
  static void remember_multiplier(const Attempt& attempt, std::size_t c, std::size_t lane,
                                  contact::Memory& memory, ContactAccounts& accounts);
  static ContactAccounts remember_piece(const Attempt& attempt, std::size_t first, std::size_t last,
                                        contact::CandidateList& list);
  static BlockWork work_of(const Attempt& attempt, std::size_t block, double inertia);
  static void account_for_supports(const Attempt& attempt, State& state);

  std::vector<ContactAccounts> pieces_;  ///< scratch: of pieces of the contacts
  std::vector<BlockWork> work_;          ///< scratch: per block
};

}  // namespace keyblock::dynamics
