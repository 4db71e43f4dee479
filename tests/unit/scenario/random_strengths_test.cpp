#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "rockmass/random_strength.h"
#include "scenario/joint_table.h"
#include "scenario/key_blocks.h"
#include "scenario_text.h"
#include "simulation/joint_laws.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using cutting::EdgeKind;
using cutting::EdgeLabel;
using testing::HasSubstr;

/// Two sets that cut the domain into many blocks, with a key of the first set.
std::string two_sets(const std::string& of_first = "", const std::string& of_second = "") {
  return R"(accept_warnings = ["plane-stress", "order-1", "lost-joints"]

[section]
azimuth = 90.0

[domain]
x = [0.0, 8.0]
y = [0.0, 6.0]

[rock]
density = 2600.0
young = 1e9
poisson = 0.2

[joints]
friction = 30.0

[[joint_set]]
name = "bedding"
dip = 20.0
dip_direction = 90.0
spacing = 0.5
length = { mean = 3.0, std = 1.0, distribution = "normal" }
gap = 0.0
)" + of_first +
         R"(
[[joint_set]]
name = "cross"
dip = 80.0
dip_direction = 270.0
spacing = 0.7
length = 5.0
gap = 0.2
)" + of_second +
         R"(
[time]
step = 0.01

[[stage]]
name = "settled"
kind = "settle"
)";
}

const std::string random_friction =
    "friction = { mean = 30.0, std = 4.0, distribution = \"normal\", min = 20.0, max = 40.0 }\n";

std::map<int, double> frictions(const simulation::RunSetup& setup) {
  std::map<int, double> found;
  for (std::size_t trace = 0; trace < setup.joints.joint_set_traces.at(0).size(); ++trace) {
    const int place = setup.joints.joint_set_traces[0][trace];
    if (place >= 0)
      found[static_cast<int>(trace)] =
          setup.joints.of_traces.at(static_cast<std::size_t>(place)).joint.friction;
  }
  return found;
}

TEST(RandomStrengths, DoNotMoveTheBlocks) {
  const auto with = build_blocks(parse(two_sets(random_friction)), 3),
             without = build_blocks(parse(two_sets()), 3);
  ASSERT_EQ(with.system.blocks.size(), without.system.blocks.size());
  EXPECT_GT(with.system.blocks.size(), 50U);
  for (std::size_t b = 0; b < with.system.blocks.size(); ++b) {
    EXPECT_EQ(with.system.blocks[b].polygon.outer, without.system.blocks[b].polygon.outer);
    EXPECT_EQ(with.system.blocks[b].labels, without.system.blocks[b].labels);
  }
}

/// A number for each piece of joint, the same on both sides of it wherever both sides kept the same vertices.
TEST(RandomStrengths, EdgesKnowTheirTrace) {
  const BlockModel model = build_blocks(parse(two_sets()), 3);
  std::map<std::pair<EdgeKind, int>, std::set<int>> traces;
  std::map<std::vector<double>, int> sides;
  int compared = 0;
  for (const auto& block : model.system.blocks) {
    const Ring& ring = block.polygon.outer;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const EdgeLabel label = block.labels[0][k];
      EXPECT_EQ(label.trace >= 0, label.kind == EdgeKind::joint_set);
      if (label.trace < 0) continue;
      traces[{label.kind, label.index}].insert(label.trace);
      const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
      const auto other = sides.find({b.x, b.y, a.x, a.y});
      if (other != sides.end()) {
        EXPECT_EQ(other->second, label.trace);
        ++compared;
      }
      sides[{a.x, a.y, b.x, b.y}] = label.trace;
    }
  }
  EXPECT_GT(compared, 20);
  EXPECT_GT((traces[{EdgeKind::joint_set, 0}].size()), 10U);
  EXPECT_GT((traces[{EdgeKind::joint_set, 1}].size()), 10U);
}

