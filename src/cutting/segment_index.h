#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::cutting {

/// Segments by the cells of a uniform grid that they pass through.
class SegmentIndex {
 public:
  /// `columns` cells along the longer side of `bounds`; what lies outside belongs to the cells of the rim.
  SegmentIndex(const Box& bounds, int columns);

  void add(int id, Vec2 a, Vec2 b);

  /// Calls visit(id) for every segment that may meet `box`; the same id may come several times.
  template <typename Visit>
  void near(const Box& box, const Visit& visit) const {
    const int last_row = row(box.max.y), last_column = column(box.max.x);
    for (int r = row(box.min.y); r <= last_row; ++r) {
      for (int c = column(box.min.x); c <= last_column; ++c) {
        for (const int id : cells_[cell(r, c)]) visit(id);
      }
    }
  }

 private:
  [[nodiscard]] int column(double x) const { return clamped((x - origin_.x) / size_, columns_); }
  [[nodiscard]] int row(double y) const { return clamped((y - origin_.y) / size_, rows_); }
  [[nodiscard]] static int clamped(double position, int count) {
    return static_cast<int>(std::clamp(std::floor(position), 0.0, static_cast<double>(count - 1)));
  }
  [[nodiscard]] std::size_t cell(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
  }

  Vec2 origin_;
  double size_;
  int columns_;
  int rows_;
  std::vector<std::vector<int>> cells_;
};

}  // namespace keyblock::cutting
