#include "cutting/cleaning.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <numbers>
#include <set>

#include "check_blocks.h"
#include "cutting/cut.h"
#include "geos_oracle.h"
#include "tunnel.h"

namespace keyblock::cutting {
namespace {

using rockmass::TraceSource;

/// The same cases in every run, unless the environment says otherwise.
const bool seeded = ::setenv("RC_PARAMS", "seed=2001 max_success=200", 0) == 0;

bool is_sliver(const CutBlock& block, const CutTolerances& t) {
  // Dropping collinear vertices changes the last digits after the sizes were compared.
  const double slack = 1.0 - 1e-4;
  const double a = area(block.polygon);
  return a < slack * t.sliver_area || a < slack * t.sliver_thickness * perimeter(block.polygon);
}

/// Whether an edge leads to a block with which this one could be merged.
bool has_neighbour(const CutBlock& block) {
  for (const auto& ring : block.labels) {
    for (const EdgeLabel label : ring) {
      if (label.kind == EdgeKind::joint_set || label.kind == EdgeKind::trace_map) return true;
    }
  }
  return false;
}

/// Joints between points of a coarse lattice meet in nodes, overlap, repeat and end on one another; moved by a hair,
/// they nearly do; those between any points leave slivers.
CutInput random_input() {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10, 8}, {4, 10}, {0, 8}};
  const auto lattice = rc::gen::map(rc::gen::inRange(-1, 12), [](int k) { return static_cast<double>(k); });
  const auto fine = rc::gen::map(rc::gen::inRange(-100000, 1200000), [](int k) { return 1e-5 * k; });
  const bool coarse = *rc::gen::inRange(0, 4) > 0;
  const double hair = *rc::gen::arbitrary<bool>() ? std::pow(10.0, -*rc::gen::inRange(2, 16)) : 0.0;
  const auto off = rc::gen::map(rc::gen::inRange(-100, 101), [](int k) { return 0.01 * k; });
  const int lines = *rc::gen::inRange(0, 40);
  for (int k = 0; k < lines; ++k) {
    const auto coordinate = [&] { return coarse ? *lattice + hair * *off : *fine; };
    const Vec2 a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
    const auto kind =
        *rc::gen::arbitrary<bool>() ? TraceSource::Kind::joint_set : TraceSource::Kind::trace_map;
    if (!(a == b))
      RC_LOG() << std::setprecision(17) << "{{" << a.x << "," << a.y << "},{" << b.x << "," << b.y << "}}, ";
    if (!(a == b)) input.traces.push_back({a, b, {kind, *rc::gen::inRange(0, 3)}});
  }
  if (*rc::gen::arbitrary<bool>())
    input.excavations.push_back({{3, 3}, {6, 3}, {6.5, 5}, {4.5, 6.5}, {2.5, 5}});
  return input;
}

RC_GTEST_PROP(Cleaning, LeavesAConformingCoverOfTheDomain, ()) {
  RC_PRE(seeded);
  const CutInput input = random_input();
  const double domain_area = signed_area(input.domain);
  const CutTolerances tolerances = CutTolerances::for_domain(domain_area);
  const BlockSystem system = cut(input);
  const double covered = GeosOracle().union_area(system.blocks);
  // Neighbours may differ by the collinear tolerance along all edges.
  double tiny = 1e-9 * domain_area;
  for (const CutBlock& block : system.blocks) tiny += tolerances.collinear * perimeter(block.polygon);
  RC_ASSERT(std::abs(covered - domain_area) < tiny);         // no gaps
  RC_ASSERT(std::abs(covered - total_area(system)) < tiny);  // no overlaps
  RC_ASSERT(GeosOracle().all_valid(system.blocks));
  double excavated = 0.0;
  for (const CutBlock& block : system.blocks) {
    RC_ASSERT(!is_sliver(block, tolerances) || !has_neighbour(block));
    if (!block.excavations.empty()) excavated += area(block.polygon);
  }
  const double outline = input.excavations.empty() ? 0.0 : signed_area(input.excavations[0]);
  RC_ASSERT(std::abs(excavated - outline) < tolerances.cluster * 12.0);
}

RC_GTEST_PROP(Cleaning, RawBlocksShareTheirEdges, ()) {
  CutInput input = random_input();
  input.tolerances = CutTolerances{};
  const BlockSystem system = cut(input);
  RC_ASSERT(mistake_of_shared_edges(system) == "");
  expect_canonical(system);
  const double domain_area = signed_area(input.domain);
  RC_ASSERT(std::abs(total_area(system) - domain_area) < 1e-11 * domain_area);
}

