#include "contact/detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <tuple>

#include "core/index.h"
#include "find_contacts.h"
#include "surface_builder.h"

namespace keyblock::contact {
namespace {

int count(const std::vector<Contact>& contacts, int a, int b) {
  return static_cast<int>(std::count_if(contacts.begin(), contacts.end(), [&](const Contact& c) {
    return (c.block_a == a && c.block_b == b) || (c.block_a == b && c.block_b == a);
  }));
}

// A spring that gets softer, as its joint gets shorter, keeps its energy where its offset has room for it; the rest is lost.
TEST(Detection, WhatASofterSpringCannotKeepIsLost) {
  Surface surface;
  const double depth = 1e-4;
  add_block(surface, rectangle(0, 0, 2, 1));
  add_block(surface, rectangle(0, 1 - depth, 2, 2));
  for (const double offset : {0.5 * depth, 0.25 * depth, 0.0}) {
    CandidateList list;
    const double k = find(surface, list).front().normal_stiffness;
    const auto stored_by = [](double stiffness, double x) { return 0.5 * stiffness * x * x; };
    for (Memory& memory : list.memory) {
      memory.stiffness = 4.0 * k;
      memory.offset = offset;
      memory.stored = stored_by(4.0 * k, depth - offset);
    }
    const double before = list.memory.front().stored;
    const Contact contact = find(surface, list).front();
    EXPECT_NEAR(contact.memory.stored, stored_by(k, contact.depth), 1e-12 * before) << offset;
    EXPECT_NEAR(contact.depth, std::min(2.0 * (depth - offset), depth), 1e-15);
    EXPECT_EQ(contact.memory.stored < before, offset < 0.5 * depth);
  }
}

// A tip so sharp that both its edges lie within 5° of the face below: only the lower one faces it.
TEST(Detection, ASharpTipFacesWithOneEdge) {
  for (const double degrees : {1.0, 3.0, 4.5, 6.0}) {
    Surface surface;
    add_block(surface, rectangle(-1, -1, 3, 0));
    add_block(surface, {{{0, 0}, {2, 0}, {2, 2 * std::tan(degrees * std::numbers::pi / 180.0)}}, {}});
    EXPECT_NEAR(total_length(find(surface), 0, 1), 2.0, 1e-12) << degrees;
  }
}

// The whole of either face of a sharp wedge lies on its seat, whatever the order in which blocks and vertices are given: at its tip, where
// both faces are one line to the corners of the seat, rounding may not choose between them.
TEST(Detection, ASharpWedgeLiesOnBothSidesOfItsSeat) {
  for (const double degrees : {0.5, 1.0, 1.5, 1.9, 2.5, 3.9}) {
    const double x = std::tan(0.5 * degrees * std::numbers::pi / 180.0);
    const Ring rings[] = {{{0, 0}, {x, 1}, {-x, 1}},
                          {{0, 0}, {-x, 1}, {-1, 1}, {-1, -1}, {0, -1}},
                          {{0, 0}, {0, -1}, {1, -1}, {1, 1}, {x, 1}}};
    std::array<int, 3> order{0, 1, 2};
    do {
      for (int start = 0; start < 3; ++start) {
        Surface surface;
        std::array<int, 3> place{};
        for (int k = 0; k < 3; ++k) {
          Ring ring = rings[order[at(k)]];
          std::rotate(ring.begin(), ring.begin() + start, ring.end());
          add_block(surface, {ring, {}});
          place[at(order[at(k)])] = k;
        }
        const auto contacts = find(surface);
        for (const int side : {1, 2})
          EXPECT_NEAR(total_length(contacts, place[0], place[at(side)]), std::hypot(1.0, x), 1e-6) << degrees;
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

// Faces that are a hair apart and at a small angle: each corner then misses the end of the other face by rounding alone.
TEST(Detection, CornersThatMeetUpToRoundingMeet) {
  const double apart = 1e-6, slope = 0.0174, miss = 0.5 * apart * slope;
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, {{{-miss, 1.0 + apart}, {1.0, 1.0 + apart + slope}, {1.0, 2.0}, {0.0, 2.0}}, {}});
  EXPECT_EQ(count(find(surface), 0, 1), 1);
}

TEST(Detection, CrossingJointsJoinFacesAndNotOppositeCorners) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, rectangle(1, 0, 2, 1));
  add_block(surface, rectangle(0, 1, 1, 2));
  add_block(surface, rectangle(1, 1, 2, 2));
  const auto contacts = find(surface);
  for (const auto& [a, b] : {std::pair{0, 1}, {2, 3}, {0, 2}, {1, 3}}) {
    EXPECT_EQ(count(contacts, a, b), 2) << a << b;
    EXPECT_NEAR(total_length(contacts, a, b), 1.0, 1e-12);
  }
  EXPECT_EQ(count(contacts, 0, 3), 0);
  EXPECT_EQ(count(contacts, 1, 2), 0);
}

TEST(Detection, JunctionOfThreeBlocks) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 2, 1));
  add_block(surface, rectangle(0, 1, 0.8, 2));
  add_block(surface, rectangle(0.8, 1, 2, 2));
  const auto contacts = find(surface);
  EXPECT_NEAR(total_length(contacts, 0, 1), 0.8, 1e-12);
  EXPECT_NEAR(total_length(contacts, 0, 2), 1.2, 1e-12);
  EXPECT_NEAR(total_length(contacts, 1, 2), 1.0, 1e-12);
  EXPECT_EQ(contacts.size(), 6u);
}

