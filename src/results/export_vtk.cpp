#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "results/block_shape.h"
#include "results/export.h"
#include "results/joint_pieces.h"
#include "results/vtk_file.h"

namespace keyblock::results {
namespace {

constexpr std::uint8_t vtk_triangle = 5, vtk_polygon = 7;
constexpr double smallest_time_step = 1e-6;  // s between the moments of a series

template <class T>
std::span<const T> view(const std::vector<T>& values) {
  return values;
}

// Cells of all blocks, as lists of display vertices.
struct Cells {
  std::vector<std::int64_t> vertices, end;  // of cell k: vertices[end[k − 1] … end[k])
  std::vector<std::uint8_t> type;
  std::vector<int> block;
};

Cells block_cells(const simulation::ModelRecord& model) {
  Cells cells;
  const auto finish = [&](std::uint8_t type, std::size_t block) {
    cells.end.push_back(static_cast<std::int64_t>(cells.vertices.size()));
    cells.type.push_back(type);
    cells.block.push_back(static_cast<int>(block));
  };
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const std::vector<int>& start = model.blocks[b].ring_start;
    if (start.size() == 2) {
      for (int k = start[0]; k < start[1]; ++k) cells.vertices.push_back(k);
      finish(vtk_polygon, b);
      continue;
    }
    for (const auto& triangle : block_triangles(model, b)) {
      cells.vertices.insert(cells.vertices.end(), triangle.begin(), triangle.end());
      finish(vtk_triangle, b);
    }
  }
  return cells;
}

Cells without_excavated(const Cells& all, const simulation::Frame& frame) {
  Cells kept;
  std::int64_t begin = 0;
  for (std::size_t k = 0; k < all.end.size(); ++k) {
    const auto from = all.vertices.begin() + begin;
    begin = all.end[k];
    if (frame.status[static_cast<std::size_t>(all.block[k])] == simulation::BlockStatus::excavated) continue;
    kept.vertices.insert(kept.vertices.end(), from, all.vertices.begin() + begin);
    kept.end.push_back(static_cast<std::int64_t>(kept.vertices.size()));
    kept.type.push_back(all.type[k]);
    kept.block.push_back(all.block[k]);
  }
  return kept;
}

void add_moment(VtkFile& file, double time, int stage, long step) {
  file.open("FieldData");
  file.field<double>("TimeValue", time);
  file.field<std::int32_t>("stage", stage);
  file.field<std::int64_t>("step", step);
  file.close("FieldData");
}

void add_block_data(VtkFile& file, const simulation::ModelRecord& model, const simulation::Frame& frame,
                    const Cells& cells) {
  std::vector<std::int32_t> block, order, excavation;
  std::vector<std::uint8_t> status;
  std::vector<float> stress;
  std::vector<double> magnitude(model.blocks.size()), cell_magnitude;
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    magnitude[b] = norm(block_displacement(model, frame, b));
  for (const int b : cells.block) {
    const auto k = static_cast<std::size_t>(b);
    const auto& record = model.blocks[k];
    block.push_back(b);
    order.push_back(frame.order[k]);
    excavation.push_back(record.excavations.empty() ? -1 : record.excavations.front());
    status.push_back(static_cast<std::uint8_t>(frame.status[k]));
    stress.insert(stress.end(), frame.stress[k].begin(), frame.stress[k].end());
    cell_magnitude.push_back(magnitude[k]);
  }
  file.open("CellData", "Scalars=\"displacement_magnitude\"");
  file.array("block", view(block));
  file.array("status", view(status));
  file.array("stress", view(stress), 3, {"xx", "yy", "xy"});
  file.array("displacement_magnitude", view(cell_magnitude));
  file.array("order", view(order));
  file.array("excavation", view(excavation));
  file.close("CellData");
}

std::string block_file(const simulation::ModelRecord& model, const simulation::Frame& frame,
                       const Cells& all) {
  const Cells cells = without_excavated(all, frame);
  std::vector<double> points;
  std::vector<float> displacement;
  for (std::size_t k = 0; k < model.vertices.size(); ++k) {
    const auto [ux, uy] = frame.displacement[k];
    const Vec2 p = model.origin + model.vertices[k] + Vec2{ux, uy};
    points.insert(points.end(), {p.x, p.y, 0.0});
    displacement.insert(displacement.end(), {ux, uy, 0.0F});
  }
  VtkFile file("UnstructuredGrid");
  add_moment(file, frame.time, frame.stage, frame.step);
  file.open("Piece", fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", model.vertices.size(),
                                 cells.end.size()));
  file.open("PointData", "Vectors=\"displacement\"");
  file.array("displacement", view(displacement), 3);
  file.close("PointData");
  add_block_data(file, model, frame, cells);
  file.open("Points");
  file.array("Points", view(points), 3);
  file.close("Points");
  file.open("Cells");
  file.array("connectivity", view(cells.vertices));
  file.array("offsets", view(cells.end));
  file.array("types", view(cells.type));
  file.close("Cells");
  file.close("Piece");
  return file.text();
}

