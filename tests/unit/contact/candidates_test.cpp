#include "contact/candidates.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
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
  ThreadTeam alone(1);
  CandidateList list;
  const std::vector<double> reach(static_cast<std::size_t>(surface.blocks()), 1e-3);
  for (int step = 0; step < 60; ++step) {
    candidates.update(surface, reach, list, alone);
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
  ThreadTeam alone(1);
  CandidateList list;
  const std::vector<double> reach(static_cast<std::size_t>(surface.blocks()), 0.0);
  candidates.update(surface, reach, list, alone);
  for (int k = 0; k < static_cast<int>(list.pairs.size()); k += 3) {
    list.tracked.push_back(k);
    list.memory.emplace_back().shear = k + 1.0;
  }
  const CandidateList before = list;
  const auto expect_kept = [&] {
    for (std::size_t k = 0; k < before.tracked.size(); ++k) {
      const Candidate& c = before.pairs[static_cast<std::size_t>(before.tracked[k])];
      const auto now = std::find_if(list.pairs.begin(), list.pairs.end(), [&](const Candidate& other) {
        return other.vertex == c.vertex && other.edge == c.edge;
      });
      ASSERT_NE(now, list.pairs.end());
      const int place = CandidateList::Finder(list, 0)(static_cast<std::size_t>(now - list.pairs.begin()));
      ASSERT_GE(place, 0);
      EXPECT_EQ(list.memory[static_cast<std::size_t>(place)].shear, before.memory[k].shear);
    }
  };
  candidates.invalidate();
  EXPECT_FALSE(candidates.update(surface, reach, list, alone));  // the same
  ASSERT_EQ(list.pairs.size(), before.pairs.size());
  expect_kept();
  std::vector<double> faster = reach;
  faster[1] = 0.5;  // sees more of its neighbours
  EXPECT_TRUE(candidates.update(surface, faster, list, alone));
  EXPECT_GT(list.pairs.size(), before.pairs.size());
  EXPECT_EQ(list.memory.size(), before.memory.size());
  expect_kept();
}

// Where few blocks are looked at anew only their pairs are gone through: with the list that going through all of it gives. Stones far away
// make the few of the same wall a small share of the blocks.
TEST(Candidates, OfFewBlocksAreThoseOfGoingThroughAll) {
  constexpr int bricks = 48, stones = 400;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Surface alone = wall(8, 6), among_stones = alone;
  for (int k = 0; k < stones; ++k)
    add_block(among_stones, rectangle(100.0 + 3.0 * k, 0.0, 101.0 + 3.0 * k, 1.0));
  const Tolerances tolerances(0.7);
  struct Looked {
    Candidates candidates;
    CandidateList list;
  } all{Candidates(tolerances), {}}, few{Candidates(tolerances), {}};
  ThreadTeam team(1);
  int changes = 0, held = 0;
  for (int step = 0; step < 80; ++step) {
    const auto update = [&](const Surface& surface, Looked& looked) {
      const std::vector<double> reach(static_cast<std::size_t>(surface.blocks()), 1e-3);
      return looked.candidates.update(surface, reach, looked.list, team);
    };
    const bool changed = update(alone, all);
    ASSERT_EQ(update(among_stones, few), changed) << step;
    changes += changed ? 1 : 0;
    ASSERT_EQ(few.list.pairs.size(), all.list.pairs.size()) << step;
    for (std::size_t k = 0; k < all.list.pairs.size(); ++k) {
      const Candidate &c = few.list.pairs[k], &expected = all.list.pairs[k];
      EXPECT_TRUE(c.vertex == expected.vertex && c.edge == expected.edge) << step << ' ' << k;
      EXPECT_EQ(c.clearance, expected.clearance) << step << ' ' << k;
    }
    EXPECT_EQ(few.list.tracked, all.list.tracked) << step;
    ASSERT_EQ(few.list.block_pairs.size(), all.list.block_pairs.size()) << step;
    for (std::size_t p = 0; p < all.list.block_pairs.size(); ++p)
      EXPECT_EQ(few.list.block_pairs[p].steady.limit, all.list.block_pairs[p].steady.limit)
          << step << ' ' << p;
    for (Looked* looked : {&all, &few}) {
      // Half of them hold, and stay however far they go.
      looked->list.make_room(looked->list.pairs.size() / 3);
      for (std::size_t k = 0; k < looked->list.tracked.size(); ++k) {
        looked->list.tracked[k] = static_cast<int>(3 * k);
        looked->list.memory[k].normal_force = k % 2 == 0 ? 1.0 : 0.0;
      }
      for (BlockPair& pair : looked->list.block_pairs) pair.steady.limit = 1.0;
    }
    held += static_cast<int>(all.list.tracked.size());
    const double pace = step % 2 == 0 ? 0.03 : 0.003;
    for (int b = step % 7; b < bricks; b += 7) {
      const Vec2 motion{pace * uniform(random), pace * uniform(random)};
      for (Surface* surface : {&alone, &among_stones}) {
        for (int v = surface->block_begin[static_cast<std::size_t>(b)];
             v < surface->block_begin[static_cast<std::size_t>(b) + 1]; ++v)
          surface->position[static_cast<std::size_t>(v)] += motion;
      }
    }
  }
  EXPECT_GT(changes, 20);
  EXPECT_LT(changes, 80);
  EXPECT_GT(held, 80 * 20);
}

