#pragma once
#include <span>

#include "contact/detection.h"
#include "model/model.h"

namespace keyblock::dynamics {

/// Before the first step: contacts where a joint is in place hold as bonds, where its law has cohesion or tension, and carry the stress of
/// the rock. Joints whose law has memory get their pieces. J per thickness, that the springs store.
double begin_contacts(const Model& model, const contact::Tolerances& tolerances,
                      std::span<contact::Contact> contacts, contact::JointPieces& pieces);

}  // namespace keyblock::dynamics
