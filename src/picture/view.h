#pragma once
#include <string>
#include <vector>

#include "core/svg.h"
#include "geometry/vec2.h"
#include "results/run_data.h"

namespace keyblock::picture {

/// Where things of a section stand in the picture: units of it, y downwards.
struct View {
  Box window;                                 ///< m, local
  double left = 0.0, top = 0.0, scale = 1.0;  ///< scale: units per m

  [[nodiscard]] double width() const { return scale * window.size().x; }
  [[nodiscard]] double height() const { return scale * window.size().y; }
  void point(std::string& path, char command, Vec2 p) const {
    svg_point(path, command, left + scale * (p.x - window.min.x), top + scale * (window.max.y - p.y));
  }
  void line(std::string& path, Vec2 a, Vec2 b) const {
    point(path, 'M', a);
    point(path, 'L', b);
  }
};

/// The structure and a margin: what may move, as it was, and where it lies at the ends of the stages, unless that is far away: a picture is
/// scaled to the structure, not to the stone that flew farthest.
Box window_of(const results::RunData& run);

/// The blocks at one moment, as drawn.
class Placement {
 public:
  Placement(const results::RunData& run, const record::Frame& frame, double exaggeration)
      : run_(run), frame_(frame), exaggeration_(exaggeration) {}

  [[nodiscard]] Vec2 vertex(std::size_t v) const {
    const auto [x, y] = frame_.displacement[v];
    return run_.model.vertices[v] + exaggeration_ * Vec2{x, y};
  }
  /// The centroid of a block.
  [[nodiscard]] Vec2 middle(std::size_t block) const;
  /// A point that moves with a block, by where it is now.
  [[nodiscard]] Vec2 shifted(Vec2 p, std::size_t block) const;
  /// Neither fixed nor excavated.
  [[nodiscard]] bool is_drawn(std::size_t block) const {
    return !run_.model.blocks[block].fixed && frame_.status[block] != record::BlockStatus::excavated;
  }
  [[nodiscard]] const record::Frame& frame() const { return frame_; }

 private:
  const results::RunData& run_;
  const record::Frame& frame_;
  double exaggeration_;
};

}  // namespace keyblock::picture
