#include "core/lanes.h"

#include <gtest/gtest.h>

#include <vector>

namespace keyblock {
namespace {

// Neither reads nor writes beyond them: a sanitizer looks at the vectors, the test at the lanes.
TEST(Lanes, FirstOnesAreLoadedAndStored) {
  for (int count = 0; count <= lane_count; ++count) {
    std::vector<double> from, to(static_cast<std::size_t>(count), -1.0);
    for (int k = 0; k < count; ++k) from.push_back(1.0 + k);
    const Lanes v = load_first(from.data(), count);
    for (int k = 0; k < lane_count; ++k) EXPECT_EQ(v[k], k < count ? 1.0 + k : 0.0) << count;
    store_first(to.data(), v, count);
    EXPECT_EQ(to, from);
  }
}

TEST(Lanes, AllNumbersHaveTheirTurnOnce) {
  for (int n = 0; n <= 3 * lane_count; ++n) {
    int next = 0;
    in_lanes(n, [&](int first, int count) {
      EXPECT_EQ(first, next);
      EXPECT_GE(count, 1);
      EXPECT_LE(count, lane_count);
      next += count;
    });
    EXPECT_EQ(next, n);
  }
}

TEST(Lanes, NeighboursChangePlaces) {
  const Lanes v = swap_neighbours(each_lane([](std::size_t i) { return static_cast<double>(i); }));
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(v[k], k % 2 == 0 ? k + 1.0 : k - 1.0);
}

TEST(Lanes, CodesComeBack) {
  const std::uint16_t codes[lane_count] = {0, 1, 255, 256, 257, 32'768, 65'281, 65'535};
  std::uint16_t back[lane_count] = {};
  store_codes(back, lane_codes(codes));
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(back[k], codes[k]);
}

}  // namespace
}  // namespace keyblock
