#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "contact/contact.h"
#include "contact/contact_description.h"
#include "contact/corners.h"
#include "contact/joint_law.h"
#include "contact/steady_pairs.h"
#include "contact/step_motion.h"
#include "core/parallel.h"

namespace keyblock::contact {

/// Turns the candidates of a step into its contacts.
///
/// | part | what it does |
/// |---|---|
/// | `Corners` | measures vertices and edges once |
/// | `find_competitors` | candidates that pass the geometry |
/// | `choose_contacts` | which of them are contacts: joints, other blocks, and where two corners meet |
/// | `SteadyPairs` | leaves out pairs of blocks that hardly moved: their contacts are the same |
/// | `ContactDescription` | geometry, length of joint and springs of each contact |
///
/// A competitor is a candidate with its vertex over the edge, or within a zone of the ends of the edge, and not deeper than the depth limit.
/// Both edges of the vertex lie outside the line of the edge, or may do so in the step by the turn of the blocks.
class Detection {
 public:
  /// penalty, laws: as ContactDescription.
  Detection(const Tolerances& tolerances, std::vector<JointLaw> laws, std::vector<double> penalty)
      : tolerances_(tolerances), description_(tolerances, std::move(laws), std::move(penalty)) {}
  /// Laws of joints from the next step on, as many as there were.
  void set_laws(std::vector<JointLaw> laws) { description_.set_laws(std::move(laws)); }
  /// As ContactDescription.
  void use_strengths(const ContactStrengths& strengths) { description_.use_strengths(strengths); }
  /// Has all pairs searched in each step: slower, and the same contacts.
  void leave_out_steady_pairs() { steady_pairs_.switch_off(); }

  /// Contacts of the step in the order of the candidates: find_which() and describe().
  void find(const Surface& surface, const StepMotion& motion, CandidateList& candidates, ThreadTeam& team,
            std::vector<Contact>& contacts);
  /// Which candidates are contacts. Returns their number.
  std::size_t find_which(const Surface& surface, const StepMotion& motion, CandidateList& candidates,
                         ThreadTeam& team);
  /// Faces of joints among contacts that are described; none where no joint has a stiffness of its own.
  void find_faces(const Surface& surface, std::span<Contact> contacts, JointFaces& faces) const {
    description_.find_faces(surface, contacts, faces);
  }
  /// Of contacts [first, last): what is done with them while a cache has them. Threads may do so at once.
  using OfSome = std::function<void(std::size_t first, std::size_t last)>;
  /// What find_which() found, into as many contacts. Returns whether these were contacts of the same vertices and edges before.
  bool describe(const Surface& surface, const CandidateList& candidates, ThreadTeam& team,
                std::span<Contact> contacts, const OfSome& then = {}) const;

 private:
  void find_in_pairs(const CornerView& view, std::span<BlockPair> pairs, std::size_t first, std::size_t last,
                     std::vector<FoundContact>& found) const;
  bool describe_piece(const Surface& surface, const CandidateList& candidates, std::size_t piece,
                      std::span<Contact> contacts, const OfSome& then) const;

  Tolerances tolerances_;
  ContactDescription description_;
  SteadyPairs steady_pairs_;
  Corners corners_;
  /// By piece of the pairs of blocks, in the order of the candidates, and the contact that each piece begins with.
  std::vector<std::vector<FoundContact>> found_;
  std::vector<std::size_t> first_found_;
};

}  // namespace keyblock::contact
