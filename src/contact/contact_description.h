#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "contact/contact.h"
#include "contact/contact_geometry.h"
#include "contact/contact_strengths.h"
#include "contact/joint_faces.h"
#include "contact/joint_law.h"

namespace keyblock::contact {

/// What is known of a contact once it is one: geometry, length of joint, springs by the law of its joint, and what it remembers.
class ContactDescription {
 public:
  /// penalty[b]: Pa/m, normal stiffness of joints of block b that give none; the softer of two blocks counts. laws[k]: by
  /// Surface::joint.
  ContactDescription(const Tolerances& tolerances, std::vector<JointLaw> laws, std::vector<double> penalty)
      : tolerances_(tolerances), penalty_(std::move(penalty)) {
    set_laws(std::move(laws));
  }
  void set_laws(std::vector<JointLaw> laws) {
    laws_ = std::move(laws);
    has_memory_ = std::ranges::any_of(laws_, &JointLaw::has_memory);
  }
  /// Strengths of single contacts, which have to outlive this; what is in them at the time counts.
  void use_strengths(const ContactStrengths& strengths) { strengths_ = &strengths; }
  /// The faces of joints that the contacts of a step share, after they have been described.
  void find_faces(const Surface& surface, std::span<Contact> contacts, JointFaces& faces) const {
    if (JointFaces::are_there(laws_)) faces.find(surface, tolerances_, laws_, penalty_, contacts);
  }

  /// Of up to lane_count contacts. Whether all of them had the same vertices and edges before.
  bool describe(const Surface& surface, const Corners& corners, const CandidateList& candidates,
                std::span<const FoundContact> found, std::span<Contact> contacts) const;

 private:
  /// Of the edge beyond a corner.
  struct Beyond {
    double share;  ///< of the length that belongs to the contact at the corner
    int joint;     ///< Surface::joint
  };
  /// What the springs of a contact have of its joint.
  struct SpringLaw {
    double per_length;  ///< Pa/m, normal stiffness
    double stiffness_ratio;
    Strength strength;
    StrengthLoss loss;  ///< cohesion in Pa
    bool fused, is_ductile;
  };
  static void find_piece(const Surface& surface, const CandidateList& candidates, const FoundContact& found,
                         Contact& contact);
  void find_law(const Surface& surface, const Contact& contact, const Beyond& beyond,
                SpringLaw& of_contact) const;
  static void put_strength(const ContactStrength& strength, const Contact& contact, SpringLaw& of_contact);

  Tolerances tolerances_;
  std::vector<JointLaw> laws_;
  bool has_memory_ = false;  ///< some of them
  std::vector<double> penalty_;
  const ContactStrengths* strengths_ = nullptr;  ///< null: of no contact
};

}  // namespace keyblock::contact
