#pragma once
#include <span>
#include <vector>

#include "model/model.h"

namespace keyblock::simulation {

/// Gives the model its surface: the outlines of its blocks, of which the coefficients are numbered, divided where blocks of order > 1 may
/// bend. joint[k]: Surface::joint of the edges of the polygons, block by block and ring by ring.
///
/// An edge of such a block is cut where the blocks on its other side begin and end, so that what two blocks have in common is a part of both:
/// traction along a joint does the same work on either then (docs/decisions/0008-contacts.md). A part is divided at the points of
/// Gauss and Lobatto's rule, alike on both sides, as the higher of the two orders asks for.
void build_surface(dynamics::Model& model, std::span<const int> joint);

/// Basis functions at the vertices of the surface, after blocks have got others.
void evaluate_basis(dynamics::Model& model);

/// Surface::is_seam: where the laws of both edges differ, that of an outline not yet opened aside.
void find_seams(dynamics::Model& model);

/// Number of pieces into which contact divides an edge of a block, so that its curvature is followed.
int edge_pieces(double edge_length, double block_area, int order);

}  // namespace keyblock::simulation
