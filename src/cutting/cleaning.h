#pragma once
#include "cutting/cut.h"
#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// `local_size` (m), here and below: L of tolerances that are lower where the blocks around are small (local_size.h), 0 for
/// tolerances that are the same everywhere.

/// Merges every face of less than the sliver area or thickness into the neighbour with which it shares the
/// longest border, the smallest first, until none is left that has a neighbour to go to. Borders that lie on the
/// domain's edge or on an excavation outline are not removed. Counts into `statistics`.
void merge_slivers(PlanarGraph& graph, const CutTolerances& tolerances, CutStatistics& statistics);

/// Moves vertices onto others closer than `distance` (m) that lie at the same face, the closest pairs first. Of a pair
/// the one moves that sweeps the smaller area. A vertex on the domain's edge or on an outline moves only to a vertex on
/// the same ones, so that the domain keeps its shape. A move is made only if no vertex lies in the triangles that the
/// edges sweep and the way crosses no edge: then no face turns over and no edges cross. Every face at the vertex
/// changes alike, so neighbours stay conforming. Returns the number of vertices moved.
int cluster_vertices(PlanarGraph& graph, double distance, double local_size = 0.0);

/// Bends edges to vertices of their faces that lie within `distance` (m) of them, the nearest first: closes gaps and
/// tongues thinner than that. An edge of the domain stays where it is and the vertex moves. Only where the
/// triangles that are swept hold no other vertex.
void snap_vertices_to_edges(PlanarGraph& graph, double distance, double local_size = 0.0);

}  // namespace keyblock::cutting
