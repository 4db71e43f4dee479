#include "simulation/bolt_bench.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace keyblock::simulation {
namespace {

/// A bar of 25 mm, 3 m long, in good grout.
loading::Bolt bolt_on_the_bench(bool has_nodes) {
  loading::Bolt bolt;
  bolt.name = bolt.list = "bolt";
  bolt.toe = {3.0, 0.0};
  bolt.area = 4.908762e-4;
  bolt.spacing = 1.5;
  bolt.grout_stiffness = 1e10;
  bolt.grout_strength = 7e5;
  bolt.grouted = {0.0, 3.0};
  bolt.active_length = 0.05;
  bolt.has_plate = false;
  bolt.has_nodes = has_nodes;
  return bolt;
}

// The elastic bar in grout that slips, on both sides of the joint, and the strength of its grout (loading::BoltSide).
TEST(BoltBench, PullsNodesAsABarInGrout) {
  const loading::Bolt bolt = bolt_on_the_bench(true);
  const BoltCurve curve = test_bolt(bolt, {.at = 1.5, .way = 20e-3, .steps = 1000});
  for (const double force : {71e3, 333e3, 596e3, 858e3}) {
    const double opening = 2.0 * loading::BoltSide(bolt, 0.0, 1.5, false).displacement(force);
    EXPECT_NEAR(curve.force_at(opening), force, 0.01 * force) << opening;
  }
  EXPECT_NEAR(curve.force.back(), 1.05e6, 1e-3 * 1.05e6);
}

// A spring of the secant stiffness, up to the strength of the grout.
TEST(BoltBench, PullsSpringsAtJointsByTheirSecant) {
  loading::Bolt bolt = bolt_on_the_bench(false);
  bolt.yield = 250e3;
  const BoltCurve curve = test_bolt(bolt, {.at = 1.5, .way = 2e-3});
  EXPECT_NEAR(curve.force_at(0.5e-3), 250e3 * 0.5e-3 / 0.9361e-3, 1e3);
  EXPECT_NEAR(curve.force.back(), 250e3, 1.0);
}

// A dowel alone: its stiffness, and its strength.
TEST(BoltBench, ShearsDowels) {
  for (const bool has_nodes : {false, true}) {
    loading::Bolt bolt = bolt_on_the_bench(has_nodes);
    bolt.dowel_stiffness = 5e7;
    bolt.dowel_strength = 40e3;
    const BoltCurve curve = test_bolt(bolt, {.at = 1.5, .way = 1e-3, .is_shear = true});
    EXPECT_NEAR(curve.force_at(0.4e-3), 20e3, 200.0) << has_nodes;
    EXPECT_NEAR(curve.force.back(), 40e3, 600.0) << has_nodes;
  }
}

TEST(BoltBench, RefusesJointsBesideTheBolt) {
  EXPECT_THROW(test_bolt(bolt_on_the_bench(true), {.at = 3.0, .way = 1e-3}), InputError);
  EXPECT_THROW(test_bolt(bolt_on_the_bench(true), {.at = -1.0, .way = 1e-3}), InputError);
}

}  // namespace
}  // namespace keyblock::simulation
