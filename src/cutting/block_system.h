#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/polygon.h"

namespace keyblock::cutting {

/// What an edge of a block is a piece of.
enum class EdgeKind : std::uint8_t {
  free,       ///< an edge of an explicit block
  joint_set,  ///< index: of the joint set, or of what is like one, after all sets: rock bridges, an interface
  trace_map,  ///< index: of the trace map
  excavation,  ///< index: of the excavation whose outline it lies on
  domain,      ///< the edge of the domain (where the frame is); index 0
};

/// The last of the kinds.
constexpr EdgeKind last_of(EdgeKind /*any*/) {
  return EdgeKind::domain;
}

/// The set, map or outline, and which trace of it. Labels are equal that are of the same set, map or outline: the trace has no say in the geometry.
struct EdgeLabel {
  EdgeKind kind = EdgeKind::free;
  std::int16_t index = 0;
  /// Number of the trace in its set or map (rockmass::Trace::number); −1: it has none. Where traces overlap, the first. An edge that takes in pieces of
  /// several traces in line has that of the longest part.
  std::int32_t trace = -1;
  friend constexpr bool operator==(EdgeLabel a, EdgeLabel b) {
    return a.kind == b.kind && a.index == b.index;
  }
};

/// One block as cut, in reference position.
struct CutBlock {
  Polygon polygon;
  /// labels[r][k] belongs to the edge from vertex k to vertex k + 1 of ring r (0: outer ring, then the holes).
  std::vector<std::vector<EdgeLabel>> labels;
  /// Excavations (indices into the scenario's) whose outline contains the block, ascending.
  std::vector<int> excavations;
};

/// What the cutting did, for the user. A trace is a straight piece; a curved one of a map counts several times.
struct CutStatistics {
  int traces = 0;               ///< traces that meet the domain
  int joints_used = 0;          ///< traces of which some piece bounds two blocks, before cleaning
  double trace_length = 0.0;    ///< m inside the domain
  double removed_length = 0.0;  ///< m of dead ends and of joints that bound no block (tree cutting)
  int removed_pieces = 0;
  double bridge_length = 0.0;  ///< m of rock bridges that bound blocks, before cleaning
  int merged_slivers = 0;
  int merged_across_joints = 0;  ///< of these, slivers that were merged across a joint that runs through
  double highest_tooth = 0.0;    ///< m, of the teeth that this left in joints (JointTooth)
  int slivers_left = 0;          ///< blocks that only the tolerances that were given keep from being merged
  int merged_vertices = 0;       ///< clustered or near-collinear vertices that were dropped
  double domain_area = 0.0;      ///< m²
  double sliver_area = 0.0;      ///< m² that changed its block by merging
};

/// How much of the joints of a set or map is in the model.
struct JointShare {
  EdgeLabel joint;
  double length = 0.0;   ///< m inside the domain
  double removed = 0.0;  ///< m of these that end in rock or bound no block
  double bridged = 0.0;  ///< m of rock bridges on its lines, beside its length
};

/// A place where rock of one wall of a joint reaches into the other, so that the walls hold each other: a sliver was merged across the
/// joint, which goes on straight on both sides of it.
struct JointTooth {
  EdgeLabel joint;
  Vec2 place;           ///< local coordinates
  double height = 0.0;  ///< m, across the joint
};

/// A block that the usual tolerances would have merged. Its corners can catch the other wall of a joint beside it.
struct SmallBlock {
  EdgeLabel joint;    ///< the weakest at its border
  Vec2 place;         ///< local coordinates
  double area = 0.0;  ///< m²
};

/// Two blocks that have a joint of their own between them, wherever they touch.
struct Interface {
  std::size_t low = 0, high = 0;  ///< the blocks, ascending
  EdgeLabel joint;                ///< of kind joint_set
};

struct BlockSystem {
  std::vector<CutBlock> blocks;
  std::vector<Interface> interfaces;     ///< no pair twice
  std::vector<JointShare> joints;        ///< one for each set and map that meets the domain
  std::vector<JointTooth> teeth;         ///< in the order of cutting
  std::vector<SmallBlock> slivers_left;  ///< in the order of the blocks
  CutStatistics statistics;
  /// Real coordinates of the local origin: block coordinates are real ones minus this. Zero unless the domain lies
  /// so far from the origin that digits would be lost (a map in national coordinates).
  Vec2 origin;
};

/// m, √ of the mean area of the blocks.
inline double mean_block_size(const BlockSystem& system) {
  double sum = 0.0;
  for (const CutBlock& block : system.blocks) sum += area(block.polygon);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(system.blocks.size(), 1)));
}

}  // namespace keyblock::cutting
