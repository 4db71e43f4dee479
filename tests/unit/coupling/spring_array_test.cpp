#include "coupling/spring_array.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace keyblock::dynamics {
namespace {

/// Contacts of all kinds, each on the branch where it is, going some way.
SpringArray some_springs(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  SpringArray springs;
  springs.resize(n);
  for (std::size_t c = 0; c < n; ++c) {
    springs.kn[c] = 1.0 + std::abs(uniform(random));
    springs.ks[c] = 1.0;
    springs.set_law(c, c % 3 == 0 ? 0.0 : std::abs(uniform(random)), c % 7 == 0);
    springs.y[c] = uniform(random);
    springs.w[c] = uniform(random);
    springs.dy[c] = 0.1 * uniform(random);
    springs.dw[c] = 0.1 * uniform(random);
    springs.branch[c] = springs.branch_at(c, springs.y[c], springs.w[c]);
  }
  return springs;
}

// Eight contacts at once, against one by one.
TEST(SpringArray, SaysWhereContactsLeaveTheirPiece) {
  constexpr std::size_t n = 64;
  int leaving = 0, staying = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    SpringArray springs = some_springs(n, seed);
    for (const double alpha : {0.0, 0.1, 1.0, 3.0}) {
      for (std::size_t first = 0; first < n; first += lane_count) {
        bool any = false;
        for (std::size_t c = first; c < first + lane_count; ++c) {
          const auto branch = springs.branch_at(c, springs.y[c] + alpha * springs.dy[c],
                                                springs.w[c] + alpha * springs.dw[c]);
          any = any || branch != springs.branch[c];
        }
        EXPECT_EQ(springs.any_leaves(first, alpha), any) << seed << " " << alpha << " " << first;
        (any ? leaving : staying) += 1;
      }
    }
  }
  EXPECT_GT(leaving, 100);
  EXPECT_GT(staying, 400);
}

// Likewise; fewer than eight leave the others as they are.
TEST(SpringArray, StretchesAsManyAsItIsToldTo) {
  constexpr std::size_t n = 24;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SpringArray before = some_springs(n, seed);
    SpringArray springs = before;
    std::vector<double> normal(n), tangent(n);
    for (std::size_t c = 0; c < n; ++c) {
      springs.y0[c] = before.w[c];
      springs.w0[c] = before.y[c];
      normal[c] = 3.0 * before.dy[c];
      tangent[c] = 9.0 * before.dw[c];
    }
    const std::size_t first = seed % 9, count = 1 + seed % 8;
    springs.stretch(first, count, load(&normal[first]), load(&tangent[first]));
    for (std::size_t c = 0; c < n; ++c) {
      const bool is_stretched = c >= first && c < first + count;
      const double y = is_stretched ? springs.y0[c] - normal[c] : before.y[c],
                   w = is_stretched ? springs.w0[c] + tangent[c] : before.w[c];
      EXPECT_EQ(springs.y[c], y) << seed << " " << c;
      EXPECT_EQ(springs.w[c], w) << seed << " " << c;
      EXPECT_EQ(springs.branch[c], is_stretched ? springs.branch_at(c, y, w) : before.branch[c])
          << seed << " " << c;
    }
  }
}

TEST(SpringArray, LargestForceIsThatOfTheContactThatPressesOrPullsMost) {
  for (const std::size_t n : {std::size_t{1}, std::size_t{5}, std::size_t{8}, std::size_t{21}}) {
    const SpringArray springs = some_springs(n, static_cast<unsigned>(n));
    double expected = 0.0;
    for (std::size_t c = 0; c < n; ++c) expected = std::max(expected, std::abs(springs.force(c).normal));
    ThreadTeam team(1);
    EXPECT_EQ(largest_normal_force(springs, team), expected) << n;
  }
}

}  // namespace
}  // namespace keyblock::dynamics
