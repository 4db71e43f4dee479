// Rock bridges: dead ends that go on, and gaps.
#include <gtest/gtest.h>

#include "check_blocks.h"
#include "cutting/cut.h"

namespace keyblock::cutting {
namespace {

using rockmass::TraceSource;

constexpr TraceSource of_a_set{TraceSource::Kind::joint_set, 0}, of_a_map{TraceSource::Kind::trace_map, 0};
constexpr EdgeLabel of_set{EdgeKind::joint_set, 0}, of_map{EdgeKind::trace_map, 0},
    of_bridge{EdgeKind::joint_set, 1};

CutInput bridged() {
  CutInput input;
  input.domain = square;
  input.bridges = BridgeInput{.label = of_bridge, .at_dead_ends = true};
  return input;
}

/// m, of the edges of all blocks with a label; edges between two blocks count twice.
double length_of(const BlockSystem& system, EdgeLabel label) {
  double length = 0.0;
  for (const CutBlock& block : system.blocks) {
    for (std::size_t r = 0; r < block.labels.size(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k)
        if (block.labels[r][k] == label) length += norm(ring[(k + 1) % ring.size()] - ring[k]);
    }
  }
  return length;
}

TEST(Bridges, ADeadEndGoesOnToTheNextLine) {
  CutInput input = bridged();
  input.traces = {{{6, -1}, {6, 11}, of_a_map}, {{-1, 4}, {2, 4}, of_a_set}};
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 3U);
  EXPECT_EQ(length_of(system, of_set), 4.0);
  EXPECT_EQ(length_of(system, of_bridge), 8.0);  // from 2 to 6, seen from both sides
  EXPECT_EQ(system.statistics.removed_length, 0.0);
  EXPECT_EQ(system.statistics.bridge_length, 4.0);
  EXPECT_EQ(system.statistics.traces, 2);
  for (const JointShare& share : system.joints) EXPECT_EQ(share.bridged, share.joint == of_set ? 4.0 : 0.0);
}

TEST(Bridges, AJointWithinABlockGoesOnBothWays) {
  CutInput input = bridged();
  input.traces = {{{4, 4}, {6, 5}, of_a_map}};
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 2U);
  EXPECT_NEAR(length_of(system, of_map), 2.0 * std::sqrt(5.0), 1e-9);
  EXPECT_NEAR(length_of(system, of_bridge), 2.0 * (10.0 - 2.0) * std::sqrt(1.25), 1e-9);
}

// Each ends at the other one, and neither runs along it.
TEST(Bridges, TwoJointsOnOneLineMeet) {
  CutInput input = bridged();
  const Vec2 along = normalized(Vec2{3, 1}), from{-1, 2};
  input.traces = {{from, from + 5.0 * along, of_a_map}, {from + 7.0 * along, from + 20.0 * along, of_a_map}};
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 2U);
  EXPECT_NEAR(length_of(system, of_bridge), 4.0, 1e-8);
  EXPECT_EQ(system.statistics.merged_slivers, 0);
}

TEST(Bridges, GapsAreCutAndCountForTheirSet) {
  CutInput input = bridged();
  input.bridges->at_dead_ends = false;
  input.bridges->in_gaps = {{{3, 5}, {6, 5}, of_a_set}};
  input.traces = {{{-1, 5}, {3, 5}, of_a_set}, {{6, 5}, {11, 5}, of_a_set}, {{5, -1}, {5, 2}, of_a_map}};
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 2U);
  EXPECT_EQ(length_of(system, of_bridge), 6.0);
  EXPECT_EQ(system.statistics.bridge_length, 3.0);
  EXPECT_EQ(system.statistics.removed_length, 2.0);  // the other dead end is not bridged
}

// A line of a joint is none of a bridge, whichever is the longer.
TEST(Bridges, AJointGoesBeforeABridge) {
  CutInput input = bridged();
  input.bridges->at_dead_ends = false;
  input.bridges->in_gaps = {{{-1, 5}, {11, 5}, of_a_set}};
  input.traces = {{{2, 5}, {8, 5}, of_a_set}};
  const BlockSystem system = cut(input);
  EXPECT_EQ(length_of(system, of_set), 12.0);
  EXPECT_EQ(length_of(system, of_bridge), 8.0);
}

TEST(Bridges, WithoutThemDeadEndsAreRemoved) {
  CutInput input;
  input.domain = square;
  input.traces = {{{-1, 4}, {2, 4}, of_a_set}};
  const BlockSystem system = cut(input);
  EXPECT_EQ(system.blocks.size(), 1U);
  EXPECT_EQ(system.statistics.bridge_length, 0.0);
}

}  // namespace
}  // namespace keyblock::cutting
