#pragma once
#include <cstddef>
#include <vector>

#include "model/model.h"
#include "simulation/bolt_springs.h"
#include "simulation/setup.h"

/// Rock bolts as chains of nodes (docs/decisions/0036): bodies of their own, whose grout slips along their length.
namespace keyblock::simulation {

/// A node of a bolt, in the middle of the grout that it stands for.
struct BoltNode {
  std::size_t piece = 0;        ///< of bolt_pieces, that it is in
  double from = 0.0, to = 0.0;  ///< m from the head; no grout: it is the head, which a plate holds

  [[nodiscard]] double grouted() const { return to - from; }
  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

/// N of the bodies of nodes: that of blocks of order 1, or of order 2 where all blocks have that.
int body_size(const RunSetup& setup);

/// m, the largest distance of nodes beside each other in one block: that of the bolt or, unless it has one, 1/(2α) of its grout, α = √(k_b/EA), no less
/// than its diameter and 0.25 m at the most. Pull-out is within 0.3 % of continuous grout then.
double node_spacing(const loading::Bolt& bolt);

/// The nodes of bolt k from its head to its toe: in the middle of cells of grout, one as long as the active length
/// beside each joint, where that is less than their spacing, the others evenly. There are as
/// many as fill whole bodies. Empty: it is no bolt of nodes, or nothing moves that it ties.
std::vector<BoltNode> bolt_nodes(const RunSetup& setup, std::size_t k);

/// The bodies of all bolts, in their order. Two bodies take turns along a bolt, so that no row has one body on both sides: nodes 0, 2, 4 are one, and
/// 1, 3, 5 are the other. Bodies are as large as blocks of order 1; of order 2, where all blocks have that.
std::vector<dynamics::LineBody> bolt_lines(const RunSetup& setup);

/// Adds the springs of the bolts of nodes: bars between nodes, grout from each node to its hole, a plate at the head, dowels.
void add_bolts_of_nodes(const RunSetup& setup, const dynamics::Model& model, BoltSprings& to);

}  // namespace keyblock::simulation