std::string contact_file(const RunData& data, const JointLocator& locator,
                         const simulation::ContactFrame& frame) {
  const simulation::ModelRecord& model = data.model;
  const std::vector<std::array<float, 2>> displacement =
      data.frames.empty() ? std::vector<std::array<float, 2>>(model.vertices.size())
                          : data.frames[frame_of(frame, data.frames)].displacement;
  std::vector<double> points, slip, gap, normal_force, shear_force;
  std::vector<std::int64_t> vertices, end;
  std::vector<std::uint8_t> state, edge_kind;
  std::vector<std::int32_t> edge_index, block_a, block_b;
  for (const simulation::ContactRecord& c : frame.contacts) {
    const auto [from, to] = locator.reach(c, displacement);
    for (const double along : {from, to}) {
      const Vec2 p = model.origin + c.position + along * perpendicular(c.normal);
      vertices.push_back(static_cast<std::int64_t>(vertices.size()));
      points.insert(points.end(), {p.x, p.y, 0.0});
    }
    end.push_back(static_cast<std::int64_t>(vertices.size()));
    state.push_back(static_cast<std::uint8_t>(c.state));
    slip.push_back(c.slip);
    gap.push_back(c.gap);
    normal_force.push_back(c.normal_force);
    shear_force.push_back(c.shear_force);
    block_a.push_back(c.block_a);
    block_b.push_back(c.block_b);
    edge_kind.push_back(static_cast<std::uint8_t>(c.label.kind));
    edge_index.push_back(c.label.index);
  }
  VtkFile file("PolyData");
  add_moment(file, frame.time, frame.stage, frame.step);
  file.open("Piece", fmt::format("NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
                                 "NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
                                 vertices.size(), end.size()));
  file.open("CellData", "Scalars=\"slip\"");
  file.array("state", view(state));
  file.array("slip", view(slip));
  file.array("gap", view(gap));
  file.array("normal_force", view(normal_force));
  file.array("shear_force", view(shear_force));
  file.array("block_a", view(block_a));
  file.array("block_b", view(block_b));
  file.array("edge_kind", view(edge_kind));
  file.array("edge_index", view(edge_index));
  file.close("CellData");
  file.open("Points");
  file.array("Points", view(points), 3);
  file.close("Points");
  file.open("Lines");
  file.array("connectivity", view(vertices));
  file.array("offsets", view(end));
  file.close("Lines");
  file.close("Piece");
  return file.text();
}

// A moment of a run: stage, step, and how many frames of the same series are of that step before it.
using Moment = std::tuple<int, long, int>;

template <class Frames>
std::vector<Moment> moments_of(const Frames& frames) {
  std::vector<Moment> moments;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool again =
        k > 0 && frames[k].stage == frames[k - 1].stage && frames[k].step == frames[k - 1].step;
    moments.emplace_back(frames[k].stage, frames[k].step, again ? std::get<2>(moments.back()) + 1 : 0);
  }
  return moments;
}

// Times of all moments, one and the same for blocks and contacts, that ascend where simulated time stands still.
std::map<Moment, double> series_times(const RunData& data) {
  std::map<Moment, double> times;
  const auto add = [&](const auto& frames) {
    const std::vector<Moment> moments = moments_of(frames);
    for (std::size_t k = 0; k < frames.size(); ++k) times.emplace(moments[k], frames[k].time);
  };
  add(data.frames);
  add(data.contacts);
  double next = -HUGE_VAL;
  for (auto& [moment, time] : times) {
    time = std::max(time, next);
    next = time + smallest_time_step;
  }
  return times;
}

// Writes one file per frame and the series of them; returns the series first.
template <class Frames, class Content>
std::vector<std::filesystem::path> write_series(const Frames& frames, const std::map<Moment, double>& times,
                                                FileSet& out, const std::string& name,
                                                const std::string& extension, const Content& content) {
  const std::vector<Moment> moments = moments_of(frames);
  std::vector<std::filesystem::path> files(1);
  std::vector<std::pair<double, std::string>> series;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::string file = fmt::format("{}_{:05}.{}", name, k, extension);
    files.push_back(out.write(file, content(frames[k])));
    series.emplace_back(times.at(moments[k]), file);
  }
  files.front() = out.write(name + ".pvd", vtk_series(series));
  return files;
}

}  // namespace

std::vector<std::filesystem::path> export_vtk(const RunData& data, FileSet& out) {
  const Cells cells = block_cells(data.model);
  const auto times = series_times(data);
  auto files = write_series(data.frames, times, out, "blocks", "vtu", [&](const simulation::Frame& frame) {
    return block_file(data.model, frame, cells);
  });
  const JointLocator locator(data.model);
  const auto contacts =
      write_series(data.contacts, times, out, "contacts", "vtp",
                   [&](const simulation::ContactFrame& frame) { return contact_file(data, locator, frame); });
  files.insert(files.begin() + 1, contacts.front());
  files.insert(files.end(), contacts.begin() + 1, contacts.end());
  return files;
}

}  // namespace keyblock::results
