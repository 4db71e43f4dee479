#pragma once
#include <span>

#include "contact/detection.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// Before the first step: contacts where a joint is in place hold as bonds, where its law has cohesion or tension, and carry the stress of
/// the rock, less the pressure of the water in them. Joints whose law has memory get their pieces. J per thickness, that the springs store.
double begin_contacts(const Model& model, const State& state, const contact::Tolerances& tolerances,
                      std::span<contact::Contact> contacts, contact::JointPieces& pieces);

}  // namespace keyblock::dynamics
