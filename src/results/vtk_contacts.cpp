#include <fmt/format.h>

#include <array>
#include <utility>

#include "record/contact_fields.h"
#include "results/vtk_parts.h"

namespace keyblock::results {
namespace {

void add(std::vector<double>& values, Vec2 v) {
  values.insert(values.end(), {v.x, v.y, 0.0});
}

/// What contacts have, one value or vector for each.
class ContactArrays {
 public:
  void add_contact(const record::ContactRecord& c) {
    state_.push_back(static_cast<std::uint8_t>(c.state));
    for (std::size_t k = 0; k < numbers_.size(); ++k) numbers_[k].push_back(record::contact_fields[k].of(c));
    add(normal_, c.normal);
    // On block_a.
    add(force_, c.normal_force * c.normal - c.shear_force * perpendicular(c.normal));
    block_a_.push_back(c.block_a);
    block_b_.push_back(c.block_b);
    edge_kind_.push_back(static_cast<std::uint8_t>(c.label.kind));
    edge_index_.push_back(c.label.index);
  }
  void write(VtkFile& file) const {
    file.array("state", view(state_));
    for (std::size_t k = 0; k < numbers_.size(); ++k)
      file.array(record::contact_fields[k].name, view(numbers_[k]));
    file.array("force", view(force_), 3);
    file.array("normal", view(normal_), 3);
    file.array("block_a", view(block_a_));
    file.array("block_b", view(block_b_));
    file.array("edge_kind", view(edge_kind_));
    file.array("edge_index", view(edge_index_));
  }

 private:
  std::array<std::vector<double>, std::size(record::contact_fields)> numbers_;
  std::vector<double> normal_, force_;
  std::vector<std::uint8_t> state_, edge_kind_;
  std::vector<std::int32_t> edge_index_, block_a_, block_b_;
};

}  // namespace

std::string vtk_contact_lines(const RunData& data, const JointLocator& locator,
                              const record::ContactFrame& frame) {
  const record::ModelRecord& model = data.model;
  const std::vector<std::array<float, 2>> displacement =
      data.frames.empty() ? std::vector<std::array<float, 2>>(model.vertices.size())
                          : data.frames[frame_of(frame, data.frames)].displacement;
  std::vector<double> points;
  std::vector<std::int64_t> vertices, end;
  ContactArrays arrays;
  for (const record::ContactRecord& c : frame.contacts) {
    const auto [from, to] = locator.reach(c, displacement);
    for (const double along : {from, to}) {
      vertices.push_back(static_cast<std::int64_t>(vertices.size()));
      add(points, c.position + along * perpendicular(c.normal));
    }
    end.push_back(static_cast<std::int64_t>(vertices.size()));
    arrays.add_contact(c);
  }
  VtkFile file("PolyData");
  add_vtk_moment(file, model, frame.time, frame.stage, frame.step);
  file.open("Piece", vtk_piece(vertices.size(), 0, end.size()));
  file.open("CellData", "Scalars=\"slip\" Vectors=\"force\" Normals=\"normal\"");
  arrays.write(file);
  file.close("CellData");
  file.open("Points");
  file.array("Points", view(points), 3);
  file.close("Points");
  add_vtk_lines(file, vertices, end);
  file.close("Piece");
  return file.text();
}

std::string vtk_contact_forces(const record::ModelRecord& model, const record::ContactFrame& frame) {
  std::vector<double> points;
  ContactArrays arrays;
  for (const record::ContactRecord& c : frame.contacts) {
    if (c.normal_force == 0.0 && c.shear_force == 0.0) continue;
    add(points, c.position);
    arrays.add_contact(c);
  }
  VtkFile file("PolyData");
  add_vtk_moment(file, model, frame.time, frame.stage, frame.step);
  file.open("Piece", vtk_piece(points.size() / 3, points.size() / 3, 0));
  file.open("PointData", "Scalars=\"normal_force\" Vectors=\"force\"");
  arrays.write(file);
  file.close("PointData");
  file.points(points);
  file.close("Piece");
  return file.text();
}

}  // namespace keyblock::results