TEST(RandomStrengths, OfTracesAreLawsOfTheirSet) {
  const auto setup = build_setup(parse(two_sets(random_friction)), 3);
  const std::map<int, double> drawn = frictions(setup);
  ASSERT_GT(drawn.size(), 10U);
  std::set<double> values;
  for (const auto& [trace, friction] : drawn) {
    EXPECT_GE(friction, 20.0);
    EXPECT_LE(friction, 40.0);
    values.insert(friction);
    const int law = simulation::joint_law(setup, {EdgeKind::joint_set, 0, trace});
    EXPECT_NEAR(simulation::joint_laws(setup).at(static_cast<std::size_t>(law)).friction_coefficient,
                std::tan(friction * std::numbers::pi / 180.0), 1e-12);
  }
  EXPECT_EQ(values.size(), drawn.size());
  EXPECT_EQ(simulation::find_laws(setup, "bedding").size(), 1 + drawn.size());
  EXPECT_EQ(simulation::find_laws(setup, "cross").size(), 1U);
  record::Stage stage = setup.stages.back();
  stage.strength_factor = 2.0;
  stage.strength_of = {"bedding"};
  const auto laws = simulation::joint_laws(setup), reduced = simulation::laws_in_stage(setup, {}, stage);
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const bool is_of_bedding = simulation::set_of_law(setup, k) == 0;
    EXPECT_EQ(reduced[k], is_of_bedding ? laws[k].divided_by(2.0) : laws[k]) << k;
  }
  const auto& told = setup.joints.drawn.at(0);
  EXPECT_EQ(told.name(), "bedding.friction");
  EXPECT_EQ(told.traces, static_cast<int>(drawn.size()));
  EXPECT_EQ(told.least, *values.begin());
  EXPECT_EQ(told.largest, *values.rbegin());
}

TEST(RandomStrengths, OfATraceStayAsTheWindowGrows) {
  const std::string text = two_sets(random_friction);
  const auto values = [&](const std::vector<std::string>& overrides) {
    std::set<double> all;
    for (const auto& [trace, friction] : frictions(build_setup(parse(text, overrides), 0)))
      all.insert(friction);
    return all;
  };
  const std::set<double> small = values({}), large = values({"domain.x=[-1.0, 9.0]", "domain.y=[-1.0, 7.0]"});
  std::vector<double> common;
  std::ranges::set_intersection(small, large, std::back_inserter(common));
  EXPECT_GT(large.size(), small.size());
  EXPECT_GT(common.size(), small.size() - 4U) << "a trace at the rim may bound blocks in one of them alone";
}

TEST(RandomStrengths, PerLineAndPerRealization) {
  const auto with_per = [](const std::string& per) {
    return build_setup(
        parse(two_sets("friction = { mean = 30.0, std = 4.0, distribution = \"normal\", per = \"" + per +
                       "\" }\n")),
        1);
  };
  const auto line = with_per("line");
  std::set<double> of_lines;
  for (const auto& [trace, friction] : frictions(line)) of_lines.insert(friction);
  EXPECT_GT(of_lines.size(), 3U);
  EXPECT_LT(of_lines.size(), frictions(line).size()) << "traces of a line share theirs";
  EXPECT_EQ(line.joints.of_traces.size(), of_lines.size()) << "equal ones are one law";
  const auto whole = with_per("realization");
  EXPECT_TRUE(whole.joints.of_traces.empty());
  EXPECT_NE(whole.joints.joint_sets.at(0).friction, 30.0);
  EXPECT_EQ(whole.joints.drawn.at(0).mean, whole.joints.joint_sets[0].friction);
  EXPECT_EQ(whole.joints.joint_sets.at(1).friction, 30.0);
}

