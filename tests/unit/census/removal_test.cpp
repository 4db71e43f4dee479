#include "census/removal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace keyblock::census {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double tolerance = 1e-12;

/// A face at so many degrees from the x axis, with its block on the side of `out`.
HoldingFace face(double dip, bool block_is_below, double length, double friction, double cohesion = 0.0) {
  Vec2 out{-std::sin(dip * degree), std::cos(dip * degree)};
  if (!block_is_below) out = -out;
  return {out, length, length, std::tan(friction * degree), cohesion};
}

const Vec2 weight{0.0, -100.0};

TEST(Removal, WithoutFacesItFalls) {
  const Removal removal = find_removal({}, weight, 0.0);
  EXPECT_EQ(removal.mode, Mode::falls);
  EXPECT_EQ(removal.factor(), 0.0);
  EXPECT_EQ(removal.force_for(1.5), 100.0);
  EXPECT_TRUE(removal.moves());
}

TEST(Removal, OfARoofPrismIsFree) {
  const HoldingFace faces[] = {face(60.0, true, 4.0, 30.0, 1e3), face(-60.0, true, 4.0, 30.0, 1e3)};
  const Removal removal = find_removal(faces, weight, 0.0);
  EXPECT_EQ(removal.mode, Mode::falls);
  EXPECT_TRUE(removal.sliding.empty());
}

TEST(Removal, AlongAPlaneIsByLimitEquilibrium) {
  const HoldingFace faces[] = {face(35.0, false, 2.0, 30.0, 10.0), face(80.0, false, 3.0, 30.0, 5.0)};
  const Removal removal = find_removal(faces, weight, 0.0);
  EXPECT_EQ(removal.mode, Mode::slides);
  ASSERT_EQ(removal.sliding, std::vector<std::size_t>{0});
  const double driving = 100.0 * std::sin(35.0 * degree),
               resisting = 100.0 * std::cos(35.0 * degree) * std::tan(30.0 * degree) + 20.0;
  EXPECT_NEAR(removal.factor(), resisting / driving, tolerance);
  EXPECT_NEAR(removal.force_for(2.0), driving - resisting / 2.0, 1e-10);
  EXPECT_NEAR(removal.direction.y, -std::sin(35.0 * degree), tolerance);
  EXPECT_FALSE(removal.moves());
}

TEST(Removal, BetweenParallelFacesIsPressedOnOneSideAndGluedOnBoth) {
  const HoldingFace faces[] = {face(60.0, false, 2.0, 30.0, 7.0), face(60.0, true, 1.0, 20.0, 3.0)};
  const Removal removal = find_removal(faces, weight, 0.0);
  EXPECT_EQ(removal.mode, Mode::slides_between);
  EXPECT_EQ(removal.sliding.size(), 2U);
  const double expected = (100.0 * std::cos(60.0 * degree) * std::tan(30.0 * degree) + 2.0 * 7.0 + 3.0) /
                          (100.0 * std::sin(60.0 * degree));
  EXPECT_NEAR(removal.factor(), expected, tolerance);
}

TEST(Removal, PressureOnFacesInLineIsSharedByTheirLengths) {
  const HoldingFace faces[] = {face(45.0, false, 3.0, 40.0), face(45.0, false, 1.0, 20.0)};
  const Removal removal = find_removal(faces, weight, 0.0);
  const double mean = (3.0 * std::tan(40.0 * degree) + std::tan(20.0 * degree)) / 4.0;
  EXPECT_NEAR(removal.factor(), mean, tolerance);
}

TEST(Removal, OnVerticalFacesIsHeldByCohesionAlone) {
  const HoldingFace with[] = {face(90.0, true, 2.0, 40.0, 10.0), face(90.0, false, 2.0, 40.0, 10.0)};
  EXPECT_EQ(find_removal(with, weight, 0.0).mode, Mode::slides_between);
  EXPECT_NEAR(find_removal(with, weight, 0.0).factor(), 0.4, tolerance);
  const HoldingFace without[] = {face(90.0, true, 2.0, 40.0), face(90.0, false, 2.0, 40.0)};
  EXPECT_EQ(find_removal(without, weight, 0.0).mode, Mode::falls);
}

TEST(Removal, IsNoneOfAWedgeThatIsNarrowerBelow) {
  const HoldingFace faces[] = {face(60.0, false, 2.0, 0.0), face(-60.0, false, 2.0, 0.0),
                               face(0.0, true, 4.0, 0.0)};
  const Removal removal = find_removal(faces, weight, 0.0);
  EXPECT_EQ(removal.mode, Mode::not_removable);
  EXPECT_TRUE(std::isinf(removal.factor()));
  EXPECT_EQ(removal.force_for(1.5), 0.0);
}

TEST(Removal, OfABlockOnTheFloorIsStableButPossible) {
  const HoldingFace faces[] = {face(0.0, false, 2.0, 30.0)};
  EXPECT_EQ(find_removal(faces, weight, 0.0).mode, Mode::stable);
  const Removal pushed = find_removal(faces, {60.0, -100.0}, 0.0);  // k_h = 0.6
  EXPECT_EQ(pushed.mode, Mode::slides);
  EXPECT_NEAR(pushed.factor(), std::tan(30.0 * degree) / 0.6, tolerance);
  EXPECT_EQ(find_removal(faces, {0.0, 0.0}, 0.0).mode, Mode::stable);
}

TEST(Removal, IsNotHinderedByFacesThatAreKnownTooBadly) {
  // Parallel joints, but one is turned by 0.1° as its corner was moved: the block is 3 mm wider where it is 2 m deep.
  const HoldingFace faces[] = {face(60.0, false, 2.0, 30.0), face(60.1, true, 2.0, 30.0)};
  EXPECT_EQ(find_removal(faces, weight, 0.0).mode, Mode::stable);  // upwards alone
  const Removal removal = find_removal(faces, weight, 5e-3);
  EXPECT_EQ(removal.mode, Mode::slides_between);
  EXPECT_NEAR(removal.factor(), std::tan(30.0 * degree) / std::tan(60.0 * degree), 2e-3);
  // A short edge of any direction, left by the cutting.
  const HoldingFace tooth[] = {face(60.0, true, 4.0, 30.0), face(-60.0, true, 4.0, 30.0),
                               face(10.0, false, 4e-3, 30.0)};
  EXPECT_EQ(find_removal(tooth, weight, 0.0).mode, Mode::not_removable);
  EXPECT_EQ(find_removal(tooth, weight, 5e-3).mode, Mode::falls);
}

}  // namespace
}  // namespace keyblock::census
