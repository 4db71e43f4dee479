#pragma once
#include "contact/competitor.h"

/// By which face a vertex has come into another block. A vertex behind one face of a sharp corner is behind the other face, too.
namespace keyblock::contact {

/// The edge nearest to a vertex, of the block of `edge`, except this edge and `except`. Edges beyond a reflex vertex do not count.
struct NearEdge {
  double distance;  ///< m; HUGE_VAL: there is none
  double gap;       ///< m, of the vertex from its line; positive: in front of it, outside the block
};
NearEdge nearest_other_edge(const CornerView& view, int vertex, int edge, int except = -1);
inline double distance_to_other_edges(const CornerView& view, int vertex, int edge, int except = -1) {
  return nearest_other_edge(view, vertex, edge, except).distance;
}

/// m, behind an edge, from which on it is asked where a vertex has come in. A tip that presses on the very end of a face is nearer to the
/// side below.
inline double entry_depth(const CornerView& view, const Competitor& c) {
  return c.disputed ? view.tolerances.end_zone : view.tolerances.corner_depth;
}

/// Whether the vertex has come in by this edge: it has been in contact with the edge since it was no deeper behind it than the end zone.
inline bool has_come_in_here(const CornerView& view, const Competitor& c) {
  return c.memory >= 0 && view.memory(c).offset <= view.tolerances.end_zone;
}

/// Whether the edge holds the vertex: the vertex is over the edge, presses on it, and has come in by it.
inline bool holds_vertex(const CornerView& view, const Competitor& c) {
  return has_come_in_here(view, c) && view.memory(c).normal_force > 0.0 && inside(view, c) >= 0.0;
}

/// Whether a vertex deep behind an edge is nearer to another edge, except `except`. Such a vertex has come in by one face of a sharp corner,
/// or has slid past a corner beside it. Not so where an edge of the vertex lies on the face, nor where the vertex has come in by this face,
/// however deep an impact presses it in.
bool has_come_in_elsewhere(const CornerView& view, const Competitor& c, int except = -1);

}  // namespace keyblock::contact
