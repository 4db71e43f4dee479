#include "dynamics/contact_finder.h"

namespace keyblock::dynamics {

namespace {

/// Pa/m, per block: of joints that give no stiffness.
std::vector<double> penalties(const Model& model) {
  std::vector<double> stiffness;
  for (const Block& block : model.blocks) stiffness.push_back(model.solver.penalty * block.material.young);
  return stiffness;
}

}  // namespace

ContactFinder::ContactFinder(const Model& model, ThreadTeam& team)
    : model_(model),
      team_(team),
      tolerances_(model.block_size),
      candidates_(tolerances_),
      detection_(tolerances_, model.laws, penalties(model)) {
  detection_.use_strengths(model_.contact_strengths);
  if (!model.solver.accelerators.steady_pairs) detection_.leave_out_steady_pairs();
}

bool ContactFinder::find_which(const PredictedMotion& motion, bool is_static, State& state) {
  const bool changed = candidates_.update(model_.surface, motion.reach(), state.contacts, team_);
  const std::size_t before = contacts_.size();
  contacts_.resize(detection_.find_which(model_.surface, motion.for_detection(candidates_.away(), is_static),
                                         state.contacts, team_));
  if (contacts_.size() != before) ++version_;
  return changed;
}

void ContactFinder::describe(const State& state, const contact::Detection::OfSome& then) {
  if (!detection_.describe(model_.surface, state.contacts, team_, contacts_, then)) ++version_;
}

const contact::JointFaces& ContactFinder::find_faces() {
  detection_.find_faces(model_.surface, contacts_, faces_);
  return faces_;
}

void ContactFinder::find_at_rest(PredictedMotion& motion, State& state) {
  motion.stay();
  candidates_.update(model_.surface, motion.reach(), state.contacts, team_);
  detection_.find(model_.surface, motion.for_detection(candidates_.away(), true), state.contacts, team_,
                  contacts_);
  ++version_;
}

std::vector<contact::Contact> ContactFinder::find_anew(const PredictedMotion& motion, const State& state) {
  contact::Candidates candidates(tolerances_);
  PredictedMotion still = motion;
  still.stay();
  contact::CandidateList list = state.contacts;
  candidates.update(model_.surface, still.reach(), list, team_);
  std::vector<contact::Contact> contacts;
  detection_.find(model_.surface, still.for_detection(candidates.away(), true), list, team_, contacts);
  return contacts;
}

void ContactFinder::remove_absent(PredictedMotion& motion, State& state) {
  candidates_.invalidate();
  motion.stay();
  candidates_.update(model_.surface, motion.reach(), state.contacts, team_);
}

}  // namespace keyblock::dynamics
