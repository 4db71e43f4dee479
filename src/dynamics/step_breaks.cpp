#include "dynamics/step_breaks.h"

#include <algorithm>
#include <cstddef>

#include "contact/bonded_edge.h"
#include "contact/joint_law.h"
#include "core/index.h"
#include "coupling/step_problem.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

namespace {

contact::BreakMode mode_of(const contact::Contact& before, const contact::Memory& after) {
  using enum contact::BreakMode;
  if (before.broke != none) return before.broke;
  if (before.memory.bonded && !after.bonded) return before.cohesion > 0.0 ? opening : none;
  const bool is_worn_out =
      before.loss.is_any() && after.worn - before.memory.worn >= before.loss.slip && after.worn > 0.0;
  return is_worn_out ? shear : none;
}

/// m of the joint that broke: at a seam a bond has less than all of the contact.
double broken_length(const contact::Contact& contact, const contact::JointLaw& law) {
  if (law.has_memory()) return contact.length;
  const double bonded = law.cohesion > 0.0 ? contact.cohesion / law.cohesion : contact.tension / law.tension;
  return std::min(contact.length, bonded);
}

}  // namespace

void find_breaks(const Attempt& attempt, std::vector<JointBreak>& breaks) {
  const Model& model = attempt.model;
  // Not whether there are bonds in the step: those that broke in an earlier attempt at it are none any more.
  if (std::ranges::none_of(model.laws, &contact::JointLaw::may_break)) return;
  for (std::size_t c = 0; c < attempt.contacts.size(); ++c) {
    const contact::Contact& contact = attempt.contacts[c];
    const contact::BreakMode mode = mode_of(contact, attempt.state.contacts.memory[c]);
    if (mode == contact::BreakMode::none || contact.length == 0.0) continue;
    const int edge = contact::bonded_edge(model.surface, model.laws, contact);
    const contact::JointLaw& law =
        model.laws[at(model.surface.joint_of(edge, contact.block_a, contact.block_b))];
    breaks.push_back({contact.vertex, edge, contact.block_a, contact.block_b, mode,
                      model.surface.position[at(contact.vertex)], broken_length(contact, law)});
  }
}

}  // namespace keyblock::dynamics
