#include "contact/box_grid.h"

#include <gtest/gtest.h>

#include <random>

namespace keyblock::contact {
namespace {

// Small boxes, some far from all others, some over many cells, some of blocks that are not there.
TEST(BoxGrid, FindsTheBoxesThatOverlap) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Box> boxes(400);
  std::vector<std::uint8_t> present(boxes.size(), 1);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const double far = b % 50 == 0 ? 1e4 : 10.0, size = b % 97 == 0 ? 30.0 : 0.3;
    const Vec2 from{far * uniform(random), far * uniform(random)};
    boxes[b].add(from);
    boxes[b].add(from + Vec2{size * uniform(random), size * uniform(random)});
    present[b] = b % 11 == 3 ? 0 : 1;
  }
  const BoxGrid grid(boxes, present);
  std::vector<int> found;
  std::size_t overlaps = 0;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    if (present[b] == 0) continue;
    std::vector<int> expected;
    for (std::size_t other = 0; other < boxes.size(); ++other) {
      if (other != b && present[other] != 0 && boxes[other].overlaps(boxes[b]))
        expected.push_back(static_cast<int>(other));
    }
    grid.query(static_cast<int>(b), found);
    EXPECT_EQ(found, expected) << b;
    overlaps += found.size();
  }
  EXPECT_GT(overlaps, 200U);
}

}  // namespace
}  // namespace keyblock::contact
