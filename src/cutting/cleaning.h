#pragma once
#include "cutting/cut.h"
#include "cutting/joint_strengths.h"
#include "cutting/planar_graph.h"

namespace keyblock::cutting {

/// `local_size` (m), here and below: L of tolerances that are lower where the blocks around are small (local_size.h), 0 for
/// tolerances that are the same everywhere.

/// Merges every face of less than the sliver area or thickness into a neighbour, the smallest first, until none is left that has a
/// neighbour to go to. What is between the two goes, and a joint that went on straight there has a tooth of rock in it
/// afterwards, which holds both of its walls. So of a face's borders, each with one neighbour, that goes
///
/// 1. which is as long as the face is large: area ≤ 10 length². Across a shorter one the neighbour would get a long tongue;
/// 2. whose weakest joint is the strongest: a weak plane stays whole;
/// 3. which no joint runs through (joint_course.h);
/// 4. which is the longest: a tooth is then the least high;
/// 5. of two that are the sides of a strip (area < length²/20), the upper one, so that strips end to end all go the same way.
///
/// The first of these that differs decides. Borders that lie on the domain's edge or on an excavation outline are not removed.
/// Counts into `statistics`. Returns the teeth, places in metres of the graph.
std::vector<JointTooth> merge_slivers(PlanarGraph& graph, const CutTolerances& tolerances,
                                      const JointStrengths& strengths, CutStatistics& statistics);

/// Moves vertices onto others closer than `distance` (m) that lie at the same face: pairs first of which one can go without bending
/// a weak joint, of these the closest. Of a pair the one moves that bends the stronger joints, where they are alike the one
/// that sweeps the smaller area. A vertex on the domain's edge or on an outline moves only to a vertex on the same ones, so
/// that the domain keeps its shape. A move is made only if no vertex lies in the triangles that the edges sweep and the way
/// crosses no edge: then no face turns over and no edges cross. Every face at the vertex changes alike, so neighbours stay
/// conforming. Returns the number of vertices moved.
/// Edges that become one have the label of the weaker joint, else that of higher rank (noding.h); below, too.
int cluster_vertices(PlanarGraph& graph, double distance, const JointStrengths& strengths = {},
                     double local_size = 0.0);

/// Bends edges to vertices of their faces that lie within `distance` (m) of them, the nearest first: closes gaps and
/// tongues thinner than that. An edge of the domain, or of a joint weaker than all at the vertex, stays where it is and the vertex
/// moves. Only where the triangles that are swept hold no other vertex.
void snap_vertices_to_edges(PlanarGraph& graph, double distance, const JointStrengths& strengths = {},
                            double local_size = 0.0);

}  // namespace keyblock::cutting