TEST(Detection, CornerOnCornerTakesTheShortestWayOut) {
  // The upper block's corner has passed that of the lower one: 20 µm deep in its top, 5 mm beyond its side.
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, {{{1.0 - 0.0005, 1.0 - 0.01}, {1.6, 0.8}, {1.9, 1.5}, {1.2, 1.8}}, {}});
  const auto contacts = find(surface);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal.x, 1.0, 1e-12);
  EXPECT_NEAR(contacts[0].gap, -0.0005, 1e-12);
}

// Two corners tip to tip: which side they pass cannot be told, unless both lines part them the same way, or nearly so. In a static step, where
// nothing has a velocity, each of the two lines holds them then: together they are the cone of normals.
TEST(Detection, CornersTipToTipMeetWhereTheirLinesAreAlike) {
  const auto contacts_of = [](double first, double last) {  // degrees, the upper corner's edges
    const auto direction = [](double degrees) {
      const double angle = degrees * std::numbers::pi / 180.0;
      return Vec2{std::cos(angle), std::sin(angle)};
    };
    const Vec2 flank = direction(57.0), tip = 2e-5 * Vec2{-flank.y, flank.x};
    Surface surface;
    add_block(surface, {{{0.0, 0.0}, {1.0, 0.0}, flank}, {}});
    add_block(surface, {{tip, tip + direction(first), tip + direction(last)}, {}});
    return find(surface).size();
  };
  EXPECT_EQ(contacts_of(66.0, 124.0), 1U) << "lines 9 degrees apart";
  EXPECT_EQ(contacts_of(110.0, 160.0), 2U) << "lines 53 degrees apart";
}

/// A wall of 64 crooked blocks: corners at all angles, small gaps and overlaps. Each row is shifted against the one below; without
/// shift four corners meet.
Surface crooked_wall(double shift, double crooked, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-crooked, crooked);
  Surface surface;
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 8; ++i) {
      const auto shaken = [&](double x, double y) { return Vec2{x + uniform(random), y + uniform(random)}; };
      const double x = i + shift * j, y = 0.4 * j;
      add_block(surface,
                {{shaken(x, y), shaken(x + 1, y), shaken(x + 1.3, y + 0.4), shaken(x + 0.3, y + 0.4)}, {}});
    }
  }
  return surface;
}

struct Seen {
  long contacts = 0, skipped = 0, steady = 0;
};

bool is_steady(const BlockPair& pair, const Surface& surface, const StepMotion& motion) {
  const std::size_t a = at(pair.block_a), b = at(pair.block_b);
  const auto first = [&](std::size_t block) { return at(surface.block_begin[block]); };
  const Vec2 now = surface.position[first(b)] - surface.position[first(a)] - pair.steady.apart,
             then = now + motion.predicted[first(b)] - motion.predicted[first(a)];
  return std::max(norm(now), norm(then)) + motion.path[a] + motion.path[b] + motion.predicted_path[a] +
                 motion.predicted_path[b] <=
             pair.steady.limit &&
         motion.reach[a] + motion.reach[b] <= pair.steady.reach;
}

