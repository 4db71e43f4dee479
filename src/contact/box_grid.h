#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::contact {

/// Cells of equal size over all boxes; finds the boxes that overlap a given box.
///
/// A few blocks that are far from all others do not make it large: where there would be many more cells than blocks, it repeats itself,
/// and cells that lie far apart share their members. A box over many cells is kept apart.
class BoxGrid {
 public:
  /// Of the boxes of blocks that are present. Both have to stay.
  BoxGrid(std::span<const Box> boxes, std::span<const std::uint8_t> present);
  /// Blocks whose boxes overlap with the box of block b, each once, not b itself; ascending.
  void query(int b, std::vector<int>& found) const;

 private:
  struct Range {
    int x0, x1, y0, y1;
    [[nodiscard]] bool is_huge() const {
      constexpr std::int64_t most_cells_of_a_box = 256;
      return (x1 - x0 + std::int64_t{1}) * (y1 - y0 + std::int64_t{1}) > most_cells_of_a_box;
    }
  };
  void choose_cells();
  [[nodiscard]] Range range(const Box& box) const;
  [[nodiscard]] std::size_t cell(int x, int y) const;
  template <typename OfCell>
  void for_cells(const Range& r, const OfCell& of_cell) const;

  std::span<const Box> boxes_;
  std::span<const std::uint8_t> present_;
  double cell_ = 1.0;  ///< m
  Vec2 origin_;
  int columns_ = 0, rows_ = 0;
  int period_x_ = 1, period_y_ = 1;  ///< cells after which the grid repeats itself
  std::vector<std::vector<int>> members_;
  std::vector<int> huge_;
};

}  // namespace keyblock::contact
