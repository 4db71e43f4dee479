#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "rockmass/intensity.h"
#include "scenario/build.h"
#include "scenario/expected_blocks.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using cutting::EdgeKind;
using cutting::EdgeLabel;
using testing::AllOf;
using testing::HasSubstr;

double total_area(const cutting::BlockSystem& system) {
  double sum = 0.0;
  for (const auto& block : system.blocks) sum += area(block.polygon);
  return sum;
}

TEST(BuildBlocks, FillTheDomainAndKnowTheirEdges) {
  const BlockModel model = build_blocks(parse(runnable_domain), 0);
  EXPECT_GT(model.system.blocks.size(), 3U);
  EXPECT_NEAR(total_area(model.system), 12.0, 1e-9);
  bool joint = false, outline = false, domain = false;
  double excavated = 0.0;
  for (const auto& block : model.system.blocks) {
    if (!block.excavations.empty()) excavated += area(block.polygon);
    for (const auto& ring : block.labels) {
      for (const EdgeLabel label : ring) {
        joint = joint || label == EdgeLabel{EdgeKind::joint_set, 0};
        outline = outline || label == EdgeLabel{EdgeKind::excavation, 0};
        domain = domain || label.kind == EdgeKind::domain;
      }
    }
  }
  EXPECT_TRUE(joint && outline && domain);
  EXPECT_NEAR(excavated, std::abs(signed_area(model.outlines[0])), 1e-3);
}

TEST(BuildBlocks, RealizationsDifferAndAreRepeated) {
  const Scenario s = parse(runnable_domain);
  const BlockModel first = build_blocks(s, 0), again = build_blocks(s, 0), other = build_blocks(s, 1);
  ASSERT_EQ(first.traces.size(), again.traces.size());
  EXPECT_EQ(first.traces[0].a, again.traces[0].a);
  EXPECT_FALSE(first.traces.size() == other.traces.size() && first.traces[0].a == other.traces[0].a);
}

const std::string persistent_sets = jointed_domain + R"(
[[joint_set]]
name = "cross"
dip = 70.0
dip_direction = 90.0
spacing = 0.1
length = 100.0
gap = 0
)";

TEST(BuildBlocks, FarTooManyAreRefusedBeforeTheyAreCut) {
  const auto text = [](double spacing) { return "joint_set.cross.spacing=" + std::to_string(spacing); };
  const std::vector<std::string> dense{"joint_set.bedding.length=100", "joint_set.bedding.gap=0",
                                       "joint_set.bedding.spacing=0.0008", text(0.0008)};
  EXPECT_THAT(refusal(parse(persistent_sets, dense)),
              AllOf(HasSubstr("domain: found joints that cut it into"),
                    HasSubstr("unknowns (an estimate); expected at most 2e+07 unknowns")));
}

TEST(BuildBlocks, AreNotExpectedToBeMoreThanThereAre) {
  for (const double length : {0.3, 1.0, 100.0}) {
    Scenario s = parse(persistent_sets, {"joint_set.bedding.spacing=0.05"});
    for (JointSetSpec& spec : s.joint_sets) spec.set.length.mean = length;
    const BlockModel model = build_blocks(s, 0);
    for (const bool twice : {false, true}) {
      std::vector<rockmass::Trace> traces = model.traces;
      if (twice) traces.insert(traces.end(), model.traces.begin(), model.traces.end());
      double sum = 0.0;
      for (const auto& trace : traces) sum += rockmass::length_inside(trace, s.domain->box());
      const double expected =
          expected_blocks(traces, s.domain->box(), cutting::CutTolerances::for_domain(12.0, sum));
      const double count = static_cast<double>(model.system.blocks.size());
      EXPECT_LT(expected, 1.1 * count) << length << ' ' << twice;
      if (length == 100.0 && !twice) {
        EXPECT_GT(expected, 0.8 * count);
      }
    }
  }
}

TEST(BuildBlocks, NeedNoStages) {
  const Scenario s = parse(jointed_domain);
  EXPECT_GT(build_blocks(s, 0).system.blocks.size(), 1U);
  EXPECT_THAT(refusal(s), HasSubstr("stage: found nothing; expected at least one [[stage]]"));
}

TEST(BuildBlocks, ExplicitBlocksComeLastWithFreeEdges) {
  const Scenario s =
      parse(runnable_domain +
            "[[block]]\nname = \"plug\"\nouter = [[1.8, 1.3], [1.8, 1.6], [2.1, 1.6], [2.1, 1.3]]\n");
  const BlockModel model = build_blocks(s, 0);
  const cutting::CutBlock& plug = model.system.blocks.back();
  EXPECT_NEAR(area(plug.polygon), 0.09, 1e-12);
  EXPECT_EQ(plug.excavations, std::vector{0});
  EXPECT_EQ(plug.labels, (std::vector<std::vector<EdgeLabel>>{std::vector<EdgeLabel>(4)}));
  EXPECT_EQ(build_setup(s, 0).properties.back().name, "plug");
}

const std::string lined_opening = R"([rock]
density = 2600.0
young = 1e9
poisson = 0.2
[joints]
friction = 30.0
[[block]]
name = "base"
outer = [[-6, -3], [6, -3], [6, -2], [-6, -2]]
fixed = true
[[block]]
name = "pipe"
outer = [[-2, -2], [2, -2], [2, 2], [-2, 2]]
holes = [[[-1, -1], [1, -1], [1, 1], [-1, 1]]]
[[block]]
name = "fill"
outer = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
[[excavation]]
name = "bore"
shape = "polygon"
outer = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
)";