/// Compares with looking at every candidate in every step. The whole wall sways.
void compare_with_oracle(Surface surface, std::mt19937& random, Seen& seen) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Tolerances tolerances(0.6);
  Candidates candidates(tolerances);
  Detection detection(tolerances, {JointLaw{}}, std::vector<double>(64, 1e9));
  ThreadTeam alone(1);
  CandidateList list;
  std::vector<double> way(64, 0.0);
  for (int step = 0; step < 200; ++step) {
    std::vector<double> reach(64, 0.0);
    for (double& r : reach) r = 1e-4 * std::abs(uniform(random));
    std::vector<double> turns;  // half the diameter of the blocks is 0.7 m
    for (const double r : reach) turns.push_back(r / 0.7);
    candidates.update(surface, reach, list, alone);
    // Where blocks go in this step.
    std::vector<Vec2> ahead(surface.position.size());
    std::vector<double> furthest(64, 0.0);
    for (std::size_t b = 0; b < 64; ++b) {
      const double pace = b % 9 == 0 ? 0.004 : b % 3 == 0 ? 0.0004 : 0.00001;
      const double turn = pace * uniform(random);
      const Vec2 shift =
          Vec2{1e-3 * std::sin(0.1 * step), 0.0} + Vec2{pace * uniform(random), pace * uniform(random)};
      for (std::size_t v = 4 * b; v < 4 * b + 4; ++v) {
        const Vec2 r = surface.position[v] - surface.position[4 * b], turned = turn * Vec2{-r.y, r.x};
        ahead[v] = shift + turned;
        furthest[b] = std::max(furthest[b], norm(turned));
      }
    }
    const StepMotion motion{reach, turns, candidates.away(), way, ahead, furthest};
    CandidateList all = list;
    for (Candidate& c : all.pairs) {
      seen.skipped += candidates.away()[at(c.block_a)] + candidates.away()[at(c.block_b)] < c.clearance;
      c.clearance = 0.0;
    }
    for (BlockPair& pair : all.block_pairs) {
      seen.steady += is_steady(pair, surface, motion);
      pair.steady.forget();
    }
    std::vector<Contact> fast, slow, again;
    detection.find(surface, motion, list, alone, fast);
    detection.find(surface, motion, all, alone, slow);
    detection.find(surface, motion, list, alone, again);  // as where a step is repeated
    ASSERT_EQ(fast.size(), slow.size()) << step;
    ASSERT_EQ(again.size(), slow.size()) << step;
    for (std::size_t k = 0; k < fast.size(); ++k) {
      for (const Contact& other : {fast[k], again[k]}) {
        EXPECT_EQ(other.candidate, slow[k].candidate);
        EXPECT_EQ(other.length, slow[k].length);
        EXPECT_EQ(other.memory.offset, slow[k].memory.offset);
        EXPECT_EQ(other.memory.normal_force, slow[k].memory.normal_force);
      }
      fast[k].memory.normal_force = uniform(random);  // tells what remembers what
    }
    seen.contacts += static_cast<long>(fast.size());
    keep_memory(fast, list, alone);
    for (std::size_t v = 0; v < ahead.size(); ++v) surface.position[v] += ahead[v];
    for (std::size_t b = 0; b < 64; ++b) way[b] += furthest[b];
  }
}