/// Far from the origin real coordinates have 10⁻⁹ m between them, and vertices that lie closer would fall together.
RC_GTEST_PROP(Cleaning, RawBlocksKeepTheirShapeFarFromTheOrigin, ()) {
  CutInput input = random_input();
  const Vec2 far{466000.0, 6.7e6};
  for (Vec2& p : input.domain) p += far;
  for (rockmass::Trace& trace : input.traces) {
    trace.a += far;
    trace.b += far;
    if (trace.a == trace.b) RC_DISCARD();
  }
  input.excavations.clear();
  input.tolerances = CutTolerances{};
  BlockSystem system = cut(input);
  for (CutBlock& block : system.blocks) {
    for (Vec2& p : block.polygon.outer) p += system.origin;
    for (Ring& hole : block.polygon.holes)
      for (Vec2& p : hole) p += system.origin;
  }
  RC_ASSERT(GeosOracle().all_valid(system.blocks));
}

/// No two vertices of one block closer than the tolerance, unless a move would have turned a block over.
TEST(Cleaning, VerticesAreClustered) {
  std::size_t close = 0;
  for (int realization = 0; realization < 10; ++realization) {
    const BlockSystem system = cut(paper_tunnel(realization));
    for (const CutBlock& block : system.blocks) {
      const Ring& ring = block.polygon.outer;
      for (std::size_t k = 0; k < ring.size(); ++k) {
        for (std::size_t i = 0; i < k; ++i) close += norm(ring[k] - ring[i]) < 0.005;
      }
    }
  }
  EXPECT_EQ(close, 0u);
}

TEST(Cleaning, ASliverGoesToTheLongestBorder) {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  // A strip 4 mm wide between two joints, cut in two: the right piece borders above and below on different blocks.
  input.traces = {
      {{0, 5}, {10, 5}, {}}, {{0, 5.004}, {10, 5.004}, {}}, {{7, 0}, {7, 5}, {}}, {{4, 5.004}, {4, 10}, {}}};
  input.tolerances = CutTolerances{};
  input.tolerances->sliver_thickness = 2.5e-3;
  const BlockSystem system = cut(input);
  ASSERT_EQ(system.blocks.size(), 4u);
  EXPECT_EQ(system.statistics.merged_slivers, 1);
  EXPECT_NEAR(system.statistics.sliver_area, 0.04, 1e-9);
  // The strip is one block; it shares 7 m with the lower left, 6 m with the upper right one.
  EXPECT_NEAR(area(system.blocks[1].polygon), 35.0 + 0.04, 1e-9);
}

TEST(Cleaning, ASliverNeverCrossesAnOutline) {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  input.excavations = {{{2, 2}, {8, 2}, {8, 8}, {2, 8}}};
  input.traces = {{{0, 8.003}, {10, 8.003}, {}},
                  {{0, 2}, {10, 2}, {}},
                  {{3, 0}, {3, 10}, {}},
                  {{2, 8}, {2, 10}, {}},
                  {{8, 8}, {8, 10}, {}}};
  const BlockSystem system = cut(input);
  double inside = 0.0;
  for (const CutBlock& block : system.blocks) {
    if (!block.excavations.empty()) inside += area(block.polygon);
  }
  EXPECT_NEAR(inside, 36.0, 1e-7);
  EXPECT_GT(system.statistics.merged_slivers, 0);
}

TEST(Cleaning, CloseVerticesBecomeOneForAllBlocks) {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  // Two Ts 4 mm apart on either side of a joint, and a crossing 2 mm beside the corner of the domain.
  input.traces = {{{0, 5}, {10, 5}, {}},
                  {{4, 0}, {4, 5}, {}},
                  {{4.00390625, 5}, {4.00390625, 10}, {}},
                  {{0, 0.002}, {5, 5}, {}}};
  input.tolerances = CutTolerances{};
  input.tolerances->cluster = 0.005;
  const BlockSystem system = cut(input);
  EXPECT_EQ(system.statistics.merged_vertices, 2);
  EXPECT_EQ(mistake_of_shared_edges(system), "");
  EXPECT_NEAR(total_area(system), 100.0, 1e-10);
  std::set<std::pair<double, double>> corners;
  for (const CutBlock& block : system.blocks) {
    for (const Vec2 p : block.polygon.outer) corners.emplace(p.x, p.y);
  }
  EXPECT_TRUE(corners.contains({0.0, 0.0}));
  EXPECT_FALSE(corners.contains({0.0, 0.002}));
  EXPECT_NE(corners.contains({4.0, 5.0}), corners.contains({4.00390625, 5.0}));
}

