#include "cutting/cut.h"

#include <gtest/gtest.h>

#include <set>

#include "check_blocks.h"
#include "core/error.h"
#include "geos_oracle.h"
#include "tunnel.h"

namespace keyblock::cutting {
namespace {

using rockmass::Trace;
using rockmass::TraceSource;

constexpr TraceSource set_0{TraceSource::Kind::joint_set, 0}, set_1{TraceSource::Kind::joint_set, 1},
    map_2{TraceSource::Kind::trace_map, 2};

void add_ring(std::vector<Trace>& traces, const Ring& ring, TraceSource source) {
  for (std::size_t k = 0; k < ring.size(); ++k)
    traces.push_back({ring[k], ring[(k + 1) % ring.size()], source});
}

TEST(Cut, WithoutJointsTheDomainIsOneBlock) {
  CutInput input;
  input.domain = {{0, 10}, {10, 10}, {10, 0}, {0, 0}};  // clockwise
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 1u);
  EXPECT_EQ(system.blocks[0].polygon.outer, square);
  EXPECT_EQ(system.blocks[0].labels[0], (std::vector<EdgeLabel>(4, {EdgeKind::domain, 0})));
  EXPECT_EQ(system.statistics.domain_area, 100.0);
}

TEST(Cut, LabelsFollowTheirJoints) {
  CutInput input;
  input.domain = square;
  input.traces = {{{5, -1}, {5, 11}, set_1}, {{5, 4}, {11, 4}, map_2}};
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 3u);
  const CutBlock& left = system.blocks[1];
  // The foot of the T is a corner of the two blocks on the right only.
  EXPECT_EQ(left.polygon.outer, (Ring{{0, 0}, {5, 0}, {5, 10}, {0, 10}}));
  EXPECT_EQ(left.labels[0][1], (EdgeLabel{EdgeKind::joint_set, 1}));
  const CutBlock& below = system.blocks[0];
  EXPECT_EQ(below.polygon.outer, (Ring{{5, 0}, {10, 0}, {10, 4}, {5, 4}}));
  EXPECT_EQ(below.labels[0][2], (EdgeLabel{EdgeKind::trace_map, 2}));
  EXPECT_EQ(below.labels[0][3], (EdgeLabel{EdgeKind::joint_set, 1}));
  EXPECT_EQ(system.statistics.traces, 2);
  EXPECT_EQ(system.statistics.joints_used, 2);
}

// Joints are counted, not the straight pieces of a polyline, nor those beyond the domain.
TEST(Cut, APolylineCountsOnce) {
  CutInput input;
  input.domain = square;
  input.traces = {{{-1, 5}, {4, 5}, map_2, 0}, {{4, 5}, {6, 6}, map_2, 0}, {{6, 6}, {11, 6}, map_2, 0},
                  {{2, 2}, {3, 2}, map_2, 1},  {{3, 2}, {3, 3}, map_2, 1}, {{20, 2}, {21, 2}, map_2, 2}};
  const BlockSystem system = cut(input);
  EXPECT_EQ(system.blocks.size(), 2u);
  EXPECT_EQ(system.statistics.traces, 2);
  EXPECT_EQ(system.statistics.joints_used, 1);
}

TEST(Cut, OverlapsTakeTheLabelOfHigherRank) {
  CutInput input;
  input.domain = square;
  input.excavations = {{{4, 4}, {6, 4}, {6, 6}, {4, 6}}};
  const auto label_between = [&](Vec2 p, Vec2 q) {
    for (const CutBlock& block : cut(input).blocks) {
      const Ring& ring = block.polygon.outer;
      for (std::size_t k = 0; k < ring.size(); ++k) {
        if (ring[k] == p && ring[(k + 1) % ring.size()] == q) return block.labels[0][k];
      }
    }
    return EdgeLabel{};
  };
  input.traces = {{{0, 2}, {10, 2}, set_1}, {{0, 2}, {10, 2}, set_0}};
  EXPECT_EQ(label_between({10, 2}, {0, 2}), (EdgeLabel{EdgeKind::joint_set, 0}));
  input.traces.push_back({{0, 2}, {10, 2}, map_2});
  EXPECT_EQ(label_between({10, 2}, {0, 2}), (EdgeLabel{EdgeKind::trace_map, 2}));
  input.traces = {{{3, 4}, {7, 4}, set_0}, {{-1, 0}, {11, 0}, set_0}};
  EXPECT_EQ(label_between({4, 4}, {6, 4}), (EdgeLabel{EdgeKind::excavation, 0}));
  EXPECT_EQ(label_between({0, 0}, {10, 0}), (EdgeLabel{EdgeKind::domain, 0}));
}