TEST(Detection, ClearancesAndSteadyPairsHideNoContact) {
  std::mt19937 random(11);
  Seen seen;
  for (const double shift : {0.3, 0.0}) {
    for (const double crooked : {0.012, 0.004, 0.0004, 0.00002}) {
      compare_with_oracle(crooked_wall(shift, crooked, random), random, seen);
    }
  }
  EXPECT_GT(seen.contacts, 60'000);
  EXPECT_GT(seen.skipped, seen.contacts);  // most candidates are no contacts, and known not to be
  EXPECT_GT(seen.steady, 50'000);          // that they sway together does not count
}

// As many contacts are not the same ones.
TEST(Detection, KnowsWhetherContactsAreThoseOfBefore) {
  Surface surface;
  for (int k = 0; k < 4; ++k) add_block(surface, rectangle(k, 0.0, k + 1.0, 1.0), true);
  add_block(surface, rectangle(0.3, 1.0, 1.3, 2.0));
  const Tolerances tolerances(1.0);
  const std::vector<double> still(5, 0.0);
  ThreadTeam alone(1);
  Detection detection(tolerances, {JointLaw{}}, std::vector<double>(5, 1e9));
  std::vector<Contact> contacts;
  const auto find = [&](double shift) {
    for (std::size_t v = 16; v < 20; ++v) surface.position[v].x += shift;
    Candidates candidates(tolerances);
    CandidateList list;
    candidates.update(surface, still, list, alone);
    const std::size_t before = contacts.size();
    contacts.resize(detection.find_which(surface, {still, still, candidates.away(), still}, list, alone));
    std::size_t described = 0;
    const bool same =
        detection.describe(surface, list, alone, contacts, [&](std::size_t first, std::size_t last) {
          EXPECT_EQ(first, described);
          for (; described < last; ++described) EXPECT_GT(contacts[described].length, 0.0);
        });
    EXPECT_EQ(described, contacts.size());
    return std::pair(same, contacts.size() == before);
  };
  EXPECT_EQ(find(0.0), std::pair(false, false));
  EXPECT_EQ(find(0.1), std::pair(true, true));
  EXPECT_EQ(find(1.0), std::pair(false, true));
  EXPECT_EQ(find(0.0), std::pair(true, true));
}

TEST(Detection, MemoryMovesOverWhenVertexAndEdgeChangeSides) {
  CandidateList list;
  Contact last;
  double shear = 0.0;
  for (int step = 0; step <= 20; ++step) {
    Surface surface;
    const double shift = -0.01 + 0.001 * step;  // the upper block's end slides past that of the lower one
    add_block(surface, rectangle(0, 0, 1, 1));
    add_block(surface, rectangle(-1.0 + shift, 1, 1.0 + shift, 2));
    const auto contacts = find(surface, list);
    ASSERT_EQ(contacts.size(), 2u) << step;
    const auto right =
        std::max_element(contacts.begin(), contacts.end(), [&](const Contact& x, const Contact& y) {
          return surface.position[static_cast<std::size_t>(x.vertex)].x <
                 surface.position[static_cast<std::size_t>(y.vertex)].x;
        });
    const int place = CandidateList::Finder(list, 0)(static_cast<std::size_t>(right->candidate));
    ASSERT_GE(place, 0);
    Memory& memory = list.memory[static_cast<std::size_t>(place)];
    if (step > 0) {
      EXPECT_EQ(memory.shear, shear) << step;
    }
    shear = memory.shear = 1.0 + step;
    last = *right;
  }
  EXPECT_EQ(last.block_a, 0);  // at last it is the lower block's corner under the upper one's face
}

TEST(Detection, VertexThatSlipsPastAConcaveCornerIsKept) {
  // An L; a block nested in its corner has slipped 3 mm past the corner point.
  Surface surface;
  add_block(surface, {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, {}}, true);
  add_block(surface, rectangle(1.0 - 0.003, 1.0 - 0.003, 2, 2));
  const auto contacts = find(surface);
  bool floor = false, side = false;
  for (const Contact& c : contacts) {
    if (surface.position[static_cast<std::size_t>(c.vertex)] != Vec2{1.0 - 0.003, 1.0 - 0.003}) continue;
    floor = floor || c.normal.y > 0.5;
    side = side || c.normal.x > 0.5;
  }
  EXPECT_TRUE(floor);
  EXPECT_TRUE(side);
}

TEST(Detection, FacesDeepInEachOtherAreKept) {
  for (const double shift : {0.0, 0.001, 0.005}) {  // m; deeper than far from their ends
    Surface surface;
    add_block(surface, rectangle(0, 0, 1, 1));
    add_block(surface, rectangle(shift, 0.99, 1.0 + shift, 1.99));
    const auto contacts = find(surface);
    EXPECT_EQ(contacts.size(), 2u) << shift;
    for (const Contact& c : contacts) EXPECT_NEAR(std::abs(c.normal.y), 1.0, 1e-12) << shift;
  }
}

TEST(Detection, VerticesBesideOneThatPressesDeepMeetTheFace) {
  // A triangle lies on its vertex 4; vertex 5 comes to the floor. Its edge to vertex 4 lies inside the floor by 6°.
  const auto contacts_at = [](double depth, CandidateList& list) {
    Surface surface;
    add_block(surface, rectangle(-2, -1, 2, 0), true);
    add_block(surface, {{{0.0, -depth}, {0.5, 0.001}, {0.2, 0.8}}, {}});
    return find(surface, list);
  };
  for (const double stretch : {0.0, 0.002, 0.004, 0.05}) {  // m; the end zone is 0.003 m
    CandidateList list;
    ASSERT_EQ(contacts_at(0.02, list).size(), 1u);
    list.memory[0].stiffness = 1e7;
    list.memory[0].normal_force = 1e7 * stretch;
    list.memory[0].offset = 0.0;
    const auto contacts = contacts_at(0.05, list);
    const bool meets =
        std::ranges::any_of(contacts, [](const Contact& c) { return c.vertex == 5 && c.normal.y > 0.9; });
    EXPECT_EQ(meets, stretch > 0.003) << stretch;
  }
}

TEST(Detection, BornPenetratedContactsGetAnOffsetThatOnlyShrinks) {
  CandidateList list;
  const auto upper_at = [&](double y) {
    Surface surface;
    add_block(surface, rectangle(0, 0, 2, 1), true);
    add_block(surface, rectangle(0.5, y, 1.5, y + 1));
    return find(surface, list);
  };
  for (const Contact& c : upper_at(0.998)) EXPECT_NEAR(c.depth, 0.0, 1e-15);
  for (const Contact& c : upper_at(0.999)) EXPECT_NEAR(c.depth, 0.0, 1e-12);
  for (const Contact& c : upper_at(0.9985)) EXPECT_NEAR(c.depth, 0.0005, 1e-12);
}

}  // namespace
}  // namespace keyblock::contact
