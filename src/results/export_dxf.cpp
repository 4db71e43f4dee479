#include <string>
#include <vector>

#include "cutting/edge_name.h"
#include "drawing/dxf_writer.h"
#include "results/block_shape.h"
#include "results/export.h"
#include "results/stage_ends.h"

namespace keyblock::results {
namespace {

bool is_joint(cutting::EdgeLabel label) {
  return label.kind == cutting::EdgeKind::joint_set || label.kind == cutting::EdgeKind::trace_map;
}

// Edges of one joint that follow each other in a ring are one polyline; all of the ring may be.
void draw_joints(const record::ModelRecord& model, const std::vector<Vec2>& ring,
                 const std::vector<cutting::EdgeLabel>& labels, drawing::DxfWriter& out) {
  const std::size_t n = ring.size();
  std::size_t first = 0;
  while (first < n && labels[first] == labels[(first + n - 1) % n]) ++first;
  const bool whole = first == n;
  if (whole) first = 0;
  for (std::size_t k = 0; k < n;) {
    const cutting::EdgeLabel label = labels[(first + k) % n];
    std::vector<Vec2> side{ring[(first + k) % n]};
    for (; k < n && labels[(first + k) % n] == label; ++k) side.push_back(ring[(first + k + 1) % n]);
    if (!is_joint(label)) continue;
    if (whole) side.pop_back();
    const std::string name =
        cutting::edge_name(label, model.joint_set_names, model.trace_map_names, model.excavation_names);
    out.polyline("JOINT_" + (name.empty() ? std::to_string(label.index) : name), side, whole);
  }
}

std::string stage_drawing(const RunData& data, const record::Frame& frame) {
  const record::ModelRecord& model = data.model;
  drawing::DxfWriter out;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (frame.status[b] == record::BlockStatus::excavated) continue;
    const Polygon polygon = block_shape(model, frame, b);
    const std::string layer = model.blocks[b].fixed ? "fixed" : status_name(frame.status[b]);
    for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
      out.polyline(layer, polygon.ring(r), true);
      const auto first = model.edge_label.begin() + model.blocks[b].ring_start[r];
      draw_joints(model, polygon.ring(r),
                  {first, first + static_cast<std::ptrdiff_t>(polygon.ring(r).size())}, out);
    }
  }
  return out.text();
}

}  // namespace

std::vector<std::filesystem::path> export_dxf(const RunData& data, FileSet& out) {
  std::vector<std::filesystem::path> files;
  for (const StageEnd& end : stage_ends(data, ".dxf"))
    files.push_back(out.write(end.file, stage_drawing(data, *end.frame)));
  return files;
}

}  // namespace keyblock::results
