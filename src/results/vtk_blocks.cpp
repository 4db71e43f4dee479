#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "results/block_shape.h"
#include "results/vtk_parts.h"

namespace keyblock::results {
namespace {

constexpr std::uint8_t vtk_triangle = 5, vtk_polygon = 7;

Vec2 place(const record::ModelRecord& model, const record::Frame& frame, std::size_t vertex) {
  const auto [ux, uy] = frame.displacement[vertex];
  return model.vertices[vertex] + Vec2{ux, uy};
}

/// Whether no vertex turns inwards by more than rounding makes it.
bool is_convex(const record::ModelRecord& model, const record::Frame& frame, std::size_t block) {
  constexpr double rounding = 1e-6;
  const std::vector<int>& start = model.blocks[block].ring_start;
  if (start.size() != 2) return false;
  const int first = start[0], count = start[1] - start[0];
  const auto at = [&](int k) { return place(model, frame, static_cast<std::size_t>(first + k % count)); };
  for (int k = 0; k < count; ++k) {
    const Vec2 in = at(k + 1) - at(k), out = at(k + 2) - at(k + 1);
    if (cross(in, out) < -rounding * norm(in) * norm(out)) return false;
  }
  return true;
}

struct Principal {
  double larger, smaller;  ///< Pa
  Vec2 direction;          ///< unit, of the larger
};

Principal principal(const std::array<float, 3>& s) {
  const double mean = 0.5 * (s[0] + s[1]), difference = 0.5 * (s[0] - s[1]), shear = s[2];
  const double radius = std::hypot(difference, shear), angle = 0.5 * std::atan2(shear, difference);
  return {mean + radius, mean - radius, {std::cos(angle), std::sin(angle)}};
}

void add_vector(std::vector<float>& values, Vec2 v) {
  values.insert(values.end(), {static_cast<float>(v.x), static_cast<float>(v.y), 0.0F});
}

/// The first edges of stretches of one label and trace, in a ring of so many display vertices from `first` on; at least one.
std::vector<int> stretches(const record::ModelRecord& model, int first, int count) {
  const auto label = [&](int k) {
    return model.edge_label[static_cast<std::size_t>(first + (k + count) % count)];
  };
  std::vector<int> begins;
  for (int k = 0; k < count; ++k) {
    if (!(label(k) == label(k - 1)) || label(k).trace != label(k - 1).trace) begins.push_back(k);
  }
  if (begins.empty()) begins.push_back(0);
  return begins;
}

}  // namespace

const VtkBlocks::Triangles& VtkBlocks::triangles_of(std::size_t block) {
  if (!triangles_[block]) triangles_[block] = block_triangles(model_, block);
  return *triangles_[block];
}

bool VtkBlocks::is_drawn(const record::Frame& frame, std::size_t block) const {
  return frame.status[block] != record::BlockStatus::excavated;
}

void VtkBlocks::add_block_data(VtkFile& file, const record::Frame& frame,
                               const std::vector<int>& blocks) const {
  std::vector<std::int32_t> order, excavation;
  std::vector<std::uint8_t> status;
  std::vector<float> stress, larger_vector, smaller_vector, velocity;
  std::vector<double> magnitude, larger, smaller;
  for (const int b : blocks) {
    const auto k = static_cast<std::size_t>(b);
    const auto& record = model_.blocks[k];
    order.push_back(frame.order[k]);
    excavation.push_back(record.excavations.empty() ? -1 : record.excavations.front());
    status.push_back(static_cast<std::uint8_t>(frame.status[k]));
    const auto& s = frame.stress[k];
    const auto zz = static_cast<float>(record.stress_ratio_zz * (s[0] + s[1]));
    stress.insert(stress.end(), {s[0], s[1], zz, s[2], 0.0F, 0.0F});
    const Principal p = principal(s);
    larger.push_back(p.larger);
    smaller.push_back(p.smaller);
    add_vector(larger_vector, p.larger * p.direction);
    add_vector(smaller_vector, p.smaller * perpendicular(p.direction));
    magnitude.push_back(norm(block_displacement(model_, frame, k)));
    if (!frame.velocity.empty()) add_vector(velocity, {frame.velocity[k][0], frame.velocity[k][1]});
  }
  file.array("block", view(blocks));
  file.array("status", view(status));
  file.array("stress", view(stress), 6, {"XX", "YY", "ZZ", "XY", "YZ", "XZ"});
  file.array("principal_1", view(larger));
  file.array("principal_2", view(smaller));
  file.array("principal_1_vector", view(larger_vector), 3);
  file.array("principal_2_vector", view(smaller_vector), 3);
  file.array("displacement_magnitude", view(magnitude));
  if (!frame.velocity.empty()) file.array("velocity", view(velocity), 3);
  file.array("order", view(order));
  file.array("excavation", view(excavation));
}

void VtkBlocks::add_vertices(VtkFile& file, const record::Frame& frame) const {
  std::vector<double> points;
  std::vector<float> displacement;
  for (std::size_t k = 0; k < model_.vertices.size(); ++k) {
    const auto [ux, uy] = frame.displacement[k];
    const Vec2 p = place(model_, frame, k);
    points.insert(points.end(), {p.x, p.y, 0.0});
    displacement.insert(displacement.end(), {ux, uy, 0.0F});
  }
  file.open("PointData", "Vectors=\"displacement\"");
  file.array("displacement", view(displacement), 3);
  file.close("PointData");
  file.open("Points");
  file.array("Points", view(points), 3);
  file.close("Points");
}

std::string VtkBlocks::cells(const record::Frame& frame) {
  std::vector<std::int64_t> vertices, end;
  std::vector<std::uint8_t> type;
  std::vector<int> block;
  const auto finish = [&](std::uint8_t kind, std::size_t b) {
    end.push_back(static_cast<std::int64_t>(vertices.size()));
    type.push_back(kind);
    block.push_back(static_cast<int>(b));
  };
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!is_drawn(frame, b)) continue;
    if (is_convex(model_, frame, b)) {
      const std::vector<int>& start = model_.blocks[b].ring_start;
      for (int k = start[0]; k < start[1]; ++k) vertices.push_back(k);
      finish(vtk_polygon, b);
      continue;
    }
    for (const auto& triangle : triangles_of(b)) {
      vertices.insert(vertices.end(), triangle.begin(), triangle.end());
      finish(vtk_triangle, b);
    }
  }
  VtkFile file("UnstructuredGrid");
  add_vtk_moment(file, model_, frame.time, frame.stage, frame.step);
  file.open("Piece",
            fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", model_.vertices.size(), end.size()));
  file.open("CellData", "Scalars=\"displacement_magnitude\" Tensors=\"stress\"");
  add_block_data(file, frame, block);
  file.close("CellData");
  add_vertices(file, frame);
  file.open("Cells");
  file.array("connectivity", view(vertices));
  file.array("offsets", view(end));
  file.array("types", view(type));
  file.close("Cells");
  file.close("Piece");
  return file.text();
}

