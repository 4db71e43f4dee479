// Joints of their own between two blocks, as a scenario says them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "guide_snippet.h"
#include "scenario/ground_facts.h"
#include "scenario/own_joints.h"
#include "simulation/joint_records.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string contact = "interface=[{between=['top', 'base'], friction=20, cohesion=1e3}]";

TEST(Interface, IsLikeAJointSetWithoutTraces) {
  const simulation::RunSetup setup = build_setup(parse(two_blocks, {contact}), 0, nullptr);
  EXPECT_THAT(setup.joint_set_names, ElementsAre("top-base"));
  ASSERT_EQ(setup.joints.joint_sets.size(), 1U);
  EXPECT_EQ(setup.joints.joint_sets[0].friction, 20.0);
  EXPECT_EQ(setup.joints.joint_sets[0].cohesion, 1e3);
  EXPECT_EQ(setup.joints.standard.cohesion, 0.0);
  ASSERT_EQ(setup.system.interfaces.size(), 1U);
  EXPECT_EQ(setup.system.interfaces[0].low, 0U);
  EXPECT_EQ(setup.system.interfaces[0].high, 1U);
}

// The base is wider: half of its edge is free.
TEST(Interface, IsTheLabelOfEdgesThatLieAlongIt) {
  const cutting::BlockSystem system =
      build_blocks(parse(two_blocks, {contact, "block.top.outer=[[1, 1], [2, 1], [2, 2], [1, 2]]"}), 0)
          .system;
  const auto labels = [&](std::size_t block) {
    int count = 0;
    for (const cutting::EdgeLabel label : system.blocks[block].labels[0])
      count += label == system.interfaces[0].joint ? 1 : 0;
    return count;
  };
  EXPECT_EQ(labels(0), 0);
  EXPECT_EQ(labels(1), 1);
}

// Whichever of the edges has its label: one, both, or none of them.
TEST(Interface, HasTheLengthAlongWhichBlocksTouch) {
  const auto length = [](const std::string& top) {
    const auto setup = build_setup(parse(two_blocks, {contact, "block.top.outer=" + top}), 0, nullptr);
    return simulation::joint_records(setup).at(0).length;
  };
  EXPECT_DOUBLE_EQ(length("[[1, 1], [2, 1], [2, 2], [1, 2]]"), 1.0);
  EXPECT_DOUBLE_EQ(length("[[0, 1], [4, 1], [4, 2], [0, 2]]"), 4.0);
  EXPECT_DOUBLE_EQ(length("[[3, 1], [6, 1], [6, 2], [3, 2]]"), 1.0);
}

TEST(Interface, ComesAfterJointSetsAndBeforeTraceMaps) {
  const Scenario scenario =
      parse(jointed_domain,
            {"trace_map=[{name='fault', points=[[0, 1], [4, 1]]}]",
             "block=[{name='a', outer=[[5, 0], [6, 0], [6, 1]]}, {name='b', outer=[[5, 2], [6, 2], [6, 3]]}]",
             "interface=[{between=['a', 'b'], name='mortar'}]"});
  EXPECT_THAT(names_of(own_joints(scenario)), ElementsAre("bedding", "mortar", "fault"));
}

// Strengths of joints say where slivers go; an interface is not among them.
TEST(Interface, ChangesNoBlockOfADomain) {
  const std::string blocks =
      "block=[{name='a', outer=[[5, 0], [6, 0], [6, 1]]}, {name='b', outer=[[5, 2], [6, 2], [6, 3]]}]";
  const std::vector<std::string> denser{blocks, "joint_set.bedding.spacing=0.05",
                                        "joint_set.bedding.dip_std=9.0"};
  std::vector<std::string> with = denser;
  with.emplace_back("interface=[{between=['a', 'b'], friction=5}]");
  const cutting::BlockSystem one = build_blocks(parse(jointed_domain, denser), 0).system,
                             other = build_blocks(parse(jointed_domain, with), 0).system;
  EXPECT_GT(one.statistics.merged_slivers, 0);
  ASSERT_EQ(one.blocks.size(), other.blocks.size());
  for (std::size_t b = 0; b < one.blocks.size(); ++b)
    EXPECT_EQ(one.blocks[b].polygon.outer, other.blocks[b].polygon.outer);
}

TEST(Interface, HasItsNameWhereJointsAreNamed) {
  const std::vector<std::string> more{contact, "stage.quiet.strength_factor=1.5",
                                      "stage.quiet.strength_of=['top-base']",
                                      "water={head=1.5, sets=['top-base']}"};
  const Scenario scenario = parse(two_blocks, more);
  EXPECT_THAT(scenario.stages[0].strength_of, ElementsAre("top-base"));
  EXPECT_THAT(ground_facts(scenario), Contains(testing::Field(&GroundFact::name, HasSubstr("interface"))));
}

TEST(Interface, OfBlocksThatDoNotTouchIsOdd) {
  EXPECT_THAT(warnings_of(two_blocks, {contact}), Not(Contains(HasSubstr("no edge of"))));
  EXPECT_THAT(warnings_of(two_blocks, {contact, "block.top.outer=[[1, 1.5], [3, 1.5], [3, 2], [1, 2]]"}),
              Contains(HasSubstr("interface[0] (--set): no edge of 'base' lies on one of 'top'")));
}

TEST(Interface, StrengthIsLookedAtAsThatOfSets) {
  EXPECT_THAT(
      warnings_of(two_blocks, {"interface=[{between=['top', 'base'], cohesion=1e3, strength_factor=1.2}]"}),
      Contains(HasSubstr("its cohesion is lost contact by contact")));
  EXPECT_THAT(warnings_of(two_blocks, {"interface=[{between=['top', 'base'], dry=true}]"}),
              Contains(HasSubstr("interface[0].dry: there is no [water]")));
}

// What the guide shows is right.
TEST(Interface, OfTheGuide) {
  std::string text = two_blocks;
  for (const auto& [name, other] : {std::pair("base", "rock"), std::pair("top", "dam")})
    text.replace(text.find(name), std::string(name).size(), other);
  const Scenario scenario = parse(text + snippet("[[interface]]"));
  ASSERT_EQ(scenario.interfaces.size(), 1U);
  EXPECT_EQ(scenario.interfaces[0].name, "foot");
  EXPECT_EQ(scenario.interfaces[0].joints.residual_cohesion, 0.2e6);
}

}  // namespace
}  // namespace keyblock::scenario
