#include "cutting/interfaces.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "geometry/facing.h"

namespace keyblock::cutting {

namespace {

/// An edge of a block.
struct Side {
  std::size_t block, ring, edge;
  Vec2 from, to;
};

std::vector<Side> sides_of(const BlockSystem& system, std::size_t block) {
  std::vector<Side> sides;
  const Polygon& polygon = system.blocks[block].polygon;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    const Ring& ring = polygon.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k)
      sides.push_back({block, r, k, ring[k], ring[(k + 1) % ring.size()]});
  }
  return sides;
}

void add_face(const Side& side, const Side& beside, double distance, EdgeLabel joint,
              std::vector<InterfaceFace>& faces) {
  const auto common = facing_stretch(side.from, side.to, beside.from, beside.to, distance);
  if (!common) return;
  const double length = norm(side.to - side.from);
  faces.push_back(
      {side.block, side.ring, side.edge, common->from / length, std::min(1.0, common->to / length), joint});
}

}  // namespace

std::optional<EdgeLabel> joint_between(const BlockSystem& system, std::size_t one, std::size_t other) {
  const auto [low, high] = std::minmax(one, other);
  for (const Interface& interface : system.interfaces)
    if (interface.low == low && interface.high == high) return interface.joint;
  return std::nullopt;
}

bool is_of_interface(const BlockSystem& system, EdgeLabel joint) {
  return std::ranges::find(system.interfaces, joint, &Interface::joint) != system.interfaces.end();
}

std::vector<InterfaceFace> interface_faces(const BlockSystem& system) {
  constexpr double touching = 1e-3;  // of the block size
  const double distance = touching * mean_block_size(system);
  std::vector<InterfaceFace> faces;
  for (const Interface& interface : system.interfaces) {
    const std::vector<Side> low = sides_of(system, interface.low), high = sides_of(system, interface.high);
    for (const Side& one : low) {
      for (const Side& other : high) {
        add_face(one, other, distance, interface.joint, faces);
        add_face(other, one, distance, interface.joint, faces);
      }
    }
  }
  return faces;
}

void label_interfaces(BlockSystem& system) {
  std::map<std::tuple<std::size_t, std::size_t, std::size_t, int>, double> shares;
  for (const InterfaceFace& face : interface_faces(system)) {
    double& share = shares[{face.block, face.ring, face.edge, face.joint.index}];
    share += face.to - face.from;
    if (share > 0.5) system.blocks[face.block].labels[face.ring][face.edge] = face.joint;
  }
}

}  // namespace keyblock::cutting
