#pragma once
#include <string>
#include <vector>

#include "cutting/block_system.h"
#include "rockmass/trace.h"

namespace keyblock::cutting {

/// Names for the legend; a set, map or excavation beyond the end of its list is numbered.
struct PictureNames {
  std::vector<std::string> joint_sets;
  std::vector<std::string> trace_maps;
  std::vector<std::string> excavations;
};

/// Blocks that are filled with a colour, and what the legend says of them.
struct BlockPaint {
  std::string name;
  std::string colour;  ///< as SVG has it
  std::vector<int> blocks;
};

/// A picture of the blocks as an SVG text, 1000 units wide: blocks, their edges in the colour of the joint set or map,
/// what was removed of the traces in grey, outlines of excavations in black, a scale bar and a legend. `traces` and
/// `excavations` in real coordinates, as given to cut. Of `paint` only what has blocks is in the legend.
std::string draw_svg(const BlockSystem& system, const std::vector<rockmass::Trace>& traces,
                     const std::vector<Ring>& excavations, const PictureNames& names = {},
                     const std::vector<BlockPaint>& paint = {});

}  // namespace keyblock::cutting