/// bytes, the most that this process has had.
long most_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024 * usage.ru_maxrss;
}

// Stones that have rolled far away: cells over all the way between would be many more than there are blocks.
TEST(Candidates, OfBlocksFarAwayTakeNoMore) {
  const Surface near = wall(8, 6);
  ThreadTeam alone(1);
  CandidateList expected;
  const std::vector<double> reach(static_cast<std::size_t>(near.blocks()) + 2, 1e-3);
  Candidates(Tolerances(0.7))
      .update(near, std::span(reach).first(near.block_begin.size() - 1), expected, alone);
  const auto of_wall = [&](const Candidate& c) {
    return c.block_a < near.blocks() && c.block_b < near.blocks();
  };
  const auto same = [](const Candidate& a, const Candidate& b) {
    return a.vertex == b.vertex && a.edge == b.edge;
  };
  for (const Vec2 far : {Vec2{1e4, 1e4}, {-1e4, 1e4}, {1e4, 0.0}, {1e12, -1e4}}) {
    Surface surface = near;
    add_block(surface, rectangle(far.x, far.y, far.x + 1.0, far.y + 0.5));
    add_block(surface, rectangle(far.x + 1.0, far.y, far.x + 2.0, far.y + 0.5));
    const long before = most_memory();
    CandidateList list;
    Candidates(Tolerances(0.7)).update(surface, reach, list, alone);
    EXPECT_LT(most_memory() - before, 50'000'000) << far.x << ", " << far.y;
    const auto end = std::stable_partition(list.pairs.begin(), list.pairs.end(), of_wall);
    EXPECT_TRUE(std::equal(list.pairs.begin(), end, expected.pairs.begin(), expected.pairs.end(), same));
    EXPECT_GE(list.pairs.end() - end, 4);  // of the two with each other
    const auto have = keys(list);
    for (const Candidate& c : all_pairs_within(surface, Tolerances(0.7).activation + 2e-3))
      EXPECT_TRUE(have.contains({c.vertex, c.edge})) << c.vertex << ' ' << c.edge;
  }
}

TEST(Candidates, IgnoreAbsentAndPairsOfFixedBlocks) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1), true);
  add_block(surface, rectangle(1, 0, 2, 1), true);
  add_block(surface, rectangle(0, 1, 1, 2));
  surface.present[2] = 0;
  Candidates candidates(Tolerances(1.0));
  ThreadTeam alone(1);
  CandidateList list;
  candidates.update(surface, std::vector<double>(3, 0.0), list, alone);
  EXPECT_TRUE(list.pairs.empty());
}

}  // namespace
}  // namespace keyblock::contact
