#pragma once
#include <span>

#include "contact/candidate_list.h"
#include "contact/surface.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

/// Where a vertex of one block is that another block is concerned with.
struct VertexPlace {
  double distance = 0.0;  ///< m, from the outline of the other block; 0: there is no such vertex
  int block_a = -1;       ///< the block with the vertex
  int block_b = -1;       ///< the other block
  Vec2 where;
};

/// What true geometry says of the contacts of a step, once blocks are where they come to be. It knows none of the rules of contact: of a
/// contact that presses it asks only where its vertex is.
struct ContactAudit {
  /// Contacts whose vertex presses on nothing: it is farther outside the other block than the sum of the end zone, how far both blocks may go in
  /// the step, how far the vertex went in it and what in-situ stress has closed the joint by. A vertex that lies in a third block, a wall that stands on the edge, is nearer by its
  /// depth there.
  long across_gaps = 0;
  VertexPlace farthest;  ///< of these
  VertexPlace deepest;   ///< of all vertices that press: how far inside the other block
  /// Of these, by what no closure of the joint explains: the part that is not in the spring (contact::Memory::offset).
  VertexPlace unexplained;

  void add(const ContactAudit& other);
};

/// A step that was taken, and where its blocks are now.
struct TakenStep {
  const contact::Surface& surface;
  const contact::CandidateList& contacts;  ///< what they remember of the step
  std::span<const double> reach;           ///< m, per block: how far it may go in the step
  std::span<const Vec2> relative;  ///< m, r of each contact: how far its vertex went against the other block
  double end_zone;                 ///< m, contact::Tolerances
};
ContactAudit audit_contacts(const TakenStep& step);

}  // namespace keyblock::dynamics
