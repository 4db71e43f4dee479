#include "simulation/joint_records.h"

#include <cmath>
#include <map>
#include <tuple>

#include "cutting/interfaces.h"

namespace keyblock::simulation {
namespace {

/// Kind, set or map, and trace.
using Key = std::tuple<cutting::EdgeKind, int, int>;

/// m, half of what joints have of the edges of all blocks: a joint has two sides. Edges may reach beyond an interface, so that their labels do not say
/// what they have of it.
std::map<Key, double> lengths(const RunSetup& setup) {
  std::map<Key, double> lengths;
  for (const cutting::CutBlock& block : setup.system.blocks) {
    for (std::size_t r = 0; r < block.labels.size(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const cutting::EdgeLabel label = block.labels[r][k];
        const int trace = setup.joints.place_of_trace(label) < 0 ? -1 : label.trace;
        if (cutting::is_of_interface(setup.system, label)) continue;
        lengths[{label.kind, label.index, trace}] += 0.5 * norm(ring[(k + 1) % ring.size()] - ring[k]);
      }
    }
  }
  for (const cutting::InterfaceFace& face : cutting::interface_faces(setup.system)) {
    const Ring& ring = setup.system.blocks[face.block].polygon.ring(face.ring);
    const double edge = norm(ring[(face.edge + 1) % ring.size()] - ring[face.edge]);
    lengths[{face.joint.kind, face.joint.index, -1}] += 0.5 * (face.to - face.from) * edge;
  }
  return lengths;
}

record::JointRecord record_of(cutting::EdgeLabel label, double length,
                              const contact::JointProperties& joint) {
  record::JointRecord row{label, length, joint.friction, joint.cohesion, joint.tension};
  const double none = std::nan("");
  row.residual_friction = joint.residual ? joint.residual->friction : none;
  row.residual_cohesion = joint.residual ? joint.residual->cohesion : none;
  row.weakening_slip = joint.residual ? joint.residual->slip : none;
  return row;
}

}  // namespace

std::vector<record::JointRecord> joint_records(const RunSetup& setup) {
  const std::map<Key, double> length_of = lengths(setup);
  const auto length = [&](cutting::EdgeLabel label) {
    const auto found = length_of.find({label.kind, label.index, label.trace});
    return found == length_of.end() ? 0.0 : found->second;
  };
  std::vector<record::JointRecord> rows;
  const auto add = [&](cutting::EdgeKind kind, const std::vector<contact::JointProperties>& joints,
                       const std::vector<std::vector<int>>& traces) {
    for (std::size_t k = 0; k < joints.size(); ++k) {
      cutting::EdgeLabel label{kind, static_cast<std::int16_t>(k)};
      const std::vector<int> places = k < traces.size() ? traces[k] : std::vector<int>{};
      if (places.empty()) rows.push_back(record_of(label, length(label), joints[k]));
      for (std::size_t trace = 0; trace < places.size(); ++trace) {
        label.trace = static_cast<std::int32_t>(trace);
        if (places[trace] >= 0)
          rows.push_back(record_of(label, length(label),
                                   setup.joints.of_traces[static_cast<std::size_t>(places[trace])].joint));
      }
    }
  };
  add(cutting::EdgeKind::joint_set, setup.joints.joint_sets, setup.joints.joint_set_traces);
  add(cutting::EdgeKind::trace_map, setup.joints.trace_maps, setup.joints.trace_map_traces);
  return rows;
}

}  // namespace keyblock::simulation
