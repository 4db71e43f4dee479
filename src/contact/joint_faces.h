#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/contact.h"
#include "contact/joint_law.h"
#include "contact/joint_pressure.h"
#include "contact/surface.h"
#include "contact/tolerances.h"

namespace keyblock::contact {

/// A stretch of joint between two edges that face each other, with the contacts at its ends, or along it, that share its pressure.
struct JointFace {
  std::size_t first;  ///< of its contacts in JointFaces::contacts_of; as many as the pressure has points
  JointPressure pressure;
};

/// The faces of joints whose stiffness is given. Without these, two contacts at the ends of a face are point springs: three times too stiff
/// against rotation. Where no stiffness is given, or one as large as that which is taken then, springs only keep blocks apart, and each contact
/// has its own.
class JointFaces {
 public:
  /// Whether a joint has a stiffness of its own, so that there may be faces.
  [[nodiscard]] static bool are_there(std::span<const JointLaw> laws);

  /// Pairs contacts, in the order of the candidates. Memory::in_face is set. penalty: as ContactDescription.
  void find(const Surface& surface, const Tolerances& tolerances, std::span<const JointLaw> laws,
            std::span<const double> penalty, std::span<Contact> contacts);
  void clear() {
    faces_.clear();
    contacts_.clear();
    left_.clear();
  }

  [[nodiscard]] bool empty() const { return faces_.empty(); }
  [[nodiscard]] std::span<const JointFace> all() const { return faces_; }
  [[nodiscard]] std::span<const std::size_t> contacts_of(const JointFace& face) const {
    return std::span(contacts_).subspan(face.first, face.pressure.size());
  }
  /// N/m per thickness, per contact: normal stiffness that no face has.
  [[nodiscard]] std::span<const double> left() const { return left_; }

 private:
  /// What a contact has of two edges that face each other: half of what they share, at one end of it.
  struct Half {
    int low = 0, high = 0;  ///< the two edges
    std::size_t contact = 0;
    double along = 0.0;   ///< m², of the contact along the edge `low`, times the length of that; to compare
    double shared = 0.0;  ///< m, that both edges have in common
    double stiffness = 0.0;  ///< Pa/m
    int whole = -1,
        beside =
            0;  ///< the first piece of a divided edge that lies against this edge with all of its pieces; −1: none does
    bool is_taken = false;  ///< by a face
  };
  struct View {
    const Surface& surface;
    const Tolerances& tolerances;
    std::span<const JointLaw> laws;
    std::span<const double> penalty;
    std::span<Contact> contacts;
  };
  void find_halves(const View& view, std::size_t c);
  void add_half(const View& view, std::size_t c, int line, int side);
  void take_divided(const View& view);
  static void find_whole(const View& view, Half& half);
  void take_whole(const View& view, std::span<Half> halves);
  void take_pairs(const View& view);
  void add_face(const View& view, double stiffness, const EdgeDivision& points,
                std::span<const std::size_t> contacts);
  void find_left(const View& view);

  std::vector<JointFace> faces_;
  std::vector<std::size_t> contacts_;
  std::vector<double> left_;
  std::vector<Half> halves_;             ///< of two blocks; scratch
  std::vector<double> shared_, paired_;  ///< m, per contact: in all, and in faces; scratch
  std::vector<double> stiffness_;        ///< Pa, per contact: of what is shared; scratch
};

}  // namespace keyblock::contact
