#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "overlap/overlap.h"
#include "scenario/build.h"
#include "simulation/build_model.h"

namespace keyblock::scenario {
namespace {

// Overlaps of explicit blocks deeper than this share of the size of the smallest block are warned of, the deepest ones.
constexpr double overlap_share = 1e-4;
constexpr std::size_t most_overlaps = 5;

}  // namespace

// Contact takes blocks that overlap at the start as they are: nothing pushes them apart.
void add_overlap_warnings(const Scenario& scenario, const cutting::BlockSystem& system,
                          std::vector<std::string>& warnings) {
  if (scenario.blocks.empty()) return;
  const std::size_t cut = system.blocks.size() - scenario.blocks.size();
  std::vector<Polygon> polygons;
  double least_depth = HUGE_VAL;
  for (const cutting::CutBlock& block : system.blocks) {
    polygons.push_back(block.polygon);
    least_depth = std::min(least_depth, overlap_share * std::sqrt(area(block.polygon)));
  }
  if (scenario.domain && scenario.domain->frame) {
    const Box box = scenario.domain->box();
    polygons.push_back(simulation::frame_polygon({box.min - system.origin, box.max - system.origin}));
  }
  const auto name = [&](int block) {
    const auto b = static_cast<std::size_t>(block);
    if (b >= system.blocks.size()) return std::string("the frame around the domain");
    return b < cut ? std::string("a block of the domain") : scenario.blocks[b - cut].path;
  };
  const auto overlaps = overlap::all_overlaps(polygons, least_depth);
  for (std::size_t k = 0; k < std::min(overlaps.size(), most_overlaps); ++k) {
    const Vec2 where = overlaps[k].where + system.origin;
    warnings.push_back(fmt::format("{} and {} overlap by {:.3g} m at [{:.6g}, {:.6g}]",
                                   name(overlaps[k].block_a), name(overlaps[k].block_b), overlaps[k].depth,
                                   where.x, where.y));
  }
  if (overlaps.size() > most_overlaps)
    warnings.push_back(
        fmt::format("{} more pairs of blocks overlap, by less", overlaps.size() - most_overlaps));
}

}  // namespace keyblock::scenario
