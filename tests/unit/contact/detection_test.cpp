#include "contact/detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "core/index.h"
#include "surface_builder.h"

namespace keyblock::contact {
namespace {

/// Contacts of a surface as it stands; `list` keeps the memory between calls.
std::vector<Contact> find(const Surface& surface, CandidateList& list) {
  const Tolerances tolerances(1.0);
  Candidates candidates(tolerances);
  const std::vector<double> still(static_cast<std::size_t>(surface.blocks()), 0.0);
  ThreadTeam alone(1);
  candidates.update(surface, still, list, alone);
  Detection detection(tolerances, {JointLaw{}},
                      std::vector<double>(static_cast<std::size_t>(surface.blocks()), 1e9));
  std::vector<Contact> contacts;
  detection.find(surface, {still, still, candidates.away()}, list, alone, contacts);
  keep_memory(contacts, list, alone);
  return contacts;
}

std::vector<Contact> find(const Surface& surface) {
  CandidateList list;
  return find(surface, list);
}

double total_length(const std::vector<Contact>& contacts, int a, int b) {
  double sum = 0.0;
  for (const Contact& c : contacts) {
    if ((c.block_a == a && c.block_b == b) || (c.block_a == b && c.block_b == a)) sum += c.length;
  }
  return sum;
}

int count(const std::vector<Contact>& contacts, int a, int b) {
  return static_cast<int>(std::count_if(contacts.begin(), contacts.end(), [&](const Contact& c) {
    return (c.block_a == a && c.block_b == b) || (c.block_a == b && c.block_b == a);
  }));
}

TEST(Detection, EdgeToEdgeIsTwoContactsThatShareItsLengthOnce) {
  // Equal faces, a block inside a longer face, and one that overhangs it.
  for (const auto& [x0, x1, shared] :
       {std::tuple{0.0, 2.0, 2.0}, {0.5, 1.25, 0.75}, {1.5, 2.5, 0.5}, {-0.5, 0.25, 0.25}}) {
    Surface surface;
    add_block(surface, rectangle(0, 0, 2, 1));
    add_block(surface, rectangle(x0, 1, x1, 2));
    const auto contacts = find(surface);
    EXPECT_EQ(contacts.size(), 2u) << x0;
    EXPECT_NEAR(total_length(contacts, 0, 1), shared, 1e-12) << x0;
    for (const Contact& c : contacts) EXPECT_NEAR(std::abs(c.normal.y), 1.0, 1e-12);
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

// Oracle: without clearances every candidate is looked at in every step.
TEST(Detection, ClearanceHidesNoContact) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Surface surface;
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 8; ++i) {  // a crooked wall: corners at all angles, small gaps and overlaps
      const auto shaken = [&](double x, double y) {
        return Vec2{x + 0.004 * uniform(random), y + 0.004 * uniform(random)};
      };
      const double x = i + 0.3 * j, y = 0.4 * j;
      add_block(surface,
                {{shaken(x, y), shaken(x + 1, y), shaken(x + 1.3, y + 0.4), shaken(x + 0.3, y + 0.4)}, {}});
    }
  }
  const Tolerances tolerances(0.6);
  Candidates candidates(tolerances);
  Detection detection(tolerances, {JointLaw{}}, std::vector<double>(64, 1e9));
  ThreadTeam alone(1);
  CandidateList list;
  long skipped = 0, found = 0;
  for (int step = 0; step < 200; ++step) {
    std::vector<double> reach(64, 0.0);
    for (double& r : reach) r = 1e-4 * std::abs(uniform(random));
    std::vector<double> turns;  // half the diameter of the blocks is 0.7 m
    for (const double r : reach) turns.push_back(r / 0.7);
    candidates.update(surface, reach, list, alone);
    CandidateList all = list;
    for (Candidate& c : all.pairs) {
      skipped += candidates.away()[at(c.block_a)] + candidates.away()[at(c.block_b)] < c.clearance;
      c.clearance = 0.0;
    }
    std::vector<Contact> fast, slow;
    detection.find(surface, {reach, turns, candidates.away()}, list, alone, fast);
    detection.find(surface, {reach, turns, candidates.away()}, all, alone, slow);
    ASSERT_EQ(fast.size(), slow.size()) << step;
    for (std::size_t k = 0; k < fast.size(); ++k) {
      EXPECT_EQ(fast[k].candidate, slow[k].candidate);
      EXPECT_EQ(fast[k].memory.offset, slow[k].memory.offset);
    }
    found += static_cast<long>(fast.size());
    keep_memory(fast, list, alone);
    for (int b = 0; b < 64; ++b) {
      const double pace = b % 9 == 0 ? 0.004 : 0.0004, turn = pace * uniform(random);
      const Vec2 motion{pace * uniform(random), pace * uniform(random)}, centre = surface.position[at(4 * b)];
      for (int v = 4 * b; v < 4 * b + 4; ++v) {
        const Vec2 r = surface.position[at(v)] - centre;
        surface.position[at(v)] += motion + turn * Vec2{-r.y, r.x};
      }
    }
  }
  EXPECT_GT(found, 10'000);
  EXPECT_GT(skipped, found);  // most candidates are no contacts, and known not to be
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
