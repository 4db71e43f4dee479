#include "contact/joint_law.h"

#include <gtest/gtest.h>

#include "contact/joint_pieces.h"
#include "surface_builder.h"

namespace keyblock::contact {
namespace {

constexpr JointLaw weakening{
    .friction_coefficient = 0.8,
    .cohesion = 4e5,
    .tension = 1e5,
    .residual = JointLaw::Residual{.friction_coefficient = 0.5, .cohesion = 1e5, .slip = 0.02}};

void expect_strength(const Strength& strength, double friction, double cohesion, double tension) {
  EXPECT_DOUBLE_EQ(strength.friction_coefficient, friction);
  EXPECT_DOUBLE_EQ(strength.cohesion, cohesion);
  EXPECT_DOUBLE_EQ(strength.tension, tension);
}

TEST(JointLaw, FallsInAStraightLineToWhatIsLeft) {
  expect_strength(weakening.strength(0.0, true), 0.8, 4e5, 1e5);
  expect_strength(weakening.strength(0.005, true), 0.725, 3.25e5, 0.75e5);
  expect_strength(weakening.strength(0.02, true), 0.5, 1e5, 0.0);
  expect_strength(weakening.strength(JointLaw::worn_out, true), 0.5, 1e5, 0.0);
  expect_strength(weakening.strength(0.005, false), 0.725, 0.0, 0.0);
}

TEST(JointLaw, LossIsWhatStrengthFallsBy) {
  for (const double worn : {0.0, 0.004, 0.0199}) {
    for (const double slip : {1e-5, 0.001, 0.05}) {
      const Strength now = weakening.strength(worn, true), then = weakening.strength(worn + slip, true);
      const StrengthLoss lost = weakening.loss(worn, true).after(slip);
      EXPECT_NEAR(lost.friction, now.friction_coefficient - then.friction_coefficient, 1e-12)
          << worn << ' ' << slip;
      EXPECT_NEAR(lost.cohesion, now.cohesion - then.cohesion, 1e-6) << worn << ' ' << slip;
    }
  }
  EXPECT_FALSE(weakening.loss(0.02, true).is_any());
  EXPECT_EQ(weakening.loss(0.0, false).cohesion, 0.0);
}

TEST(JointLaw, WithoutASlipFallsAtOnce) {
  JointLaw brittle = weakening;
  brittle.residual->slip = 0.0;
  expect_strength(brittle.strength(0.0, true), 0.8, 4e5, 1e5);
  expect_strength(brittle.strength(1e-9, true), 0.5, 1e5, 0.0);
  EXPECT_DOUBLE_EQ(brittle.loss(0.0, true).after(0.0).cohesion, 3e5);
  EXPECT_FALSE(brittle.is_ductile(0.0));
  EXPECT_TRUE(brittle.is_ductile(1e-9));
  EXPECT_TRUE(weakening.is_ductile(0.0));
}

TEST(JointLaw, PlainJointsKeepWhatTheyHave) {
  const JointLaw plain{.friction_coefficient = 0.8, .cohesion = 4e5, .tension = 1e5};
  EXPECT_FALSE(plain.has_memory());
  expect_strength(plain.strength(JointLaw::worn_out, true), 0.8, 4e5, 1e5);
  EXPECT_FALSE(plain.loss(0.0, true).is_any());
  EXPECT_FALSE(plain.is_ductile(0.0));
}

TEST(JointLaw, OverACornerIsBetweenBoth) {
  const JointLaw plain{.friction_coefficient = 0.4, .cohesion = 2e5, .normal_stiffness = 1e9};
  const JointLaw both = mixed(weakening, plain, 0.25, 5e9);
  expect_strength(both.strength(0.0, true), 0.7, 3.5e5, 0.75e5);
  EXPECT_DOUBLE_EQ(both.normal_stiffness, 4e9);
  ASSERT_TRUE(both.residual);
  EXPECT_DOUBLE_EQ(both.residual->friction_coefficient, 0.475);
  EXPECT_DOUBLE_EQ(both.residual->slip, 0.015);
  EXPECT_FALSE(mixed(plain, plain, 0.5, 1e9).residual);
}

/// Two blocks of four vertices; edges of the first lie on joint 0, those of the second on joint 1.
Surface two_blocks() {
  Surface surface;
  add_block(surface, rectangle(0.0, 0.0, 1.0, 1.0));
  add_block(surface, rectangle(0.0, 1.0, 1.0, 2.0));
  for (std::size_t edge = 4; edge < 8; ++edge) surface.joint[edge] = 1;
  return surface;
}

TEST(JointPieces, AContactThatComesBackFindsItsOwn) {
  const JointPieces pieces{{0, 5, 0.1, false}, {1, 5, 0.3, false}, {2, 6, 0.2, true}};
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 1, 5), 1);
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 2, 6), 2);
}

TEST(JointPieces, AContactBesideOneThatWasThereSharesTheLeastWorn) {
  const JointPieces pieces{{0, 5, 0.1, false}, {1, 5, 0.3, true}, {2, 5, 0.2, true}};
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 3, 5), 2);  // that of vertex 0 has not been there
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 1, 6), 1);
}

TEST(JointPieces, OtherContactsHaveNone) {
  const JointPieces pieces{{0, 5, 0.1, false}, {5, 1, 0.3, true}};
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 3, 6), -1);
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 0, 6),
            -1);  // where it was, nothing touched in the last step
  EXPECT_EQ(piece_of_new_contact(pieces, two_blocks(), 5, 4), -1);  // of another joint
  EXPECT_EQ(piece_of_new_contact({}, two_blocks(), 0, 5), -1);
}

}  // namespace
}  // namespace keyblock::contact
