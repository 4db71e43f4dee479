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

/// A picture of the blocks as an SVG text, 1000 units wide: blocks, their edges in the colour of the joint set or map,
/// what was removed of the traces in grey, outlines of excavations in black, a scale bar and a legend. `traces` and
/// `excavations` in real coordinates, as given to cut.
std::string draw_svg(const BlockSystem& system, const std::vector<rockmass::Trace>& traces,
                     const std::vector<Ring>& excavations, const PictureNames& names = {});

}  // namespace keyblock::cutting