TEST(BuildBlocks, AnExplicitBlockIsExcavatedWhereItLiesInTheOutline) {
  const auto excavated = [](const std::vector<std::string>& overrides = {}) {
    std::string names;
    const Scenario s = parse(lined_opening, overrides);
    const auto blocks = build_blocks(s, 0).system.blocks;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      names += blocks[b].excavations.empty() ? "" : s.blocks[b].name;
    return names;
  };
  EXPECT_EQ(excavated(), "fill");  // the pipe has its centroid in its hole
  // Coordinates with a few digits.
  EXPECT_EQ(excavated({"excavation.bore.outer=[[-1.0001, -1], [1, -1], [1, 1.0001], [-1, 1]]"}), "fill");
  EXPECT_EQ(excavated({"excavation.bore.outer=[[-0.9999, -1], [1, -1], [1, 0.9999], [-1, 1]]"}), "fill");
  EXPECT_EQ(excavated({"block.fill.outer=[[-0.5, 0], [0, -0.5], [0.5, 0], [0, 0.5]]"}), "fill");
  EXPECT_EQ(excavated({"excavation.bore.outer=[[2, -2], [4, -2], [4, 2], [2, 2]]"}), "");
}

TEST(BuildBlocks, AnOutlineThroughAnExplicitBlockIsAMistake) {
  EXPECT_THAT(
      mistakes(lined_opening, {"excavation.bore.outer=[[-1, -1], [1, -1], [1, 2], [-1, 2]]"}),
      HasSubstr("test.toml:13:9: block.pipe.outer: found a block, of which 16.7 % lie in excavation.bore; "
                "expected all or nothing of it"));
  // However small a part of a large block it is.
  EXPECT_THAT(mistakes(lined_opening, {"block.pipe.outer=[[-200, -2], [200, -2], [200, 200], [-200, 200]]",
                                       "excavation.bore.outer=[[-1, -1], [1, -1], [1, 2], [-1, 2]]"}),
              HasSubstr("found a block, of which 0.00248 % lie in excavation.bore"));
}

TEST(BuildBlocks, WhatIsFixedIsNotExcavated) {
  EXPECT_THAT(
      mistakes(lined_opening, {"block.fill.fixed=true"}),
      HasSubstr("block.fill.outer: found a fixed block, of which 100 % lie in excavation.bore; expected"));
  EXPECT_THAT(mistakes(lined_opening, {"excavation.bore.outer=[[5, -4], [7, -4], [7, 4], [5, 4]]"}),
              HasSubstr("block.base.outer: found a fixed block, of which 8.33 % lie in excavation.bore"));
}

TEST(BuildBlocks, WhatTheCutterRefusesHasItsPlace) {
  EXPECT_THAT(refusal(parse(runnable_domain, {"excavation.tunnel.diameter=1e-300"})),
              HasSubstr("/test.toml:29:1: excavation.tunnel: found a ring that"));
}

TEST(BuildBlocks, TracesOfAMapThatIsFarAway) {
  const Scenario s = parse_scenario(examples / "05-trace-map.toml");
  const auto setup = build_setup(s, 0);
  EXPECT_GT(norm(setup.system.origin), 6e6);
  EXPECT_NEAR(total_area(setup.system), 12.0 * 22.0, 1e-6);
  EXPECT_NEAR((setup.domain.min + setup.system.origin).x, 466002.0, 1e-9);
  EXPECT_LT(norm(setup.excavations[0].outline[0]), 100.0);
  EXPECT_NEAR((setup.excavations[0].outline[0] + setup.system.origin).y, 6691588.5, 1e-6);
  EXPECT_EQ(setup.trace_map_names, std::vector<std::string>{"KB11"});
  EXPECT_EQ(setup.joints.trace_maps[0].friction, 30.0);
  EXPECT_NEAR(setup.in_situ->reference_y + setup.system.origin.y, 6691600.0, 1e-6);
}

TEST(BuildBlocks, ExplicitBlocksThatAreFarAwayTakeAllThatActsAlong) {
  const std::string far = R"([rock]
density = 2600.0
young = 1e9
poisson = 0.2
[time]
step = 0.01
[[block]]
name = "b"
outer = [[500000, 6000000], [500001, 6000000], [500001, 6000001], [500000, 6000001]]
[[load]]
block = "b"
from = [500000, 6000001]
to = [500001, 6000001]
traction = [0, -1]
[[support]]
block = "b"
points = [[500000, 6000000], [500001, 6000000]]
[[history]]
name = "h"
point = [500000.5, 6000000.5]
[[stage]]
name = "s"
kind = "settle"
)";
  const auto setup = build_setup(parse(far), 0);
  EXPECT_EQ(setup.system.origin, (Vec2{500000.0, 6000000.0}));
  EXPECT_EQ(setup.system.blocks[0].polygon.outer[2], (Vec2{1.0, 1.0}));
  EXPECT_EQ(setup.loads[0].to, (Vec2{1.0, 1.0}));
  EXPECT_EQ(setup.supports[0].points[1], (Vec2{1.0, 0.0}));
  EXPECT_EQ(setup.histories[0].point, (Vec2{0.5, 0.5}));
}

}  // namespace
}  // namespace keyblock::scenario
