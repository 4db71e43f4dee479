#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/joint_pieces.h"
#include "results/run_data.h"
#include "results/vtk_file.h"

/// The files of one moment that export_vtk writes. Points are in local coordinates: ParaView draws in single precision, and
/// in coordinates of millions of metres blocks would lose their shape. The field data `origin` has what is to be added.
namespace keyblock::results {

/// Draws blocks as cells. VTK draws a polygon as a fan of triangles from its first vertex, which is right for convex ones only:
/// others are triangles.
class VtkBlocks {
 public:
  explicit VtkBlocks(const record::ModelRecord& model) : model_(model), triangles_(model.blocks.size()) {}

  /// Blocks that are there, as polygons or triangles.
  std::string cells(const record::Frame& frame);
  /// Their outlines: a line for each stretch that is a piece of the same joint.
  [[nodiscard]] std::string outlines(const record::Frame& frame) const;
  /// A point at the centroid of each, for arrows and crosses.
  [[nodiscard]] std::string centres(const record::Frame& frame) const;

 private:
  using Triangles = std::vector<std::array<int, 3>>;
  const Triangles& triangles_of(std::size_t block);
  [[nodiscard]] bool is_drawn(const record::Frame& frame, std::size_t block) const;
  void add_block_data(VtkFile& file, const record::Frame& frame, const std::vector<int>& blocks) const;
  void add_vertices(VtkFile& file, const record::Frame& frame) const;

  const record::ModelRecord& model_;
  std::vector<std::optional<Triangles>> triangles_;  ///< by block; of those that were asked for
};

template <class T>
std::span<const T> view(const std::vector<T>& values) {
  return values;
}

/// The stretch of joint of each contact.
std::string vtk_contact_lines(const RunData& data, const JointLocator& locator,
                              const record::ContactFrame& frame);
/// A point at each contact that carries force, for arrows.
std::string vtk_contact_forces(const record::ModelRecord& model, const record::ContactFrame& frame);

/// A line for each element that is there.
std::string vtk_elements(const record::ModelRecord& model, const record::Frame& frame);

/// Field data of a file: time, stage, step, and the local origin.
void add_vtk_moment(VtkFile& file, const record::ModelRecord& model, double time, int stage, long step);

/// Lines of a piece, each by its points one after the other. end: of each line, into vertices.
void add_vtk_lines(VtkFile& file, std::span<const std::int64_t> vertices, std::span<const std::int64_t> end);

/// A script in Python that opens the whole in ParaView.
std::string vtk_view(const RunData& data);

}  // namespace keyblock::results
