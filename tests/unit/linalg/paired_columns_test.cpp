#include "linalg/paired_columns.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace keyblock::linalg::paired_columns {
namespace {

constexpr int stride = lane_count;

struct Sample {
  std::array<float, block_size + read_beyond> block{};
  std::array<float, stride> x{};  // padded by zeros

  explicit Sample(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    for (float& v : block) v = uniform(random);  // what follows the block counts for nothing
    for (int k = 0; k < rows; ++k) x[static_cast<std::size_t>(k)] = uniform(random);
  }
  [[nodiscard]] double entry(int row, int column) const {
    return static_cast<double>(block[static_cast<std::size_t>(column * rows + row)]);
  }
  [[nodiscard]] double x_at(int k) const { return static_cast<double>(x[static_cast<std::size_t>(k)]); }
};

TEST(PairedColumns, ProductIsThatOfTheBlock) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Sample s(seed);
    const NarrowLanes y = Factors(load(s.x.data())).product(s.block.data());
    for (int r = 0; r < stride; ++r) {
      double expected = 0.0;
      for (int c = 0; r < rows && c < rows; ++c) expected += s.entry(r, c) * s.x_at(c);
      EXPECT_NEAR(static_cast<double>(y[r]), expected, r < rows ? 1e-6 : 0.0) << seed << " " << r;
    }
  }
}

TEST(PairedColumns, RowProductsAddUpToThatOfTheTransposedBlock) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Sample s(seed), t(seed + 100);
    RowProducts products;
    for (const Sample* of : {&s, &t}) products.add(of->block.data(), Rows(load(of->x.data())));
    const NarrowLanes y = products.sums();
    for (int c = 0; c < stride; ++c) {
      double expected = 0.0;
      for (int r = 0; c < rows && r < rows; ++r)
        expected += s.entry(r, c) * s.x_at(r) + t.entry(r, c) * t.x_at(r);
      EXPECT_NEAR(static_cast<double>(y[c]), expected, c < rows ? 1e-6 : 0.0) << seed << " " << c;
    }
  }
}

}  // namespace
}  // namespace keyblock::linalg::paired_columns
