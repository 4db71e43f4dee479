#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "contact/candidates.h"
#include "contact/corners.h"
#include "contact/tolerances.h"

namespace keyblock::contact {

/// A candidate that is a contact of this step.
struct FoundContact {
  int candidate;
  int memory;      ///< of the list, that it continues; −1: none
  bool at_corner;  ///< it stands for two corners that meet
};

/// Geometry of as many contacts as there are lanes.
struct ContactGeometry {
  Lanes gap, position, length;  ///< as of Contact
  /// m, of joint that gives the contact its stiffness at the least: Tolerances::least_length, but no more than belongs to the vertex
  /// where the edges that face each other share all that they have.
  Lanes least_length;
  /// m of the length that belongs to it beyond the end of its edge, where two corners meet, and the edge that begins or ends there.
  Lanes length_beyond;
  std::array<std::size_t, lane_count> beyond;
};

/// Of up to lane_count contacts; lanes beyond the last are those of the first (docs/decisions/0008-contacts.md). memories: of the list.
ContactGeometry measure_contacts(const Surface& surface, const Tolerances& tolerances, const Corners& corners,
                                 std::span<const Candidate> candidates, std::span<const FoundContact> found,
                                 std::span<const Memory> memories);

}  // namespace keyblock::contact
