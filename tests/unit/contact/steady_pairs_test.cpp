#include "contact/steady_pairs.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "contact/contact_choice.h"
#include "corner_scene.h"

namespace keyblock::contact {
namespace {

/// Candidates that are contacts, as (vertex, edge), ascending; and what is known of how long they stay so.
struct Chosen {
  std::vector<std::pair<int, int>> contacts;
  SteadyContacts steady;
};

/// last: the contacts of the last step.
Chosen choose(const Surface& surface, const SteadyPairs& steady_pairs = {},
              const std::vector<std::pair<int, int>>& last = {}) {
  CornerScene scene(surface);
  Chosen chosen;
  if (scene.list.block_pairs.empty()) return chosen;
  scene.list.make_room(last.size());
  for (std::size_t k = 0; k < last.size(); ++k)
    scene.list.track(k, scene.candidate_of(last[k].first, last[k].second));
  std::vector<Competitor> all = scene.competitors(0);
  BlockPair pair = scene.list.block_pairs[0];
  choose_contacts(steady_pairs, scene.view(), scene.list.pairs.size(), all, pair);
  for (const Competitor& c : all) {
    if (c.candidate >= 0)
      chosen.contacts.emplace_back(scene.view().candidate(c).vertex, scene.view().candidate(c).edge);
  }
  chosen.steady = pair.steady;
  return chosen;
}

Surface one_on_other(double shift, double gap, double tilt) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface,
            {{{shift, 1.0 + gap}, {1.0 + shift, 1.0 + gap + tilt}, {1.0 + shift, 2.0}, {shift, 2.0}}, {}});
  return surface;
}

// Moves within the margin, by both blocks together, leave the contacts as they are.
TEST(SteadyPairs, ContactsStayWithinTheMargin) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int steady = 0, moves = 0;
  for (int k = 0; k < 300; ++k) {
    const Surface surface =
        one_on_other(0.5 * uniform(random) * std::pow(10.0, -3.0 * std::abs(uniform(random))),
                     1e-3 * uniform(random), 1e-2 * uniform(random));
    const Chosen before = choose(surface);
    if (before.steady.limit < 0.0) continue;
    ++steady;
    for (int move = 0; move < 10; ++move, ++moves) {
      // How far the first vertex goes, and how far others go against it, add up to the margin at most.
      const double turn = 0.49 * before.steady.limit / std::hypot(1.0, 1.0) * uniform(random);
      const double angle = 3.2 * uniform(random), far = 0.49 * before.steady.limit;
      Surface moved = surface;
      for (std::size_t v = 4; v < 8; ++v) {
        const Vec2 r = surface.position[v] - surface.position[4];
        moved.position[v] += far * Vec2{std::cos(angle), std::sin(angle)} + turn * Vec2{-r.y, r.x};
      }
      EXPECT_EQ(choose(moved, {}, before.contacts).contacts, before.contacts) << k;
    }
  }
  EXPECT_GT(steady, 50);
}

TEST(SteadyPairs, KnowTheContactsTheyKeep) {
  const Surface surface = one_on_other(0.3, 0.0, 0.0);
  const Chosen chosen = choose(surface);
  ASSERT_GT(chosen.steady.limit, 0.0);
  EXPECT_EQ(std::popcount(chosen.steady.contacts), static_cast<int>(chosen.contacts.size()));
  EXPECT_EQ(chosen.steady.at_corner, 0U);
  EXPECT_EQ(chosen.steady.apart, (Vec2{0.3, 1.0}));
}

/// Two blocks for which `steady` is known, and a step in which they may move.
struct Pair {
  Surface surface = one_on_other(0.3, 0.0, 0.0);
  BlockPair pair{0, 0, 1, choose(surface).steady};
  std::vector<double> reach{0.0, 0.0}, path{0.0, 0.0}, predicted_path{0.0, 0.0};
  std::vector<Vec2> predicted = std::vector<Vec2>(8);
  [[nodiscard]] bool is_steady(const SteadyPairs& steady_pairs = {}) const {
    return steady_pairs.is_steady(surface, {reach, reach, reach, path, predicted, predicted_path}, pair);
  }
};

TEST(SteadyPairs, EndWhereMotionUsesUpTheMargin) {
  const Pair still;
  const double limit = still.pair.steady.limit;
  EXPECT_TRUE(still.is_steady());
  Pair both = still;  // the rock sways
  for (Vec2& p : both.surface.position) p += Vec2{10.0 * limit, 0.0};
  for (Vec2& p : both.predicted) p = {0.0, 10.0 * limit};
  EXPECT_TRUE(both.is_steady());
  for (const double share : {0.9, 1.1}) {
    const bool stays = share < 1.0;
    Pair moved = still, turned = still, will_move = still, will_turn = still;
    for (std::size_t v = 4; v < 8; ++v) {
      moved.surface.position[v].x += share * limit;
      will_move.predicted[v].x = share * limit;
    }
    turned.path[1] = share * limit;
    will_turn.predicted_path[0] = share * limit;
    EXPECT_EQ(moved.is_steady(), stays) << share;
    EXPECT_EQ(turned.is_steady(), stays) << share;
    EXPECT_EQ(will_move.is_steady(), stays) << share;
    EXPECT_EQ(will_turn.is_steady(), stays) << share;
  }
}

TEST(SteadyPairs, EndWhereBlocksReachFurther) {
  Pair pair;
  pair.reach[0] = 1.1 * pair.pair.steady.reach + 1e-12;
  EXPECT_FALSE(pair.is_steady());
}

TEST(SteadyPairs, SwitchedOffKnowNothing) {
  SteadyPairs off;
  off.switch_off();
  EXPECT_FALSE(Pair().is_steady(off));
  const Surface surface = one_on_other(0.3, 0.0, 0.0);
  const Chosen chosen = choose(surface, off);
  EXPECT_EQ(chosen.contacts, choose(surface).contacts);
  EXPECT_LT(chosen.steady.limit, 0.0);
}

// Corners whose contact hangs on a hair are not steady, and tried again some steps later.
TEST(SteadyPairs, WaitWhereTheMarginIsSmall) {
  const Surface surface = one_on_other(0.0, Tolerances(1.0).activation * (1.0 - 1e-12), 0.0);
  CornerScene scene(surface);
  const std::vector<double> reach(2, 1e-6);
  scene.motion.reach = reach;
  std::vector<Competitor> all = scene.competitors(0);
  BlockPair pair = scene.list.block_pairs[0];
  choose_contacts(SteadyPairs(), scene.view(), scene.list.pairs.size(), all, pair);
  EXPECT_LT(pair.steady.limit, 0.0);
  const int wait = pair.steady.wait;
  EXPECT_GT(wait, 1);
  all = scene.competitors(0);
  choose_contacts(SteadyPairs(), scene.view(), scene.list.pairs.size(), all, pair);
  EXPECT_EQ(pair.steady.wait, wait - 1);
}

}  // namespace
}  // namespace keyblock::contact