TEST(Cleaning, ATongueAlongTheFrameIsClosed) {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  // A joint a hair above the bottom, on which another ends: without closing, one block would reach under the other.
  for (const double hair : {1e-12, 1e-9, 1e-6, 1e-4}) {
    input.traces = {{{0, hair}, {6, hair}, {}}, {{3, hair}, {3, 10}, {}}, {{6, 0}, {6, 10}, {}}};
    const BlockSystem system = cut(input);
    ASSERT_EQ(system.blocks.size(), 3u) << hair;
    std::vector<double> areas;
    for (const CutBlock& block : system.blocks) {
      EXPECT_EQ(block.polygon.outer.size(), 4u) << hair;
      areas.push_back(area(block.polygon));
    }
    std::sort(areas.begin(), areas.end());
    EXPECT_NEAR(areas[0], 30.0, 1e-6);
    EXPECT_NEAR(areas[2], 40.0, 1e-6);
  }
}

TEST(Cleaning, TheDomainKeepsItsCorners) {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10.0, 0.001}, {10.001, 0.002}, {10, 10}, {0, 10}};
  input.traces = {{{9.9985, -1}, {9.9985, 11}, {}}};
  const BlockSystem system = cut(input);
  EXPECT_NEAR(total_area(system), signed_area(input.domain), 1e-9 * 100.0);
}

// A million blocks of 1 m² between joints a metre apart are no slivers, however large the model is.
TEST(Tolerances, FollowTheSizeOfBlocksInLargeModels) {
  const CutTolerances large = CutTolerances::for_domain(1e6, 2e6);
  EXPECT_LT(large.sliver_area, 0.01);
  EXPECT_LT(large.sliver_thickness, 0.02);
  EXPECT_LT(large.cluster, 0.02);
  const CutTolerances few_joints = CutTolerances::for_domain(400.0, 1400.0);
  EXPECT_DOUBLE_EQ(few_joints.sliver_area, 1e-3);
  EXPECT_DOUBLE_EQ(few_joints.snapping, CutTolerances::for_domain(400.0).snapping);
}

Ring regular_polygon(Vec2 centre, double radius, int corners) {
  Ring ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / corners;
    ring.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return ring;
}

/// A rough joint from side to side, about the height y.
void add_rough_joint(CutInput& input, double y, int number) {
  const auto point = [&](int k) {
    return Vec2{0.1 * k, y + 0.3 * std::sin(0.06 * k + number) + 0.02 * std::sin(3.7 * k + number)};
  };
  for (int k = -1; k <= 100; ++k) {
    input.traces.push_back({point(k), point(k + 1), {TraceSource::Kind::trace_map, 0}, number});
  }
}

TEST(Cleaning, BothSidesOfARoughJointLoseTheSameVertices) {
  CutInput input;
  input.domain = square;
  for (int k = 0; k < 3; ++k) add_rough_joint(input, 2.5 * (k + 1), k);
  for (const double x : {2.03, 4.55, 7.18}) input.traces.push_back({{x, -1.0}, {x + 0.3, 11.0}, {}});
  const Ring island = regular_polygon({3.5, 6.2}, 0.4, 40);
  for (std::size_t k = 0; k < island.size(); ++k) {
    input.traces.push_back(
        {island[k], island[(k + 1) % island.size()], {TraceSource::Kind::trace_map, 0}, 3});
  }
  input.excavations = {regular_polygon({8.8, 1.0}, 0.6, 48)};
  std::size_t vertices = 0;
  for (const double collinear : {1e-7, 1e-3, 0.03, 0.1, 0.3, 2.0}) {
    input.tolerances = CutTolerances::for_domain(100.0);
    input.tolerances->collinear = collinear;
    const BlockSystem system = cut(input);
    EXPECT_EQ(mistake_of_shared_edges(system), "") << collinear;
    EXPECT_NEAR(total_area(system), 100.0, 1e-9) << collinear;
    expect_canonical(system);
    std::size_t count = 0;
    for (const CutBlock& block : system.blocks) count += block.polygon.outer.size();
    if (vertices > 0 && collinear <= 0.1) {
      EXPECT_LT(count, vertices) << collinear;
    }
    vertices = count;
  }
}

RC_GTEST_PROP(Cleaning, CoversTheDomainWhateverTheCollinearTolerance, ()) {
  CutInput input = random_input();
  for (int k = *rc::gen::inRange(0, 4); k > 0; --k)
    add_rough_joint(input, *rc::gen::inRange(1, 100) * 0.1, k);
  const double domain_area = signed_area(input.domain);
  input.tolerances = CutTolerances::for_domain(domain_area);
  double tiny = input.tolerances->collinear;
  input.tolerances->collinear = std::pow(10.0, -*rc::gen::inRange(0, 5));
  const BlockSystem system = cut(input);
  const double covered = GeosOracle().union_area(system.blocks);
  for (const CutBlock& block : system.blocks) tiny += 5e-7 * perimeter(block.polygon);
  RC_ASSERT(std::abs(covered - domain_area) < tiny);         // no gaps
  RC_ASSERT(std::abs(covered - total_area(system)) < tiny);  // no overlaps
  RC_ASSERT(GeosOracle().all_valid(system.blocks));
}

}  // namespace
}  // namespace keyblock::cutting
