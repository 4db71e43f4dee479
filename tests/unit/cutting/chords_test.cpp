#include "verification/chords.h"

#include <gtest/gtest.h>

#include <numbers>

#include "check_blocks.h"
#include "cutting/cut.h"
#include "geos_oracle.h"
#include "tunnel.h"

namespace keyblock::cutting {
namespace {

using rockmass::Trace;
using verification::Chords;

class EveryWindow : public testing::TestWithParam<int> {};

Chords problem(int number) {
  return {27, static_cast<std::uint32_t>(number)};
}

TEST_P(EveryWindow, FacesByEuler) {
  for (int k = 0; k < 50; ++k) {
    const Chords c = problem(50 * GetParam() + k);
    const BlockSystem system = cut(c.input());
    EXPECT_EQ(system.blocks.size(), c.faces());
    EXPECT_NEAR(total_area(system), signed_area(c.window), 1e-12 * signed_area(c.window));
    EXPECT_EQ(system.statistics.removed_length, 0.0);
    EXPECT_EQ(system.statistics.joints_used, static_cast<int>(c.chords.size()));
    EXPECT_EQ(mistake_of_shared_edges(system), "");
    expect_canonical(system);
  }
}

TEST_P(EveryWindow, EndsAHairOffTheFrame) {
  for (int k = 0; k < 10; ++k) {
    const Chords c = problem(50 * GetParam() + k);
    for (const double off : {-1e-4, -1e-7, -1e-12, -1e-17, 1e-17, 1e-12, 1e-7, 1e-4}) {
      CutInput input = c.input();
      input.tolerances->snapping = 1e-3;
      for (Trace& t : input.traces) {
        const Vec2 d = off * normalized(t.b - t.a);
        t.a -= d;
        t.b += d;
      }
      const BlockSystem system = cut(input);
      EXPECT_EQ(system.blocks.size(), c.faces()) << off;
      EXPECT_NEAR(total_area(system), signed_area(c.window), 1e-12 * signed_area(c.window));
      EXPECT_EQ(mistake_of_shared_edges(system), "");
    }
  }
}

TEST_P(EveryWindow, DuplicatesOverlapsAndDeadEndsAddNothing) {
  for (int k = 0; k < 10; ++k) {
    const Chords c = problem(50 * GetParam() + k);
    CutInput input = c.input();
    for (const Trace& t : c.chords) {
      input.traces.push_back({t.b, t.a, t.source});
      input.traces.push_back({lerp(t.a, t.b, 0.25), lerp(t.a, t.b, 0.75), t.source});
      // A dead end that begins on the chord, and a joint alone in the rock.
      const Vec2 m = lerp(t.a, t.b, 0.5), n = 1e-4 * normalized(perpendicular(t.b - t.a));
      input.traces.push_back({m, m + n, t.source});
      input.traces.push_back({m + 2.0 * n, m + 3.0 * n, t.source});
    }
    const BlockSystem system = cut(input);
    EXPECT_EQ(system.blocks.size(), c.faces());
    // A dead end may happen to cross another chord or the frame: its pieces still count as removed.
    EXPECT_GE(system.statistics.removed_pieces, static_cast<int>(c.chords.size()));
    EXPECT_NEAR(total_area(system), signed_area(c.window), 1e-12 * signed_area(c.window));
    EXPECT_EQ(mistake_of_shared_edges(system), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Windows, EveryWindow, testing::Range(0, 4));

TEST(Chords, ManyLinesThroughOneNode) {
  for (const int n : {3, 7, 40, 200}) {
    CutInput input;
    input.domain = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const Vec2 node{0.1, 0.07};
    for (int k = 0; k < n; ++k) {
      const double angle = std::numbers::pi * (k + 0.31) / n;
      const Vec2 d{4.0 * std::cos(angle), 4.0 * std::sin(angle)};
      input.traces.push_back({node - d, node + d, {}});
    }
    // In exact arithmetic the lines meet in one point, in rounded coordinates near it; clustering makes them meet.
    input.tolerances = CutTolerances{};
    input.tolerances->cluster = 1e-9;
    const BlockSystem system = cut(input);
    EXPECT_EQ(system.blocks.size(), static_cast<std::size_t>(2 * n));
    EXPECT_NEAR(total_area(system), 4.0, 4e-12);
    EXPECT_EQ(mistake_of_shared_edges(system), "");
  }
}

TEST(Chords, TunnelAsThePolygonizerOfALibrarySeesIt) {
  for (int realization = 0; realization < 5; ++realization) {
    CutInput input = paper_tunnel(realization);
    input.tolerances = CutTolerances{};
    std::vector<Trace> lines = input.traces;
    for (const Ring& ring : {input.domain, input.excavations[0]}) {
      for (std::size_t k = 0; k < ring.size(); ++k)
        lines.push_back({ring[k], ring[(k + 1) % ring.size()], {}});
    }
    const std::vector<double> expected = GeosOracle().face_areas(lines, {{-10, -10}, {10, 10}});
    std::vector<double> found;
    for (const CutBlock& block : cut(input).blocks) found.push_back(area(block.polygon));
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-9);
  }
}

}  // namespace
}  // namespace keyblock::cutting
