// How much of a joint belongs to a contact, and what law it has by that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include "contact/edge_curve.h"
#include "core/index.h"
#include "find_contacts.h"
#include "surface_builder.h"

namespace keyblock::contact {
namespace {

TEST(JointLength, EdgeToEdgeIsTwoContactsThatShareItsLengthOnce) {
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

/// A block from (x0, y0) to (x1, y1) whose lower and upper edges have vertices that divide them into so many parts.
Polygon divided(double x0, double y0, double x1, double y1, int parts) {
  Ring ring;
  for (int k = 0; k < parts; ++k) ring.push_back({x0 + (x1 - x0) * k / parts, y0});
  for (int k = 0; k < parts; ++k) ring.push_back({x1 + (x0 - x1) * k / parts, y1});
  ring.insert(ring.begin() + parts, {x1, y0});
  ring.push_back({x0, y1});
  return {ring, {}};
}

// Edges that are divided at the same points, as those of blocks of the same order are: where two vertices meet one contact is left.
TEST(JointLength, DividedEdgesShareTheLengthOfTheirJoint) {
  for (const auto& [below, above] : {std::pair{1, 1}, {2, 2}, {3, 3}, {6, 6}, {2, 1}, {2, 4}, {3, 2}}) {
    for (const double shift : {0.0, 0.001, -0.001, 0.01, 0.1}) {
      Surface surface;
      add_block(surface, divided(0, 0, 1, 1, below));
      add_block(surface, divided(shift, 1, 1 + shift, 2, above));
      const auto contacts = find(surface);
      // Less than the end zone, 3 mm, counts as none, at each vertex.
      const double lost = std::abs(shift) < 0.003 ? 0.5 * std::abs(shift) * std::max(below, above) : 0.0;
      EXPECT_NEAR(total_length(contacts, 0, 1), 1.0 - std::abs(shift), lost + 1e-12)
          << below << " and " << above << " shifted by " << shift;
    }
  }
}

/// A block as divided(), whose lower and upper edges are those of a block of order 2 where they have two parts: with the shares that make
/// the weights of Simpson's rule.
void add_divided(Surface& surface, double x0, double y0, double x1, double y1, int parts) {
  static const EdgeDivision in_one({0.0, 1.0}), in_two({0.0, 0.5, 1.0});
  const int first = surface.vertices();
  add_block(surface, divided(x0, y0, x1, y1, parts));
  for (int v = first; v < surface.vertices();) {
    const bool in_parts = parts == 2 && std::abs(surface.position[at(v)].y -
                                                 surface.position[at(surface.next[at(v)])].y) < 1e-9;
    const int pieces = in_parts ? 2 : 1;
    for (int piece = 0; piece < pieces; ++piece) {
      surface.divided.push_back({v, pieces, in_parts ? &in_two : &in_one});
      surface.start_share.push_back(!in_parts ? 0.5 : piece == 0 ? 1.0 / 3.0 : 2.0 / 3.0);
    }
    v += pieces;
  }
}

// Where an edge is shared as a whole, its vertices have the shares that the surface gives them. The other side may be divided alike or not
// at all.
TEST(JointLength, VerticesOfDividedEdgesHaveTheirWeights) {
  for (const int above : {1, 2}) {
    for (const double shift : {0.0, 0.001}) {
      Surface surface;
      add_divided(surface, -1, 0, 2, 1, 1);
      add_divided(surface, 0, 1, 1, 2, 2);
      add_divided(surface, shift, 2, 1 + shift, 3, above);
      for (const Contact& c : find(surface)) {
        const double x = surface.position[at(c.vertex)].x;
        const double expected = std::abs(x - 0.5) < 0.1 ? 4.0 / 6.0 : 1.0 / 6.0;
        EXPECT_NEAR(c.length, expected, c.block_b == 2 || c.block_a == 2 ? shift + 1e-12 : 1e-12) << x;
      }
    }
  }
}

// Where vertices of the one side lie within pieces of the other, too: what presses evenly presses in the middle.
TEST(JointLength, DividedEdgesAreHeldEvenly) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> beyond(0.05, 2.0);
  for (const auto& [below, above] : {std::pair{2, 2}, {2, 1}, {1, 2}}) {
    for (int k = 0; k < 20; ++k) {
      Surface surface;
      add_divided(surface, -beyond(random), 0, 1 + beyond(random), 1, below);
      add_divided(surface, 0, 1, 1, 2, above);
      double stiffness = 0.0, moment = 0.0;
      for (const Contact& c : find(surface)) {
        stiffness += c.normal_stiffness;
        moment += c.normal_stiffness * surface.position[at(c.vertex)].x;
      }
      EXPECT_NEAR(stiffness / 1e9, 1.0, 1e-3) << below << above;
      EXPECT_NEAR(moment / stiffness, 0.5, 1e-3) << below << above;
    }
  }
}

// Two joints that cross at a small angle: above and below meet at the crossing alone, and share no more than lies there.
TEST(JointLength, BlocksThatMeetWhereJointsCrossShareNoJoint) {
  for (const double angle : {1.0, 2.0, 4.0, 4.9, 5.1, 10.0}) {
    const double rise = 5.0 * std::tan(0.5 * angle * std::numbers::pi / 180.0);
    Surface surface;
    add_block(surface, {{{-5, -rise}, {-5, -5}, {5, -5}, {5, -rise}, {0, 0}}, {}});
    add_block(surface, {{{5, rise}, {5, 5}, {-5, 5}, {-5, rise}, {0, 0}}, {}});
    add_block(surface, {{{-5, -rise}, {0, 0}, {-5, rise}}, {}});
    add_block(surface, {{{5, -rise}, {5, rise}, {0, 0}}, {}});
    const auto contacts = find(surface);
    EXPECT_LT(total_length(contacts, 0, 1), 0.2) << angle;
    const double side = std::hypot(5.0, rise);
    for (const int above : {0, 1})
      for (const int beside : {2, 3}) EXPECT_NEAR(total_length(contacts, above, beside), side, 0.1) << angle;
  }
}

// A joint that is drawn with many vertices is as stiff as one that is drawn with few, and has a contact or two at each of them. One side may
// have vertices between those of the other.
TEST(JointLength, StiffnessDoesNotDependOnHowFinelyAJointIsDrawn) {
  // Vertices may not come nearer to each other than the end zone, 3 mm.
  for (const auto& [segments, between] :
       {std::pair{4, false}, {40, false}, {400, false}, {4, true}, {40, true}, {100, true}}) {
    Ring below, above;
    double length = 0.0;
    for (int k = 0; k <= segments; ++k) {
      const double x = 2.0 * k / segments;
      const Vec2 here{x, 0.01 * std::sin(5.0 * x)};
      if (k > 0) {
        const Vec2 before = below.back();
        length += norm(here - before);
        if (between) above.push_back(lerp(before, here, 0.25));
      }
      above.push_back(here);
      below.push_back(here);
    }
    std::ranges::reverse(below);
    below.insert(below.end(), {{0.0, -1.0}, {2.0, -1.0}});
    above.insert(above.end(), {{2.0, 1.0}, {0.0, 1.0}});
    Surface surface;
    add_block(surface, {below, {}});
    add_block(surface, {above, {}});
    const auto contacts = find(surface);
    double stiffness = 0.0;
    for (const Contact& c : contacts) stiffness += c.normal_stiffness;
    EXPECT_NEAR(stiffness / (1e9 * length), 1.0, 1e-6) << segments << ", " << between;
    EXPECT_LE(contacts.size(), at((between ? 3 : 2) * segments)) << segments << ", " << between;
  }
}

// What a bond holds is what it held when it was made, however its blocks turn. What is not bonded shares as much as lies beside it.
TEST(JointLength, ABondKeepsItsLength) {
  for (const bool bonded : {false, true}) {
    Surface surface;
    add_block(surface, rectangle(0, 0, 2, 1));
    add_block(surface, rectangle(0.5, 1, 1.5, 2));
    CandidateList list;
    find(surface, list);
    for (Memory& memory : list.memory) {
      memory.bonded = bonded;
      memory.bond_length = 0.5;
    }
    for (std::size_t v = 4; v < 8; ++v) {
      const Vec2 from_corner = surface.position[v] - Vec2{0.5, 1.0};
      surface.position[v] += 0.01 * Vec2{-from_corner.y, from_corner.x};
    }
    int found = 0;
    for (const Contact& c : find(surface, list)) {
      if (std::abs(surface.position[at(c.vertex)].x - 0.5) > 0.1) continue;
      ++found;
      EXPECT_NEAR(c.length, bonded ? 0.5 : 0.5 * 0.15, 1e-3);
    }
    EXPECT_EQ(found, 1);
  }
}

// Faces that go on in faces of another joint: the contact of the corners that meet has what both joints give, on whichever side it is.
TEST(JointLength, AContactAtACornerHasTheLawsOfBothJoints) {
  const std::vector<JointLaw> laws{{.friction_coefficient = 0.2, .normal_stiffness = 1e9},
                                   {.friction_coefficient = 0.8, .normal_stiffness = 3e9}};
  for (const bool other_way : {false, true}) {
    Surface surface;
    add_block(surface, divided(0, 0, 1, 1, 2));
    add_block(surface, divided(0, 1, 1, 2, 2));
    for (std::size_t e = 0; e < surface.joint.size(); ++e) {
      const double middle = 0.5 * (surface.position[e].x + surface.position[at(surface.next[e])].x);
      surface.joint[e] = (middle < 0.5) == other_way ? 1 : 0;
    }
    CandidateList list;
    int at_corner = 0;
    for (const Contact& c : find(surface, list, laws)) {
      if (std::abs(surface.position[at(c.vertex)].x - 0.5) > 0.1) continue;
      ++at_corner;
      EXPECT_NEAR(c.friction_coefficient, 0.5, 1e-12);
      EXPECT_NEAR(c.normal_stiffness, 2e9 * c.length, 1.0);
      EXPECT_NEAR(c.shear_stiffness, 0.4 * c.normal_stiffness, 1.0);
    }
    EXPECT_EQ(at_corner, 1);
  }
}

// Rock on both sides of an outline not yet opened is one, however soft joints are.
TEST(JointLength, WhatIsFusedIsNoSofterThanRock) {
  const std::vector<JointLaw> laws{{.normal_stiffness = 1e7, .fused = true}};
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, rectangle(0, 1, 1, 2));
  CandidateList list;
  for (const Contact& c : find(surface, list, laws)) EXPECT_NEAR(c.normal_stiffness, 1e7 * c.length, 1.0);
  ASSERT_EQ(list.memory.size(), 2u);
  for (Memory& memory : list.memory) {
    memory.bonded = true;
    memory.bond_length = 0.5;
  }
  for (const Contact& c : find(surface, list, laws)) EXPECT_NEAR(c.normal_stiffness, 1e9 * 0.5, 1.0);
}

}  // namespace
}  // namespace keyblock::contact
