#include "dynamics/contact_audit.h"

#include <gtest/gtest.h>

namespace keyblock::dynamics {
namespace {

/// A square of 1 m, and the vertex of another block that a contact presses on its upper face.
struct PressedVertex {
  PressedVertex() {
    surface.block_begin = {0, 4, 7, 11};
    surface.position = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.5, 1.0}, {0.8, 1.5},
                        {0.2, 1.5}, {1.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {1.0, 2.0}};
    surface.next = {1, 2, 3, 0, 5, 6, 4, 8, 9, 10, 7};
    surface.block = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2};
    list.pairs = {{.vertex = 4, .edge = 2, .block_a = 1, .block_b = 0},
                  {.vertex = 4, .edge = 10, .block_a = 1, .block_b = 2}};
    contact::BlockPair square, wall;
    square.block_b = 1;
    wall.first = 1;
    wall.block_a = 1;
    wall.block_b = 2;
    list.block_pairs = {square, wall};
    list.pair_of_block = {0, 0, 1, 1};
    list.first_of_block = {0, 1, 3, 4};
    list.tracked = {0};
    list.memory.resize(1);
    list.memory[0].normal_force = 1e3;
  }
  ContactAudit audit(Vec2 vertex, double way = 0.0) {
    surface.position[4] = vertex;
    const std::vector<double> reach{0.0, 0.5 * way, 0.0};
    const std::vector<Vec2> relative{{0.5 * way, 0.0}};
    return audit_contacts({surface, list, reach, relative, 0.002});
  }

  contact::Surface surface;
  contact::CandidateList list;
};

TEST(ContactAudit, FindsNothingWhereVerticesTouch) {
  PressedVertex pressed;
  for (const double y : {0.9995, 1.0, 1.0019}) EXPECT_EQ(pressed.audit({0.5, y}).across_gaps, 0) << y;
  EXPECT_EQ(pressed.audit({-0.0019, 1.0}).across_gaps, 0) << "beside the end, within the end zone";
}

TEST(ContactAudit, FindsForcesAcrossGaps) {
  PressedVertex pressed;
  const ContactAudit in_front = pressed.audit({0.5, 1.01});
  EXPECT_EQ(in_front.across_gaps, 1);
  EXPECT_NEAR(in_front.farthest.distance, 0.01, 1e-12);
  EXPECT_EQ(in_front.farthest.block_a, 1);
  EXPECT_EQ(in_front.farthest.block_b, 0);
  EXPECT_EQ(pressed.audit({-0.5, 0.8}).across_gaps, 1) << "behind the line of the face, around its end";
  pressed.list.memory[0].normal_force = 0.0;
  EXPECT_EQ(pressed.audit({0.5, 1.01}).across_gaps, 0) << "it does not press";
}

TEST(ContactAudit, AllowsForTheWayInTheStepAndForClosedJoints) {
  PressedVertex pressed;
  EXPECT_EQ(pressed.audit({-0.05, 1.0}, 0.049).across_gaps, 0) << "it slid off in the step";
  EXPECT_EQ(pressed.audit({-0.05, 1.0}, 0.047).across_gaps, 1);
  pressed.list.memory[0].offset = -0.01;
  EXPECT_EQ(pressed.audit({0.5, 1.011}).across_gaps, 0) << "in-situ stress has closed the joint by more";
  EXPECT_EQ(pressed.audit({0.5, 1.013}).across_gaps, 1);
}

TEST(ContactAudit, AllowsForTheDepthInAWallThatStandsOnTheEdge) {
  PressedVertex pressed;
  EXPECT_EQ(pressed.audit({1.05, 0.99}).across_gaps, 0);
  EXPECT_EQ(pressed.audit({-0.05, 0.99}).across_gaps, 1) << "no wall there";
}

TEST(ContactAudit, MeasuresDepthsAndWhatNoClosureExplains) {
  PressedVertex pressed;
  pressed.list.memory[0].offset = 0.03;
  const ContactAudit audit = pressed.audit({0.5, 0.9});
  EXPECT_EQ(audit.across_gaps, 0);
  EXPECT_NEAR(audit.deepest.distance, 0.1, 1e-12);
  EXPECT_NEAR(audit.unexplained.distance, 0.03, 1e-12);
}

}  // namespace
}  // namespace keyblock::dynamics
