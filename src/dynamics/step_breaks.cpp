#include "dynamics/step_breaks.h"

#include <cstddef>

#include "core/index.h"
#include "coupling/step_problem.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

namespace {

contact::BreakMode mode_of(const contact::Contact& before, const contact::Memory& after) {
  using enum contact::BreakMode;
  if (before.broke != none) return before.broke;
  if (before.memory.bonded && !after.bonded && (before.cohesion > 0.0 || before.tension > 0.0))
    return tension;  // it kept cohesion until it had opened
  const bool is_worn_out =
      before.loss.is_any() && after.worn - before.memory.worn >= before.loss.slip && after.worn > 0.0;
  return is_worn_out ? shear : none;
}

}  // namespace

void find_breaks(const Attempt& attempt, std::vector<JointBreak>& breaks) {
  const contact::CandidateList& list = attempt.state.contacts;
  if (!attempt.problem.facts().may_break && list.pieces.empty()) return;
  for (std::size_t c = 0; c < attempt.contacts.size(); ++c) {
    const contact::Contact& contact = attempt.contacts[c];
    const contact::BreakMode mode = mode_of(contact, list.memory[c]);
    if (mode == contact::BreakMode::none) continue;
    breaks.push_back({contact.vertex, contact.edge, contact.block_a, contact.block_b, mode,
                      attempt.model.surface.position[at(contact.vertex)], contact.length});
  }
}

}  // namespace keyblock::dynamics
