#include "contact/contact_description.h"

#include <gtest/gtest.h>

#include "corner_scene.h"

namespace keyblock::contact {
namespace {

/// A block on another, in the middle of its top: its two contacts, of vertices 4 and 5 with edge 2.
struct Seat {
  CornerScene scene;
  std::vector<FoundContact> found;
  explicit Seat(double gap = -1e-4) : scene(surface(gap)) {
    for (const int vertex : {4, 5}) found.push_back({scene.candidate_of(vertex, 2), -1, false});
  }
  static Surface surface(double gap) {
    Surface surface;
    add_block(surface, rectangle(0, 0, 3, 1));
    add_block(surface, rectangle(1, 1.0 + gap, 2, 2));
    return surface;
  }
  [[nodiscard]] bool describe(const ContactDescription& description, std::span<Contact> contacts) const {
    return description.describe(scene.surface(), scene.corners(), scene.list, found, contacts);
  }
};

TEST(ContactDescription, HasGeometryAndLengthOfAFace) {
  const Seat seat;
  const ContactDescription description(seat.scene.tolerances(), {JointLaw{}}, {1e9, 1e9});
  std::vector<Contact> contacts(2);
  EXPECT_FALSE(seat.describe(description, contacts)) << "they are new";
  EXPECT_TRUE(seat.describe(description, contacts)) << "they are the same";
  for (const Contact& c : contacts) {
    EXPECT_EQ(c.block_a, 1);
    EXPECT_EQ(c.block_b, 0);
    EXPECT_EQ(c.edge, 2);
    EXPECT_EQ(c.normal, (Vec2{0.0, 1.0}));
    EXPECT_NEAR(c.gap, -1e-4, 1e-15);
    EXPECT_NEAR(c.length, 0.5, 1e-12);
    EXPECT_NEAR(c.depth, 0.0, 1e-15) << "born penetrated";
    EXPECT_NEAR(c.memory.offset, 1e-4, 1e-15);
  }
  EXPECT_NEAR(contacts[0].position, 2.0 / 3.0, 1e-12);  // the top runs from right to left
  EXPECT_NEAR(contacts[1].position, 1.0 / 3.0, 1e-12);
}

TEST(ContactDescription, StiffnessIsOfTheLawOrOfTheSofterBlock) {
  const Seat seat;
  std::vector<Contact> contacts(2);
  static_cast<void>(
      seat.describe(ContactDescription(seat.scene.tolerances(), {JointLaw{}}, {3e9, 1e9}), contacts));
  EXPECT_DOUBLE_EQ(contacts[0].normal_stiffness, 1e9 * 0.5);
  EXPECT_DOUBLE_EQ(contacts[0].shear_stiffness, 0.4e9 * 0.5);
  JointLaw law;
  law.normal_stiffness = 2e10;
  law.stiffness_ratio = 0.5;
  law.friction_coefficient = 0.7;
  law.cohesion = 1e5;
  static_cast<void>(seat.describe(ContactDescription(seat.scene.tolerances(), {law}, {3e9, 1e9}), contacts));
  EXPECT_DOUBLE_EQ(contacts[0].normal_stiffness, 2e10 * 0.5);
  EXPECT_DOUBLE_EQ(contacts[0].shear_stiffness, 1e10 * 0.5);
  EXPECT_EQ(contacts[0].friction_coefficient, 0.7);
  EXPECT_EQ(contacts[0].cohesion, 0.0) << "no bond";
}

TEST(ContactDescription, ABondKeepsItsLengthAndStrength) {
  Seat seat;
  seat.scene.press(seat.found[0].candidate);
  Memory& bond = seat.scene.list.memory[0];
  bond.bonded = true;
  bond.bond_length = 0.2;
  seat.found[0].memory = 0;
  JointLaw law;
  law.cohesion = 1e5;
  law.tension = 2e4;
  std::vector<Contact> contacts(2);
  static_cast<void>(seat.describe(ContactDescription(seat.scene.tolerances(), {law}, {1e9, 1e9}), contacts));
  EXPECT_EQ(contacts[0].length, 0.2);
  EXPECT_DOUBLE_EQ(contacts[0].cohesion, 0.2 * 1e5);
  EXPECT_DOUBLE_EQ(contacts[0].tension, 0.2 * 2e4);
  EXPECT_TRUE(contacts[0].memory.bonded);
  EXPECT_NEAR(contacts[1].length, 0.5, 1e-12);
  EXPECT_EQ(contacts[1].cohesion, 0.0);
}

}  // namespace
}  // namespace keyblock::contact