std::string VtkBlocks::outlines(const record::Frame& frame) const {
  std::vector<std::int64_t> vertices, end;
  std::vector<std::int32_t> block, edge_index, edge_trace;
  std::vector<std::uint8_t> status, edge_kind;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    const std::vector<int>& start = model_.blocks[b].ring_start;
    for (std::size_t r = 0; is_drawn(frame, b) && r + 1 < start.size(); ++r) {
      const int first = start[r], count = start[r + 1] - start[r];
      const std::vector<int> begins = stretches(model_, first, count);
      for (std::size_t s = 0; s < begins.size(); ++s) {
        const int next = s + 1 < begins.size() ? begins[s + 1] : begins.front() + count;
        for (int k = begins[s]; k <= next; ++k) vertices.push_back(first + k % count);
        end.push_back(static_cast<std::int64_t>(vertices.size()));
        const cutting::EdgeLabel label = model_.edge_label[static_cast<std::size_t>(first + begins[s])];
        block.push_back(static_cast<int>(b));
        status.push_back(static_cast<std::uint8_t>(frame.status[b]));
        edge_kind.push_back(static_cast<std::uint8_t>(label.kind));
        edge_index.push_back(label.index);
        edge_trace.push_back(label.trace);
      }
    }
  }
  VtkFile file("PolyData");
  add_vtk_moment(file, model_, frame.time, frame.stage, frame.step);
  file.open("Piece", vtk_piece(model_.vertices.size(), 0, end.size()));
  file.open("CellData", "Scalars=\"edge_kind\"");
  file.array("block", view(block));
  file.array("status", view(status));
  file.array("edge_kind", view(edge_kind));
  file.array("edge_index", view(edge_index));
  file.array("edge_trace", view(edge_trace));
  file.close("CellData");
  add_vertices(file, frame);
  add_vtk_lines(file, vertices, end);
  file.close("Piece");
  return file.text();
}

std::string VtkBlocks::centres(const record::Frame& frame) const {
  std::vector<int> blocks;
  std::vector<double> points;
  std::vector<float> displacement;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!is_drawn(frame, b)) continue;
    blocks.push_back(static_cast<int>(b));
    const Vec2 u = block_displacement(model_, frame, b), p = model_.blocks[b].centroid + u;
    points.insert(points.end(), {p.x, p.y, 0.0});
    add_vector(displacement, u);
  }
  VtkFile file("PolyData");
  add_vtk_moment(file, model_, frame.time, frame.stage, frame.step);
  file.open("Piece", vtk_piece(blocks.size(), blocks.size(), 0));
  file.open("PointData", "Scalars=\"displacement_magnitude\" Vectors=\"displacement\" Tensors=\"stress\"");
  file.array("displacement", view(displacement), 3);
  add_block_data(file, frame, blocks);
  file.close("PointData");
  file.points(points);
  file.close("Piece");
  return file.text();
}

}  // namespace keyblock::results
