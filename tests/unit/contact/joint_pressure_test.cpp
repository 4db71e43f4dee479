#include "contact/joint_pressure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/quadrature.h"

namespace keyblock::contact {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;

constexpr double full_stiffness = 3e8;  // N/m

std::vector<double> forces_of(const JointPressure& joint, const std::vector<double>& y) {
  std::vector<double> force(y.size());
  joint.forces(y, force);
  return force;
}

std::vector<double> tangent_of(const JointPressure& joint, const std::vector<double>& y) {
  std::vector<double> h(y.size() * y.size());
  joint.tangent(y, h);
  return h;
}

/// Contacts at the points of a rule along a divided edge.
const EdgeDivision& divided(int points) {
  static const EdgeDivision three(gauss_lobatto(3).points), five(gauss_lobatto(5).points);
  return points == 3 ? three : five;
}

// Of a triangle c (1 − s/ξ) over ξ the force is ½ K c ξ, at ξ/3 from the end.
TEST(JointPressure, IsATriangleWhereOneEndIsOpen) {
  const JointPressure joint(full_stiffness, two_ends(), false);
  for (const double closed : {0.1, 0.3, 0.6, 0.9, 0.999}) {
    const double c = 1e-3;
    const std::vector<double> force = forces_of(joint, {c, -c * (1.0 - closed) / closed});
    EXPECT_NEAR(force[0] + force[1], 0.5 * full_stiffness * c * closed, 1e-9 * full_stiffness * c);
    EXPECT_NEAR(force[1] / (force[0] + force[1]), closed / 3.0, 1e-12);
  }
}

TEST(JointPressure, IsATrapeziumWhereBothEndsPress) {
  const JointPressure joint(full_stiffness, two_ends(), false);
  EXPECT_THAT(forces_of(joint, {1e-3, 1e-3}), Each(DoubleNear(0.5e-3 * full_stiffness, 1e-6)));
  EXPECT_THAT(forces_of(joint, {1e-3, 0.0}), ElementsAre(DoubleNear(full_stiffness * 1e-3 / 3, 1e-6),
                                                         DoubleNear(full_stiffness * 1e-3 / 6, 1e-6)));
  EXPECT_THAT(forces_of(joint, {-1e-3, -1e-9}), Each(0.0));
}

TEST(JointPressure, PullsWhereItIsABond) {
  JointPressure joint(full_stiffness, two_ends(), true);
  EXPECT_THAT(forces_of(joint, {-1e-3, -1e-3}), Each(DoubleNear(-0.5e-3 * full_stiffness, 1e-6)));
  joint.pull_no_more();
  EXPECT_THAT(forces_of(joint, {-1e-3, -1e-3}), Each(0.0));
}

// However many contacts there are, a face that stays straight has the force and moment of its triangle.
TEST(JointPressure, OfStraightFacesDoesNotDependOnTheContacts) {
  for (const double open : {-3e-3, -1e-3, -1e-5, 1e-4}) {
    const JointPressure ends(full_stiffness, two_ends(), false);
    const std::vector<double> two = forces_of(ends, {1e-3, open});
    for (const int points : {3, 5}) {
      const JointPressure joint(full_stiffness, divided(points), false);
      std::vector<double> y;
      for (const double s : divided(points).points) y.push_back(std::lerp(1e-3, open, s));
      const std::vector<double> many = forces_of(joint, y);
      double sum = 0.0, moment = 0.0;
      for (std::size_t i = 0; i < many.size(); ++i) {
        sum += many[i];
        moment += many[i] * divided(points).points[i];
      }
      EXPECT_NEAR(sum, two[0] + two[1], 1e-9 * full_stiffness * 1e-3) << points;
      EXPECT_NEAR(moment, two[1], 1e-9 * full_stiffness * 1e-3) << points;
    }
  }
}

// An even pressure has the weights of the rule: it does its work on any order.
// Of a joint that is open at one end some nodal forces pull. What contacts bear never does, and has the same sum and moment.
TEST(JointPressure, IsBorneByContactsThatPress) {
  for (const int points : {3, 5}) {
    const EdgeDivision& division = divided(points);
    const JointPressure joint(full_stiffness, division, false);
    for (const double open_from : {0.3, 0.6, 0.9, 2.0}) {
      SCOPED_TRACE(testing::Message() << points << " points, open from " << open_from);
      std::vector<double> y, force(division.points.size()), bearing(force.size());
      for (const double s : division.points) y.push_back(1e-3 * (open_from - s));
      joint.forces(y, force, bearing);
      double sum = 0.0, moment = 0.0;
      for (std::size_t i = 0; i < force.size(); ++i) {
        EXPECT_GE(bearing[i], 0.0);
        sum += bearing[i] - force[i];
        moment += (bearing[i] - force[i]) * division.points[i];
      }
      EXPECT_NEAR(sum, 0.0, 1e-9 * full_stiffness * 1e-3);
      EXPECT_NEAR(moment, 0.0, 1e-9 * full_stiffness * 1e-3);
      EXPECT_EQ(*std::ranges::min_element(force) < 0.0, open_from < 1.0);
    }
  }
}

TEST(JointPressure, OfEvenPressureHasTheWeightsOfTheRule) {
  for (const int points : {3, 5}) {
    const JointPressure joint(full_stiffness, divided(points), false);
    const std::vector<double> force =
        forces_of(joint, std::vector<double>(static_cast<std::size_t>(points), 1e-3));
    for (std::size_t i = 0; i < force.size(); ++i)
      EXPECT_NEAR(force[i], full_stiffness * 1e-3 * gauss_lobatto(points).weights[i], 1e-6);
  }
}

// Both ends and the middle of each half press, and the joint is open between: the rule of rectangles sees it.
TEST(JointPressure, SeesAStretchThatOpensBetweenItsContacts) {
  for (const int points : {3, 5}) {
    const EdgeDivision& division = divided(points);
    const JointPressure joint(full_stiffness, division, false);
    for (const double shift : {-0.0030, -0.0025, -0.0020, 0.0, 0.0010, 0.0024, 0.0026, 0.01}) {
      SCOPED_TRACE(testing::Message() << points << " points, " << shift);
      const auto closure = [&](double s) { return (s - 0.1) * (s - 0.2) + shift; };
      std::vector<double> y;
      for (const double s : division.points) y.push_back(closure(s));
      double expected = 0.0, moment = 0.0;
      constexpr int count = 100'000;
      for (int k = 0; k < count; ++k) {
        const double s = (k + 0.5) / count, pressure = full_stiffness * std::max(closure(s), 0.0) / count;
        expected += pressure;
        moment += s * pressure;
      }
      const std::vector<double> force = forces_of(joint, y);
      double sum = 0.0, turn = 0.0;
      for (std::size_t i = 0; i < force.size(); ++i) {
        sum += force[i];
        turn += division.points[i] * force[i];
      }
      EXPECT_NEAR(sum, expected, 1e-8 * full_stiffness);
      EXPECT_NEAR(turn, moment, 1e-8 * full_stiffness);
    }
  }
}

// F is the slope of a convex potential that is homogeneous: F = H y, and H is its derivative.
TEST(JointPressure, TangentIsTheDerivativeOfTheForces) {
  const std::vector<std::vector<double>> states{
      {1e-3, -2e-3}, {-5e-4, 1e-3}, {1e-3, 2e-3, -1e-3}, {1e-3, -2e-4, -1e-3, 2e-4, 7e-4}};
  for (const std::vector<double>& y : states) {
    const std::size_t n = y.size();
    const JointPressure joint(full_stiffness, n == 2 ? two_ends() : divided(static_cast<int>(n)), false);
    const std::vector<double> h = tangent_of(joint, y), force = forces_of(joint, y);
    for (std::size_t i = 0; i < n; ++i) {
      double line = 0.0;
      for (std::size_t j = 0; j < n; ++j) {
        line += h[i * n + j] * y[j];
        EXPECT_EQ(h[i * n + j], h[j * n + i]);
        std::vector<double> more = y, less = y;
        more[j] += 1e-8;
        less[j] -= 1e-8;
        EXPECT_NEAR((forces_of(joint, more)[i] - forces_of(joint, less)[i]) / 2e-8, h[i * n + j],
                    1e-4 * full_stiffness);
      }
      EXPECT_NEAR(line, force[i], 1e-9 * full_stiffness * 1e-3);
    }
  }
}

TEST(JointPressure, IsLinearWhileItIsClosedOrOpenAllAlong) {
  const JointPressure joint(full_stiffness, two_ends(), false);
  const auto linear = [&](std::vector<double> from, std::vector<double> to) {
    return joint.is_linear_between(from, to);
  };
  EXPECT_TRUE(linear({1.0, 2.0}, {2.0, 0.5}));
  EXPECT_TRUE(linear({-1.0, -2.0}, {-2.0, -0.5}));
  EXPECT_FALSE(linear({1.0, 2.0}, {2.0, -0.5}));
  EXPECT_FALSE(linear({1.0, -2.0}, {1.0, -2.0}));
  EXPECT_FALSE(linear({1.0, 2.0}, {-2.0, -0.5}));
}

}  // namespace
}  // namespace keyblock::contact
