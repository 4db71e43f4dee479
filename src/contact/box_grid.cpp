#include "contact/box_grid.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace keyblock::contact {

BoxGrid::BoxGrid(std::span<const Box> boxes, std::span<const std::uint8_t> present)
    : boxes_(boxes), present_(present) {
  choose_cells();
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    if (!present[b]) continue;
    const Range r = range(boxes[b]);
    if (r.is_huge()) {
      huge_.push_back(static_cast<int>(b));
    } else {
      for_cells(r, [&](std::size_t c) { members_[c].push_back(static_cast<int>(b)); });
    }
  }
}

/// As large as boxes are in the mean, and no more than a few for each block.
void BoxGrid::choose_cells() {
  constexpr double most_cells = 1e9;  // on a side
  constexpr std::size_t cells_per_block = 4;
  Box all;
  double mean = 0.0;
  std::size_t count = 0;
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (!present_[b]) continue;
    all.add(boxes_[b]);
    mean += boxes_[b].size().x + boxes_[b].size().y;
    ++count;
  }
  if (count == 0) return;
  cell_ = std::max(mean / static_cast<double>(count), 1e-300);
  origin_ = all.min;
  const auto cells = [&](double length) {
    return static_cast<int>(std::min(length / cell_ + 1.0, most_cells));
  };
  columns_ = period_x_ = cells(all.size().x);
  rows_ = period_y_ = cells(all.size().y);
  while (at(period_x_) * at(period_y_) > cells_per_block * count) {
    int& longer = period_x_ > period_y_ ? period_x_ : period_y_;
    longer = (longer + 1) / 2;
  }
  members_.resize(at(period_x_) * at(period_y_));
}

void BoxGrid::query(int b, std::vector<int>& found) const {
  found.clear();
  const Box& box = boxes_[at(b)];
  const auto add = [&](int other) {
    if (other != b && boxes_[at(other)].overlaps(box)) found.push_back(other);
  };
  const Range r = range(box);
  if (r.is_huge()) {
    for (std::size_t other = 0; other < boxes_.size(); ++other) {
      if (present_[other]) add(static_cast<int>(other));
    }
    return;
  }
  for_cells(r, [&](std::size_t c) { std::ranges::for_each(members_[c], add); });
  std::ranges::for_each(huge_, add);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

BoxGrid::Range BoxGrid::range(const Box& box) const {
  const auto index = [&](double t, double from, int count) {
    return static_cast<int>(std::clamp(std::floor((t - from) / cell_), 0.0, count - 1.0));
  };
  return {index(box.min.x, origin_.x, columns_), index(box.max.x, origin_.x, columns_),
          index(box.min.y, origin_.y, rows_), index(box.max.y, origin_.y, rows_)};
}

std::size_t BoxGrid::cell(int x, int y) const {
  return at(y % period_y_) * at(period_x_) + at(x % period_x_);
}

template <typename OfCell>
void BoxGrid::for_cells(const Range& r, const OfCell& of_cell) const {
  for (int y = r.y0; y <= r.y1; ++y) {
    for (int x = r.x0; x <= r.x1; ++x) of_cell(cell(x, y));
  }
}

}  // namespace keyblock::contact
