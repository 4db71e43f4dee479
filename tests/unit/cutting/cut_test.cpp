#include "cutting/cut.h"

#include <gtest/gtest.h>

#include "tunnel.h"

namespace keyblock::cutting {
namespace {

TEST(Cut, TunnelOfThePaper) {
  for (int realization = 0; realization < 10; ++realization) {
    const BlockSystem system = cut(paper_tunnel(realization));
    EXPECT_GT(system.blocks.size(), 750u);
    EXPECT_LT(system.blocks.size(), 1100u);
    double sum = 0.0, inside = 0.0;
    for (const CutBlock& block : system.blocks) {
      sum += area(block.polygon);
      if (!block.excavations.empty()) inside += area(block.polygon);
    }
    EXPECT_NEAR(sum, 400.0, 1e-6);
    EXPECT_NEAR(inside, 32.0 * 2.75 * 2.75 * std::sin(std::numbers::pi / 32.0), 0.02);
  }
}

}  // namespace
}  // namespace keyblock::cutting
