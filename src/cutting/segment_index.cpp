#include "cutting/segment_index.h"

namespace keyblock::cutting {

SegmentIndex::SegmentIndex(const Box& bounds, int columns) : origin_(bounds.min) {
  const Vec2 extent = bounds.size();
  size_ = std::max(extent.x, extent.y) / columns;
  columns_ = std::max(1, static_cast<int>(std::ceil(extent.x / size_)));
  rows_ = std::max(1, static_cast<int>(std::ceil(extent.y / size_)));
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
}

void SegmentIndex::add(int id, Vec2 a, Vec2 b) {
  if (a.x > b.x) std::swap(a, b);
  const int first = column(a.x), last = column(b.x);
  for (int c = first; c <= last; ++c) {
    // The part of the segment over this column, with a little slack for rounding.
    Vec2 from = a, to = b;
    if (c > first) from.y = a.y + (b.y - a.y) * ((origin_.x + c * size_ - a.x) / (b.x - a.x));
    if (c < last) to.y = a.y + (b.y - a.y) * ((origin_.x + (c + 1) * size_ - a.x) / (b.x - a.x));
    const double slack = 1e-6 * size_;
    const int last_row = row(std::max(from.y, to.y) + slack);
    for (int r = row(std::min(from.y, to.y) - slack); r <= last_row; ++r) cells_[cell(r, c)].push_back(id);
  }
}

}  // namespace keyblock::cutting