TEST(Cut, AnIslandMakesAHole) {
  CutInput input;
  input.domain = square;
  add_ring(input.traces, {{2, 2}, {8, 2}, {8, 8}, {2, 8}}, set_0);
  add_ring(input.traces, {{4, 4}, {6, 4}, {5, 6}}, set_1);  // an island in the island
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 3u);
  std::multiset<double> areas;
  for (const CutBlock& block : system.blocks) areas.insert(area(block.polygon));
  EXPECT_EQ(areas, (std::multiset<double>{2.0, 34.0, 64.0}));
  for (const CutBlock& block : system.blocks) {
    EXPECT_EQ(block.polygon.holes.size(), area(block.polygon) == 2.0 ? 0u : 1u);
    EXPECT_EQ(block.labels.size(), block.polygon.ring_count());
  }
  expect_canonical(system);
}

TEST(Cut, AnIslandOnABridgeLosesTheBridge) {
  CutInput input;
  input.domain = square;
  add_ring(input.traces, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}, set_0);
  input.traces.push_back({{0, 5}, {4, 5}, set_1});
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 2u);
  EXPECT_EQ(system.statistics.removed_length, 4.0);
  EXPECT_EQ(system.statistics.removed_pieces, 1);
  EXPECT_EQ(system.statistics.joints_used, 4);
  EXPECT_EQ(system.statistics.traces, 5);
  EXPECT_EQ(system.statistics.trace_length, 12.0);
}

TEST(Cut, RingsThatTouchInAPointStayApart) {
  CutInput input;
  input.domain = square;
  add_ring(input.traces, {{3, 5}, {5, 4}, {5, 6}}, set_0);
  add_ring(input.traces, {{5, 4}, {7, 3}, {7, 5}}, set_0);
  add_ring(input.traces, {{0, 2}, {2, 1}, {2, 3}}, set_1);  // touches the frame
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 4u);
  std::size_t holes = 0;
  for (const CutBlock& block : system.blocks) holes += block.polygon.holes.size();
  EXPECT_EQ(holes, 3u);
  EXPECT_TRUE(GeosOracle().all_valid(system.blocks));
  EXPECT_NEAR(total_area(system), 100.0, 1e-12);
}

TEST(Cut, BlocksLieInsideOrOutsideOfExcavations) {
  CutInput input;
  input.domain = square;
  input.excavations = {{{2, 2}, {6, 2}, {6, 6}, {2, 6}},
                       {{4, 8}, {8, 8}, {8, 4}, {4, 4}}};  // overlapping, one clockwise
  input.traces = {{{0, 5}, {10, 5}, set_0}};
  const BlockSystem system = cut(input);
  std::map<std::vector<int>, double> areas;
  for (const CutBlock& block : system.blocks) areas[block.excavations] += area(block.polygon);
  EXPECT_EQ(areas, (std::map<std::vector<int>, double>{{{}, 72.0}, {{0}, 12.0}, {{1}, 12.0}, {{0, 1}, 4.0}}));
}

