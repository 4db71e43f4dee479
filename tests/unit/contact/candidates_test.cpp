#include "contact/candidates.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "surface_builder.h"

namespace keyblock::contact {
namespace {

std::set<std::pair<int, int>> keys(const CandidateList& list) {
  std::set<std::pair<int, int>> set;
  for (const Candidate& c : list.pairs) set.insert({c.vertex, c.edge});
  return set;
}

Surface wall(int columns, int rows) {
  Surface surface;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i)
      add_block(surface, rectangle(i + 0.5 * (j % 2), 0.5 * j, i + 0.5 * (j % 2) + 1.0, 0.5 * j + 0.5));
  }
  return surface;
}

TEST(Candidates, ContainEveryNearPairWhileBlocksMove) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Surface surface = wall(8, 6);
  const Tolerances tolerances(0.7);
  Candidates candidates(tolerances);
  CandidateList list;
  const std::vector<double> reach(static_cast<std::size_t>(surface.blocks()), 1e-3);
  for (int step = 0; step < 60; ++step) {
    candidates.update(surface, reach, list);
    const auto have = keys(list);
    for (const Candidate& c : all_pairs_within(surface, tolerances.activation + 2e-3)) {
      EXPECT_TRUE(have.contains({c.vertex, c.edge})) << step << ": " << c.vertex << ' ' << c.edge;
    }
    for (int b = 0; b < surface.blocks(); ++b) {
      const double pace = b % 7 == 0 ? 0.03 : 0.001;  // a few blocks run, the others creep
      const Vec2 motion{pace * uniform(random), pace * uniform(random)};
      for (int v = surface.block_begin[static_cast<std::size_t>(b)];
           v < surface.block_begin[static_cast<std::size_t>(b) + 1]; ++v) {
        surface.position[static_cast<std::size_t>(v)] += motion;
      }
    }
  }
}

TEST(Candidates, KeepTheMemoryOfThoseThatStay) {
  Surface surface = wall(3, 2);
  Candidates candidates(Tolerances(0.7));
  CandidateList list;
  const std::vector<double> reach(static_cast<std::size_t>(surface.blocks()), 0.0);
  candidates.update(surface, reach, list);
  for (std::size_t k = 0; k < list.memory.size(); ++k) list.memory[k].slip = static_cast<double>(k + 1);
  const CandidateList before = list;
  candidates.invalidate();
  EXPECT_FALSE(candidates.update(surface, reach, list));  // the same
  ASSERT_EQ(list.pairs.size(), before.pairs.size());
  for (std::size_t k = 0; k < list.memory.size(); ++k) EXPECT_EQ(list.memory[k].slip, before.memory[k].slip);
}

TEST(Candidates, IgnoreAbsentAndPairsOfFixedBlocks) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1), true);
  add_block(surface, rectangle(1, 0, 2, 1), true);
  add_block(surface, rectangle(0, 1, 1, 2));
  surface.present[2] = 0;
  Candidates candidates(Tolerances(1.0));
  CandidateList list;
  candidates.update(surface, std::vector<double>(3, 0.0), list);
  EXPECT_TRUE(list.pairs.empty());
}

}  // namespace
}  // namespace keyblock::contact
