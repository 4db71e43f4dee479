#include "core/random.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyblock {
namespace {

using Counter = std::array<std::uint32_t, 4>;

// The known answers published with Random123 (tests/kat_vectors).
TEST(Philox, PublishedAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, AgreesWithRandom123) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const Counter counter{k, 7919 * k, ~k, k << 16};
    const std::array<std::uint32_t, 2> key{k * k, 0x5bd1e995 ^ k};
    const auto theirs =
        r123::Philox4x32{}({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
    EXPECT_EQ(philox(counter, key), (Counter{theirs[0], theirs[1], theirs[2], theirs[3]}));
  }
}

TEST(RandomStream, DrawsAreUniform) {
  const RandomStream stream(2001, 3, 1, 12);
  constexpr int n = 100000;
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double u = stream.uniform(k);
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / n));
}

TEST(RandomStream, EveryPartOfTheKeyMatters) {
  const double u = RandomStream(1, 2, 3, 4).uniform(5);
  EXPECT_EQ(u, RandomStream(1, 2, 3, 4).uniform(5));
  EXPECT_NE(u, RandomStream(0x100000001, 2, 3, 4).uniform(5));
  EXPECT_NE(u, RandomStream(2, 2, 3, 4).uniform(5));
  EXPECT_NE(u, RandomStream(1, 3, 3, 4).uniform(5));
  EXPECT_NE(u, RandomStream(1, 2, 4, 4).uniform(5));
  EXPECT_NE(u, RandomStream(1, 2, 3, 5).uniform(5));
  EXPECT_NE(u, RandomStream(1, 2, 3, 4).uniform(6));
}

TEST(InverseNormalCdf, InvertsTheComplementaryErrorFunction) {
  for (double z = -37.0; z <= 8.0; z += 0.0625) {
    const double p = 0.5 * std::erfc(-z / std::sqrt(2.0));
    // Near p = 1 the rounding of p itself moves z by ε/φ(z).
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI);
    const double rounding = z > 0.0 ? 2e-16 / density : 0.0;
    EXPECT_NEAR(inverse_normal_cdf(p), z, 1e-14 * (1.0 + std::abs(z)) + rounding) << z;
  }
  EXPECT_EQ(inverse_normal_cdf(0.5), 0.0);
  EXPECT_EQ(inverse_normal_cdf(0.0), -HUGE_VAL);
  EXPECT_EQ(inverse_normal_cdf(1.0), HUGE_VAL);
}

}  // namespace
}  // namespace keyblock
