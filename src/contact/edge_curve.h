#pragma once
#include <cstddef>

#include "contact/surface.h"
#include "core/index.h"

namespace keyblock::contact {

/// Calls of_vertex(v, share) for the vertices along a divided edge, with their shares in what it is at a point of one of its pieces:
/// the polynomial through all of them (Lagrange), which is what a block of order n does along a straight edge of at least n pieces.
/// A chord is that at its ends alone: a block that is held or pressed between them would have to bend by other forces.
///
/// position: Contact::position, along the piece.
template <typename OfVertex>
void for_curve_vertices(const Surface& surface, int edge, double position, const OfVertex& of_vertex) {
  const DividedEdge& whole = surface.divided[at(edge)];
  const double* points = whole.points;
  const double from = points[edge - whole.first], to = points[edge - whole.first + 1],
               here = from + position * (to - from);
  for (int j = 0; j <= whole.pieces; ++j) {
    double share = 1.0;
    for (int i = 0; i <= whole.pieces; ++i) {
      if (i != j) share *= (here - points[i]) / (points[j] - points[i]);
    }
    const int last = whole.first + whole.pieces - 1;
    of_vertex(at(j < whole.pieces ? whole.first + j : surface.next[at(last)]), share);
  }
}

/// Whether an edge is one of several pieces, and so on a curve.
inline bool is_curved(const Surface& surface, int edge) {
  return !surface.divided.empty() && surface.divided[at(edge)].pieces > 1;
}

}  // namespace keyblock::contact
