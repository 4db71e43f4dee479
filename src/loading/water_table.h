#pragma once
#include <utility>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::loading {

/// How high water at rest stands over x: straight between points, level beyond the first and the last.
class WaterTable {
 public:
  WaterTable() = default;
  /// points: x (ascending) and height, m; at least one.
  explicit WaterTable(std::vector<Vec2> points) : points_(std::move(points)) {}

  [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
  [[nodiscard]] double height(double x) const;
  /// m of water over a place; 0 above the table.
  [[nodiscard]] double head(Vec2 place) const;

  /// What the ends of a line have of the head h along a part of it, m, with s the share of the line:
  ///
  ///     start = ∫ h(s) (1 − s) ds        end = ∫ h(s) s ds
  struct Shares {
    double start = 0.0, end = 0.0;
    bool is_straight = true;  ///< the head along the part is a straight line
  };
  /// Exact, as h is straight between the points of the table. first, last: the part, as shares of the line.
  [[nodiscard]] Shares shares(Vec2 from, Vec2 to, double first, double last) const;

 private:
  std::vector<Vec2> points_;
};

}  // namespace keyblock::loading
