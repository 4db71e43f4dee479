#include "core/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
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

// Numbers whose sum depends on the order of the additions.
constexpr double uneven[lane_count] = {1e16, 1.0, -1e16, 3.0, 0.1, 0.2, 0.3, 1e-17};

TEST(Lanes, SumsAddInOneOrder) {
  const double expected = ((uneven[0] + uneven[1]) + (uneven[2] + uneven[3])) +
                          ((uneven[4] + uneven[5]) + (uneven[6] + uneven[7]));
  const Lanes v = load(uneven);
  EXPECT_EQ(sum(v), expected);
  const Lanes five[5] = {v, -v, Lanes{}, v, -v}, of_five = sums(five);
  for (int k = 0; k < lane_count; ++k)
    EXPECT_EQ(of_five[k], k == 0 || k == 3 ? expected : k == 1 || k == 4 ? -expected : 0.0) << k;
}

TEST(Lanes, RowsBecomeColumns) {
  Lanes m[lane_count];
  for (int r = 0; r < lane_count; ++r)
    m[r] = each_lane([r](int c) { return static_cast<double>(10 * r + c); });
  transpose(m);
  for (int r = 0; r < lane_count; ++r) {
    for (int c = 0; c < lane_count; ++c) EXPECT_EQ(m[r][c], 10 * c + r);
  }
}

TEST(Lanes, ConditionsChooseLaneByLane) {
  const Lanes v = load(uneven), zero{};
  const Lanes chosen = where(v < broadcast(0.25), v, zero);
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(chosen[k], uneven[k] < 0.25 ? uneven[k] : 0.0);
  for (std::size_t count = 0; count <= lane_count; ++count) EXPECT_EQ(any(first_lanes(count)), count > 0);
}

TEST(Lanes, RootsAreThoseOfSingleNumbers) {
  const Lanes roots = square_root(load(uneven) * load(uneven));
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(roots[k], std::sqrt(uneven[k] * uneven[k]));
}

TEST(Lanes, EvenAndOddOnesOfTwo) {
  const Lanes a = each_lane([](int i) { return static_cast<double>(i); }), b = a + 8.0;
  const Lanes even = even_lanes(a, b), odd = odd_lanes(a, b);
  for (int k = 0; k < lane_count; ++k) {
    EXPECT_EQ(even[k], 2.0 * k);
    EXPECT_EQ(odd[k], 2.0 * k + 1.0);
  }
}

}  // namespace
}  // namespace keyblock
