#pragma once
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "contact/detection.h"
#include "contact/law.h"
#include "core/lanes.h"
#include "coupling/coupling.h"
#include "model/drive.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

class StepProblem;

/// The contacts of joints, the first kind of coupling: a row per contact, with the springs of its joint law. Contacts are found anew in
/// every step; what they remember stands with their candidates (State::contacts).
class ContactCoupling final : public Coupling {
 public:
  /// Calls of_some(first, last) for all contacts, piece by piece, each when what build() reads of it is known; threads may do so at once.
  using ForContacts = std::function<void(const contact::Detection::OfSome& of_some)>;

  /// The faces of joints, found when all contacts are known.
  using FindFaces = std::function<const contact::JointFaces&()>;

  /// pairs: Row::pair of every candidate of contact. for_contacts: {} where all contacts are known. find_faces: {} where there are none.
  void begin_step(std::span<const contact::Contact> contacts, std::span<const int> pairs,
                  ForContacts for_contacts, FindFaces find_faces) {
    contacts_ = contacts;
    pairs_ = pairs;
    for_contacts_ = std::move(for_contacts);
    find_faces_ = std::move(find_faces);
  }

  void add_pairs(BlockPairs& pairs) const override;
  [[nodiscard]] std::size_t rows() const override { return contacts_.size(); }
  [[nodiscard]] std::pair<int, int> key(std::size_t row) const override {
    return {contacts_[row].vertex, contacts_[row].edge};
  }
  RowFacts build(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 CouplingRows out) const override;
  /// Memory of contacts too, in State::contacts.
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;

 private:
  RowFacts build_row(const Drive& drive, std::size_t c, const CouplingRows& out) const;
  void build_faces(const Model& model, const State& state, const Drive& drive, const CouplingRows& out) const;
  [[nodiscard]] std::vector<double> dashpots_of_faces(const Model& model, const Drive& drive,
                                                      const Points& points) const;
  void set_row_of_face(std::size_t c, double stiffness, double dashpot, bool shifts, const Drive& drive,
                       const CouplingRows& out) const;

  std::span<const contact::Contact> contacts_;
  std::span<const int> pairs_;
  ForContacts for_contacts_;
  FindFaces find_faces_;
};

/// kg/m, of the two blocks of a contact; fixed ones count as infinite.
[[nodiscard]] double reduced_mass(const Points& points, const contact::Contact& c);
/// N/m per thickness, inertia of the two blocks of a contact against each other in a step.
[[nodiscard]] double inertia_between(const StepProblem& problem, const contact::Contact& c);

}  // namespace keyblock::dynamics