TEST(Cut, TracesOnTheFrameAndTangentToAnOutline) {
  CutInput input;
  input.domain = square;
  Ring circle;
  for (int k = 0; k < 64; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 64;
    circle.push_back({5.0 + 2.0 * std::cos(angle), 5.0 + 2.0 * std::sin(angle)});
  }
  input.excavations = {circle};
  input.traces = {{{0, 7}, {10, 7}, set_0},          {{3, 0}, {3, 10}, set_1},
                  {{-5, 0}, {15, 0}, set_0},         {{10, 2}, {10, 8}, set_0},
                  {{1, 1e-13}, {4, 0}, set_0},       {{0, 10.00005}, {10, 10}, set_1},
                  {{0, 3.0001}, {10, 2.9999}, set_0}};
  const BlockSystem system = cut(input);
  double inside = 0.0;
  for (const CutBlock& block : system.blocks) {
    if (!block.excavations.empty()) inside += area(block.polygon);
  }
  // 2 × 3 strips; the circle, which touches the middle right one in three points, leaves three pieces of it.
  EXPECT_EQ(system.blocks.size(), 9u);
  EXPECT_NEAR(inside, signed_area(circle), 0.02);
  EXPECT_NEAR(total_area(system), 100.0, 1e-7);
}

TEST(Cut, FarFromTheOriginNothingIsLost) {
  const CutInput near = paper_tunnel(3);
  const Vec2 far{466016.0, 6691584.0};
  CutInput moved = near;
  for (Trace& t : moved.traces) {
    t.a += far;
    t.b += far;
  }
  for (Vec2& p : moved.domain) p += far;
  for (Vec2& p : moved.excavations[0]) p += far;
  const BlockSystem here = cut(near), there = cut(moved);
  EXPECT_EQ(here.origin, Vec2{});
  EXPECT_LT(norm(there.origin - far), 10.0);
  ASSERT_EQ(there.blocks.size(), here.blocks.size());
  for (std::size_t k = 0; k < here.blocks.size(); ++k) {
    EXPECT_NEAR(area(there.blocks[k].polygon), area(here.blocks[k].polygon), 1e-7);
    EXPECT_LT(
        norm(centroid(there.blocks[k].polygon) + (there.origin - far) - centroid(here.blocks[k].polygon)),
        1e-7);
  }
}

TEST(Cut, TheOrderOfTracesDoesNotMatter) {
  CutInput input = paper_tunnel(0);
  const BlockSystem forward = cut(input);
  std::reverse(input.traces.begin(), input.traces.end());
  for (Trace& t : input.traces) std::swap(t.a, t.b);
  const BlockSystem backward = cut(input);
  ASSERT_EQ(forward.blocks.size(), backward.blocks.size());
  for (std::size_t k = 0; k < forward.blocks.size(); ++k) {
    EXPECT_NEAR(area(forward.blocks[k].polygon), area(backward.blocks[k].polygon), 1e-9);
  }
}

TEST(Cut, TunnelOfThePaper) {
  std::size_t blocks = 0;
  for (int realization = 0; realization < 10; ++realization) {
    const CutInput input = paper_tunnel(realization);
    const BlockSystem system = cut(input);
    blocks += system.blocks.size();
    expect_canonical(system);
    double inside = 0.0;
    for (const CutBlock& block : system.blocks) {
      if (!block.excavations.empty()) inside += area(block.polygon);
    }
    EXPECT_NEAR(total_area(system), 400.0, 4e-7);
    EXPECT_NEAR(inside, signed_area(input.excavations[0]), 0.02);
    const double covered = GeosOracle().union_area(system.blocks);
    EXPECT_NEAR(covered, 400.0, 1e-6);               // no gaps
    EXPECT_NEAR(covered, total_area(system), 1e-6);  // no overlaps
    EXPECT_TRUE(GeosOracle().all_valid(system.blocks));
  }
  EXPECT_GT(blocks, 8000u);
  EXPECT_LT(blocks, 11000u);
}

TEST(Cut, BadRingsAreTheUsersMistake) {
  CutInput input;
  input.domain = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  input.excavations = {{{0, 0}, {1, 0}}, {{0, 0}, {std::nan(""), 0}, {1, 1}}};
  try {
    cut(input);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 3u);
    EXPECT_EQ(error.diagnostics()[0].key, "domain");
    EXPECT_EQ(error.diagnostics()[1].found, "a ring of 2 vertices");
    EXPECT_EQ(error.diagnostics()[2].key, "excavation[1]");
  }
}

}  // namespace
}  // namespace keyblock::cutting
