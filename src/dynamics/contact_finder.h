#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidates.h"
#include "contact/detection.h"
#include "core/parallel.h"
#include "dynamics/predicted_motion.h"
#include "model/model.h"
#include "model/state.h"
#include "solve/step_system.h"

namespace keyblock::dynamics {

/// Finds the contacts of a step: candidates from the region of each block, and of these the contacts.
class ContactFinder {
 public:
  ContactFinder(const Model& model, ThreadTeam& team);

  /// Which candidates are contacts in the step; describe() follows. Whether the candidates are others.
  bool find_which(const PredictedMotion& motion, bool is_static, State& state);
  /// Geometry and springs of the contacts that were found. then: what is done with some of them while a cache has them.
  void describe(const State& state, const contact::Detection::OfSome& then);
  /// Faces of joints among the contacts that are described.
  const contact::JointFaces& find_faces();
  /// Both, of blocks that stay where they are.
  void find_at_rest(PredictedMotion& motion, State& state);
  /// The contacts of a state, found anew, with candidates of their own. The state and what find_which() found are left alone.
  [[nodiscard]] std::vector<contact::Contact> find_anew(const PredictedMotion& motion, const State& state);

  /// Laws of joints from the next step on, as many as there were.
  void set_laws(const std::vector<contact::JointLaw>& laws) { detection_.set_laws(laws); }
  /// The next search looks at all blocks.
  void invalidate() { candidates_.invalidate(); }
  /// After blocks are gone: candidates of those that are there.
  void remove_absent(PredictedMotion& motion, State& state);

  [[nodiscard]] std::vector<contact::Contact>& contacts() { return contacts_; }
  [[nodiscard]] const std::vector<contact::Contact>& contacts() const { return contacts_; }
  [[nodiscard]] StepContacts of_step() { return {contacts_, version_}; }
  [[nodiscard]] const contact::Tolerances& tolerances() const { return tolerances_; }

 private:
  const Model& model_;
  ThreadTeam& team_;
  contact::Tolerances tolerances_;
  contact::Candidates candidates_;
  contact::Detection detection_;
  std::vector<contact::Contact> contacts_;
  contact::JointFaces faces_;
  std::uint64_t version_ = 1;  ///< StepContacts::version
};

}  // namespace keyblock::dynamics
