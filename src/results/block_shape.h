#pragma once
#include <array>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "record/record.h"

namespace keyblock::results {

/// A block as it lies in a frame, in real coordinates.
Polygon block_shape(const record::ModelRecord& model, const record::Frame& frame, std::size_t block);
/// The same before anything moved.
Polygon block_shape(const record::ModelRecord& model, std::size_t block);

/// Displacement of a block's centroid, m.
Vec2 block_displacement(const record::ModelRecord& model, const record::Frame& frame, std::size_t block);

/// Display vertices (indices into ModelRecord::vertices) of triangles that cover a block in reference position.
std::vector<std::array<int, 3>> block_triangles(const record::ModelRecord& model, std::size_t block);

/// Names as in the user guide.
std::string status_name(record::BlockStatus status);
std::string contact_state_name(record::ContactState state);
std::string edge_kind_name(cutting::EdgeKind kind);

}  // namespace keyblock::results
