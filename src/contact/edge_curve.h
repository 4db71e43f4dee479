#pragma once
#include <cstddef>
#include <type_traits>
#include <vector>

#include "contact/surface.h"
#include "core/index.h"

namespace keyblock::contact {

/// Where edges of m pieces are divided, in the reference position: m + 1 points from 0 to 1, ascending.
struct EdgeDivision {
  std::vector<double> points;
  std::vector<double> scales;  ///< of Lagrange's polynomials through them: 1 / Π (p_j − p_i)
  /// By rows: from the values of a polynomial at the points to its coefficients on Bernstein's polynomials of the same degree.
  std::vector<double> bernstein;
  explicit EdgeDivision(std::vector<double> ascending);
};

/// Calls of_vertex(v, share) for the vertices along a divided edge. The point of the curve is the sum of the vertices times their shares: the
/// polynomial through all of them (Lagrange). A block of order n takes this shape along a straight edge of at least n pieces. A chord has
/// this shape at its ends only: a block that is held or pressed between them would have to bend by other forces.
///
/// position: Contact::position, along the piece.
template <typename OfVertex>
void for_curve_vertices(const Surface& surface, int edge, double position, const OfVertex& of_vertex) {
  const DividedEdge& whole = surface.divided[at(edge)];
  const double *points = whole.division->points.data(), *scales = whole.division->scales.data();
  const double from = points[edge - whole.first], to = points[edge - whole.first + 1],
               here = from + position * (to - from);
  const auto for_pieces = [&](auto pieces) {
    for (int j = 0; j <= pieces; ++j) {
      double share = scales[j];
      for (int i = 0; i <= pieces; ++i) {
        if (i != j) share *= here - points[i];
      }
      of_vertex(at(j < pieces ? whole.first + j : surface.next[at(whole.first + pieces - 1)]), share);
    }
  };
  if (whole.pieces == 2) return for_pieces(std::integral_constant<int, 2>{});  // of order 2: unrolled
  for_pieces(whole.pieces);
}

/// Whether an edge is one of several pieces, and so on a curve.
inline bool is_curved(const Surface& surface, int edge) {
  return !surface.divided.empty() && surface.divided[at(edge)].pieces > 1;
}

}  // namespace keyblock::contact
