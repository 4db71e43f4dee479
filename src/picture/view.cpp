#include "picture/view.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "picture/quantities.h"
#include "results/block_shape.h"

namespace keyblock::picture {
namespace {

constexpr double margin = 0.04;       // of the larger side
constexpr double most_growth = 0.35;  // of the size of the structure, on each side, for what has moved

bool has_domain(const record::ModelRecord& model) {
  return std::ranges::any_of(model.edge_label,
                             [](auto label) { return label.kind == cutting::EdgeKind::domain; });
}

}  // namespace

Box window_of(const results::RunData& run) {
  const record::ModelRecord& model = run.model;
  const bool any_moves = std::ranges::any_of(model.blocks, [](const auto& b) { return !b.fixed; });
  Box structure;
  for (const auto& block : model.blocks) {
    if (any_moves && block.fixed) continue;
    for (int v = block.ring_start.front(); v < block.ring_start.back(); ++v)
      structure.add(model.vertices[at(v)]);
  }
  if (!(structure.size().x > 0.0) || !(structure.size().y > 0.0)) return Box{{-1.0, -1.0}, {1.0, 1.0}};
  const double size = std::max(structure.size().x, structure.size().y);
  const Box most = structure.grown(most_growth * size);
  Box window = structure;
  for (const std::size_t f : stage_end_frames(run)) {
    const Placement place(run, run.frames[f], 1.0);
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      if (!place.is_drawn(b)) continue;
      const Vec2 p = place.middle(b);
      if (most.contains(p)) window.add(p);
    }
  }
  // Around blocks that stand on something, some of it is seen.
  return window.grown((has_domain(model) ? margin : 2.5 * margin) * size);
}

Vec2 Placement::middle(std::size_t block) const {
  return run_.model.blocks[block].centroid +
         exaggeration_ * results::block_displacement(run_.model, frame_, block);
}

Vec2 Placement::shifted(Vec2 p, std::size_t block) const {
  return p + (exaggeration_ - 1.0) * results::block_displacement(run_.model, frame_, block);
}

}  // namespace keyblock::picture
