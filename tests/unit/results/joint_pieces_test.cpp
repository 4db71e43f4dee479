#include "results/joint_pieces.h"

#include <gtest/gtest.h>

namespace keyblock::results {
namespace {

using record::ContactRecord;

/// Block 0, a square 0…4 with its top edge in two pieces: vertices 0 (0,0), 1 (4,0), 2 (4,4), 3 (3,4), 4 (0,4).
/// Block 1, a diamond that stands on it with its lowest corner, vertex 5, at (1.5,4).
/// Block 2, a box on it that begins at vertex 9, (2,4), and extends to the right.
record::ModelRecord square() {
  record::ModelRecord model;
  model.vertices = {{0, 0},   {4, 0}, {4, 4}, {3, 4}, {0, 4}, {1.5, 4}, {2, 5},
                    {1.5, 6}, {1, 5}, {2, 4}, {6, 4}, {6, 5}, {2, 5}};
  model.edge_label.assign(model.vertices.size(), {cutting::EdgeKind::joint_set, 0});
  model.blocks.resize(3);
  model.blocks[0].ring_start = {0, 5};
  model.blocks[1].ring_start = {5, 9};
  model.blocks[2].ring_start = {9, 13};
  return model;
}

std::vector<JointPiece> located(const record::ModelRecord& model, ContactRecord contact,
                                std::array<float, 2> moved = {0.0F, 0.0F}) {
  const std::vector<std::array<float, 2>> displacement(model.vertices.size(), moved);
  std::vector<JointPiece> pieces;
  JointLocator(model).locate({&contact, 1}, displacement, pieces);
  return pieces;
}

ContactRecord on_top(double x, double length) {
  ContactRecord contact;
  contact.block_a = 1;
  contact.position = {x, 4.0};
  contact.normal = {0.0, 1.0};
  contact.length = length;
  contact.shear_displacement = -0.02;
  return contact;
}

TEST(JointLocator, LaysTheLengthAroundTheContact) {
  const auto pieces = located(square(), on_top(1.5, 1.0));
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].vertex, 3U);
  EXPECT_FLOAT_EQ(pieces[0].from, 1.0F / 3.0F);
  EXPECT_FLOAT_EQ(pieces[0].to, 2.0F / 3.0F);
  EXPECT_FLOAT_EQ(pieces[0].slip, 0.02F);
}

TEST(JointLocator, LaysTheLengthTowardsTheSideOnWhichTheBlockLies) {
  ContactRecord corner = on_top(2.0, 0.9);
  corner.block_a = 2;
  const auto pieces = located(square(), corner);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].vertex, 3U);  // runs to the left, from x = 3 to 0
  EXPECT_NEAR(pieces[0].from, 0.1 / 3.0, 1e-6);
  EXPECT_NEAR(pieces[0].to, 1.0 / 3.0, 1e-6);
}

TEST(JointLocator, ShiftsTheLengthInwardsAtACornerAndGoesOverDisplayVertices) {
  const auto pieces = located(square(), on_top(4.0, 2.5));
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].vertex, 2U);
  EXPECT_FLOAT_EQ(pieces[0].from, 0.0F);
  EXPECT_FLOAT_EQ(pieces[0].to, 1.0F);
  EXPECT_EQ(pieces[1].vertex, 3U);
  EXPECT_FLOAT_EQ(pieces[1].to, 0.5F);
}

TEST(JointLocator, ReachIsMeasuredFromTheContactAlongTheRing) {
  const record::ModelRecord model = square();
  const JointLocator locator(model);
  const std::vector<std::array<float, 2>> still(model.vertices.size());
  const auto expect_reach = [&](const ContactRecord& contact, double from, double to) {
    const auto [first, second] = locator.reach(contact, still);
    EXPECT_NEAR(first, from, 1e-12);
    EXPECT_NEAR(second, to, 1e-12);
  };
  expect_reach(on_top(1.5, 1.0), -0.5, 0.5);
  expect_reach(on_top(4.0, 1.0), 0.0, 1.0);  // the ring runs to the left from here
  expect_reach(on_top(0.0, 1.0), -1.0, 0.0);
  expect_reach(on_top(4.1, 1.0), 0.1, 1.1);  // beyond the end of the edge
  ContactRecord corner = on_top(2.0, 0.9);
  corner.block_a = 2;
  expect_reach(corner, -0.9, 0.0);
}

TEST(JointLocator, NeverGoesOverTheEndOfTheEdge) {
  double length = 0.0;
  for (const auto& piece : located(square(), on_top(2.0, 9.0)))
    length += (piece.to - piece.from) * (piece.vertex == 2 ? 1.0 : 3.0);
  EXPECT_NEAR(length, 4.0, 1e-6);
}

TEST(JointLocator, TakesTheEdgeThatFacesTheNormal) {
  ContactRecord corner = on_top(4.0, 1.0);
  corner.normal = {1.0, 0.0};
  const auto pieces = located(square(), corner);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].vertex, 1U);
  EXPECT_FLOAT_EQ(pieces[0].from, 0.75F);
}

TEST(JointLocator, FollowsTheDisplacement) {
  ContactRecord contact = on_top(1.5, 1.0);
  contact.position = {11.5, -6.0};
  EXPECT_EQ(located(square(), contact, {10.0F, -10.0F}).at(0).vertex, 3U);
}

TEST(JointLocator, EdgesEndWhereTheLabelChanges) {
  record::ModelRecord model = square();
  model.edge_label[3] = {cutting::EdgeKind::joint_set, 1};
  const auto pieces = located(model, on_top(3.2, 2.0));
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].vertex, 2U);
}

}  // namespace
}  // namespace keyblock::results