TEST(RandomStrengths, OfALatinHypercubeGoOverTheRealizationsOfTheStudy) {
  const std::string text =
      two_sets("friction = { mean = 30.0, std = 4.0, distribution = \"uniform\", per = \"realization\" }\n") +
      "[study]\nrealizations = 8\nsampling = \"latin_hypercube\"\n";
  const double half = 4.0 * std::sqrt(3.0);
  std::set<int> intervals;
  for (int realization = 0; realization < 8; ++realization) {
    const double friction = build_setup(parse(text), realization).joints.joint_sets.at(0).friction;
    intervals.insert(static_cast<int>(std::floor((friction - 30.0 + half) / (2.0 * half) * 8.0)));
  }
  EXPECT_EQ(intervals, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_THAT(mistakes(two_sets() + "[study.until]\nmeasure = \"fallen_area_m2\"\nwidth = "
                                    "1.0\n[study]\nsampling = \"latin_hypercube\"\n"),
              HasSubstr("study"));
}

TEST(RandomStrengths, ResidualIsNoMoreThanThePeakOfItsTrace) {
  const std::string text = two_sets(
      random_friction +
      "residual_friction = { mean = 29.0, std = 3.0, distribution = \"normal\" }\nweakening_slip = 0.01\n");
  const auto setup = build_setup(parse(text), 0);
  const auto& residual = setup.joints.drawn.at(1);
  EXPECT_EQ(residual.key, "residual_friction");
  EXPECT_GT(residual.capped, 0);
  EXPECT_LT(residual.capped, residual.traces);
  for (const auto& of : setup.joints.of_traces) {
    ASSERT_TRUE(of.joint.residual);
    EXPECT_LE(of.joint.residual->friction, of.joint.friction);
  }
  EXPECT_THAT(setup.warnings, testing::Contains(HasSubstr("have more left than their peak")));
}

TEST(RandomStrengths, OfACensusAreThoseOfTheRun) {
  const std::string open =
      two_sets(random_friction) +
      "[[excavation]]\nname = \"tunnel\"\nshape = \"circle\"\ncenter = [4.0, 3.0]\ndiameter = 3.0\n";
  const Scenario random = parse(open), strong = parse(open, {"joint_set.bedding.friction=30"});
  const auto factors = [](const Scenario& scenario) {
    std::vector<double> all;
    for (const auto& block : take_census(scenario, build_blocks(scenario, 1), 1.5).blocks)
      all.push_back(block.removal.factor());
    return all;
  };
  EXPECT_NE(factors(random), factors(strong));
}

TEST(RandomStrengths, MistakesAreTold) {
  const auto of_friction = [](const std::string& value) {
    return mistakes(two_sets("friction = " + value + "\n"));
  };
  EXPECT_THAT(of_friction("{ mean = 30, std = 3, distribution = \"normal\", min = 40, max = 20 }"),
              testing::AllOf(HasSubstr("joint_set.bedding.friction.max"), HasSubstr("a max above min")));
  EXPECT_THAT(of_friction("{ mean = 30, std = 3, distribution = \"normal\", min = 31 }"),
              HasSubstr("a mean from min to max"));
  EXPECT_THAT(of_friction("{ mean = 30, std = 3, distribution = \"normal\", max = 89.5 }"),
              HasSubstr("a number from 0 to 89"));
  EXPECT_THAT(of_friction("{ mean = 30, std = 3, distribution = \"normal\", per = \"trace\" }"),
              HasSubstr("\"realization\""));
  EXPECT_THAT(of_friction("{ mean = 30, distribution = \"normal\" }"), HasSubstr("std"));
  EXPECT_THAT(of_friction("{ mean = -3, std = 1, distribution = \"normal\" }"), HasSubstr("mean"));
  EXPECT_THAT(of_friction("\"strong\""), HasSubstr("friction"));
  EXPECT_THAT(mistakes(two_sets(random_friction + "residual_friction = 31\n")),
              HasSubstr("no more than the friction of the peak"));
  EXPECT_THAT(
      mistakes(two_sets() +
               "[[trace_map]]\nname = \"m\"\npoints = [[0, 1], [8, 1]]\ncohesion = { mean = 1e3, std = 1e2, "
               "distribution = \"normal\", per = \"line\" }\n"),
      HasSubstr("trace_map.m.cohesion.per"));
  EXPECT_THAT(mistakes(two_sets(), {"joints.friction={ mean = 30, std = 3, distribution = \"normal\" }"}),
              HasSubstr("joints.friction"));
}

TEST(RandomStrengths, AMeanThatMovesByTheCutIsWarnedOf) {
  EXPECT_THAT(
      warnings_of(two_sets("friction = { mean = 21.0, std = 5.0, distribution = \"normal\", min = 20.0 }\n")),
      testing::Contains(HasSubstr("joint_set.bedding.friction: cut off at 20 and 89, its mean is")));
}

}  // namespace
}  // namespace keyblock::scenario
