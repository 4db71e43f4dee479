#include "cutting/local_size.h"

#include <gtest/gtest.h>

#include "check_blocks.h"
#include "cutting/cut.h"

namespace keyblock::cutting {
namespace {

/// Joints that bound n × n squares with the corner `at`, in a square domain.
CutInput patch(double domain, Vec2 at, double side, int n) {
  CutInput input;
  input.domain = {{0, 0}, {domain, 0}, {domain, domain}, {0, domain}};
  const double over = 0.3 * side;
  for (int k = 0; k <= n; ++k) {
    const double x = at.x + k * side, y = at.y + k * side, end = n * side + over;
    input.traces.push_back({{x, at.y - over}, {x, at.y + end}, {}});
    input.traces.push_back({{at.x - over, y}, {at.x + end, y}, {}});
  }
  return input;
}

TEST(LocalSize, SmallBlocksOfALargeDomainAreKept) {
  // With the limits of the domain alone 241, all and all of them would go: the squares are below its sliver area, its sliver
  // thickness and its cluster distance.
  for (const double side : {0.3, 0.1, 0.03}) {
    const BlockSystem system = cut(patch(200.0, {97.0, 97.0}, side, 19));
    EXPECT_EQ(system.blocks.size(), 362U) << side;
    EXPECT_EQ(system.statistics.merged_slivers, 0) << side;
  }
}

TEST(LocalSize, FewSmallBlocksAreKept) {
  EXPECT_EQ(cut(patch(200.0, {97.0, 97.0}, 0.2, 3)).blocks.size(), 10U);
}

TEST(LocalSize, PatchesAreJudgedEachByItself) {
  CutInput input = patch(200.0, {50.0, 50.0}, 0.3, 10);
  const CutInput finer = patch(200.0, {120.0, 120.0}, 0.05, 10);
  input.traces.insert(input.traces.end(), finer.traces.begin(), finer.traces.end());
  EXPECT_EQ(cut(input).blocks.size(), 201U);
}

// Every joint was digitised twice, 2 mm apart: strips and crossings are three faces in four.
TEST(LocalSize, SliversBetweenBlocksAreMerged) {
  const CutInput once = patch(20.0, {5.0, 5.0}, 0.5, 12);
  CutInput twice = once;
  for (const rockmass::Trace& trace : once.traces)
    twice.traces.push_back({trace.a + Vec2{0.002, 0.002}, trace.b + Vec2{0.002, 0.002}, {}});
  const BlockSystem system = cut(twice);
  EXPECT_EQ(system.blocks.size(), cut(once).blocks.size());
  EXPECT_GT(system.statistics.merged_slivers, 100);
}

TEST(LocalSize, AToleranceThatIsGivenHoldsEverywhere) {
  CutInput input = patch(200.0, {97.0, 97.0}, 0.3, 19);
  input.tolerances = CutTolerances::for_domain(200.0 * 200.0);
  input.tolerances->sliver_area_is_given = true;
  const BlockSystem system = cut(input);
  EXPECT_EQ(system.blocks.size(), 121U);
  EXPECT_EQ(system.statistics.merged_slivers, 241);
}

}  // namespace
}  // namespace keyblock::cutting
