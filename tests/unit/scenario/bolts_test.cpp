#include "scenario/bolts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/read_file.h"
#include "scenario/build.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double one_degree = std::numbers::pi / 180.0;

/// A circle of radius 2 about (1, 1) by many edges.
Ring round_outline() {
  Ring ring;
  for (int k = 0; k < 720; ++k)
    ring.push_back(Vec2{1.0, 1.0} +
                   2.0 * Vec2{std::cos(0.5 * k * one_degree), std::sin(0.5 * k * one_degree)});
  return ring;
}

/// Degrees about the centre, where heads are.
std::vector<double> head_angles(const BoltSpec& spec) {
  std::vector<double> all;
  for (const auto& [head, toe] : pattern_of(spec, round_outline())) {
    const Vec2 out = head - Vec2{1.0, 1.0}, axis = toe - head;
    EXPECT_NEAR(norm(out), 2.0, 1e-4);
    EXPECT_NEAR(norm(axis), spec.length, 1e-12);
    EXPECT_NEAR(dot(out, axis) / (norm(out) * norm(axis)), 1.0, 1e-4);
    all.push_back(std::atan2(out.y, out.x) / one_degree);
  }
  return all;
}

void expect_angles(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 0.01) << k;
}

TEST(BoltPattern, IsEvenAlongTheArc) {
  BoltSpec spec;
  spec.length = 3.0;
  spec.arc = {30.0, 150.0};
  spec.count = 5;
  expect_angles(head_angles(spec), {30.0, 60.0, 90.0, 120.0, 150.0});
  spec.count = 1;
  expect_angles(head_angles(spec), {90.0});
  spec.count.reset();
  spec.spacing_along = 2.0 * 50.0 * one_degree;
  expect_angles(head_angles(spec), {40.0, 90.0, 140.0});
  spec.arc = {-60.0, 60.0};
  spec.spacing_along = 2.0 * 59.9 * one_degree;
  expect_angles(head_angles(spec), {-59.9, 0.0, 59.9});
  spec.spacing_along = 2.0 * 60.0 * one_degree;  // the outline is shorter than its arc
  expect_angles(head_angles(spec), {-60.0, 0.0, 60.0});
  spec.arc.reset();
  spec.spacing_along.reset();
  spec.count = 4;
  expect_angles(head_angles(spec), {45.0, 135.0, -135.0, -45.0});
}

const std::string bolted_rock = R"(
[rock]
density = 2600.0
young = 1.0e10
poisson = 0.2
[joints]
friction = 30.0
[time]
step = 0.002
[domain]
x = [-5.0, 5.0]
y = [-5.0, 5.0]
[[trace_map]]
name = "roof"
points = [[-5.0, 2.5], [5.0, 2.5]]
[[excavation]]
name = "tunnel"
shape = "circle"
center = [0.0, 0.0]
diameter = 3.0
[[bolt]]
name = "crown"
excavation = "tunnel"
arc = [60.0, 120.0]
count = 3
length = 2.5
diameter = 0.025
yield = 245.0e3
grout_stiffness = 8.0e9
grout_strength = 400.0e3
[[stage]]
name = "open"
kind = "settle"
excavate = ["tunnel"]
[[stage]]
name = "support"
kind = "settle"
install = ["crown"]
)";

std::vector<std::string> bolt_warnings(const std::vector<std::string>& overrides) {
  std::vector<std::string> all;
  build_setup(parse(bolted_rock, overrides), 0, &all);
  std::erase_if(all, [](const std::string& text) { return !text.starts_with("bolt"); });
  return all;
}

std::string bolt_mistake(const std::vector<std::string>& overrides) {
  try {
    build_setup(parse(bolted_rock, overrides), 0);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Bolts, ArePlacedByThePattern) {
  const simulation::RunSetup setup = build_setup(parse(bolted_rock), 0);
  ASSERT_EQ(setup.bolts.size(), 3u);
  EXPECT_EQ(setup.bolts[2].name, "crown.3");
  EXPECT_EQ(setup.bolts[2].list, "crown");
  EXPECT_EQ(setup.bolts[2].staged, 0);
  EXPECT_NEAR(setup.bolts[0].area, 0.25 * std::numbers::pi * 0.025 * 0.025, 1e-18);
  EXPECT_EQ(setup.bolts[0].grouted, std::pair(0.0, 2.5));
  EXPECT_NEAR(setup.bolts[0].active_length, 0.05, 1e-15);
  EXPECT_THAT(setup.staged_supports, ::testing::ElementsAre("crown"));
  EXPECT_THAT(bolt_warnings({}), IsEmpty());
}

// They wait for a stage that does not come (Install.ASpringThatAStageWouldInstallLaterIsNotThere).
TEST(Bolts, ThatAreNotPresentAreInstalledByNoStage) {
  const simulation::RunSetup setup = build_setup(parse(bolted_rock, {"bolt.crown.present=false"}), 0);
  ASSERT_EQ(setup.bolts.size(), 3u);
  EXPECT_EQ(setup.bolts[0].staged, 0);
  EXPECT_THAT(setup.staged_supports, ::testing::ElementsAre("crown"));
  EXPECT_THAT(setup.stages[1].install, IsEmpty());
  EXPECT_THAT(bolt_warnings({"bolt.crown.present=false"}), IsEmpty());
  EXPECT_EQ(bolt_mistake({"bolt.crown.present=false", "bolt.crown.pretension=1e4"}), "");
}

TEST(Bolts, ThatAnEmptyListDoesNotLeaveOutAreToldOf) {
  std::vector<std::string> all;
  build_setup(parse(bolted_rock, {"stage.support.install=[]"}), 0, &all);
  EXPECT_THAT(all, Contains(HasSubstr("installs nothing, and crown is there from the start")));
  all.clear();
  build_setup(parse(bolted_rock, {"stage.support.install=[]", "bolt.crown.present=false"}), 0, &all);
  EXPECT_THAT(all, Not(Contains(HasSubstr("installs nothing"))));
}

TEST(Bolts, ThatCannotBeAreRefusedWhereTheyAreWritten) {
  EXPECT_THAT(bolt_mistake({"bolt.crown.length=6"}),
              HasSubstr("bolt.crown.length: found the toe of crown.1 at ["));
  const std::string one =
      "bolt=[{name='one', from=[0, 0.2], to=[0, 4], diameter=0.025, grout_stiffness=1e9}]";
  EXPECT_THAT(
      bolt_mistake({one, "stage.support.install=['one']"}),
      HasSubstr("bolt.one.from: found the head of one at [0, 0.2], in no rock; expected a point of rock"));
  EXPECT_THAT(bolt_mistake({"bolt.crown.pretension=1e4", "stage.support.install=[]"}),
              HasSubstr("bolt.crown.pretension: found pretension of a bolt that no stage installs"));
  EXPECT_THAT(bolt_mistake({"bolt.crown.arc=[10.0, 10.001]", "bolt.crown.count=2"}), "");
}

// What the guide shows is in the example, which is run.
TEST(Bolts, OfTheGuideAreThoseOfTheExample) {
  const std::string guide = read_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs/guide/support.md"),
                    example = read_file(examples / "12-bolted-tunnel.toml"), fence = "```toml\n";
  const std::size_t begin = guide.find(fence) + fence.size(), end = guide.find("```", begin);
  const std::string shown = guide.substr(begin, end - begin);
  const std::size_t stage = shown.find("[[stage]]");
  ASSERT_NE(stage, std::string::npos);
  EXPECT_THAT(example, HasSubstr(shown.substr(0, stage)));
  EXPECT_THAT(example, HasSubstr(shown.substr(stage)));
  EXPECT_EQ(build_setup(parse_scenario(examples / "12-bolted-tunnel.toml"), 0).bolts.size(), 9u);
}

TEST(Bolts, ThatSeemOddAreToldOf) {
  EXPECT_THAT(bolt_warnings({"bolt.crown.length=0.5"}),
              Contains(HasSubstr("bolt.crown: 3 of 3 bolts cross no joint, and do nothing")));
  const std::string across =
      "bolt=[{name='one', from=[0, -4], to=[0, 4], diameter=0.025, grout_stiffness=1e9}]";
  EXPECT_THAT(bolt_warnings({across, "stage.support.install=['one']"}),
              Contains(HasSubstr("bolt.one: one crosses an opening; its bar is free there")));
  EXPECT_THAT(
      bolt_warnings({across, "stage.support.install=[]", "stage.open.install=[]"}),
      Contains(HasSubstr("bolt.one: one crosses rock that the stage 'open' excavates, and ends there")));
}

TEST(Bolts, WithoutALimitAreToldOf) {
  const std::string bar =
      "{name='crown', excavation='tunnel', arc=[60, 120], count=3, length=2.5, diameter=0.025";
  EXPECT_THAT(bolt_warnings({"bolt=[" + bar + ", grout_stiffness=8e9}]"}),
              ::testing::ElementsAre(HasSubstr(
                  "its bar never yields, without yield, and its grout never slips, without grout_strength")));
  EXPECT_THAT(bolt_warnings({"bolt=[" + bar + ", yield=245e3, grout_stiffness=8e9}]"}),
              ::testing::ElementsAre(HasSubstr("crown: its grout never slips, without grout_strength;")));
  EXPECT_THAT(bolt_warnings({"bolt=[" + bar + ", kind='anchored'}]"}),
              ::testing::ElementsAre(HasSubstr("crown: its bar never yields, without yield;")));
}

// The plate of a bolt whose ends are exchanged holds rock in its middle, and the grout of the far side counts for nothing.
TEST(Bolts, WithTheHeadInsideOfTheRockAreToldOf) {
  const std::string keys = ", diameter=0.025, yield=245e3, grout_stiffness=1e9, grout_strength=4e5}]";
  const std::string install = "stage.support.install=['one']";
  EXPECT_THAT(bolt_warnings({"bolt=[{name='one', from=[0, 1.5], to=[0, 4]" + keys, install}), IsEmpty());
  EXPECT_THAT(
      bolt_warnings({"bolt=[{name='one', from=[0, 4], to=[0, 1.5]" + keys, install}),
      ::testing::ElementsAre(HasSubstr("the plate of one lies 1 m inside of the rock; `from` is the head")));
  EXPECT_THAT(bolt_warnings({"bolt=[{name='one', from=[0, 4], to=[0, 1.5], plate=false" + keys, install}),
              IsEmpty());
}

TEST(Bolts, OfAnOpeningThatIsNotThereYetAreToldOf) {
  const auto before = Contains(HasSubstr("bolt.crown: is installed before excavation.tunnel is excavated"));
  EXPECT_THAT(bolt_warnings({"stage.support.install=[]"}), before);
  EXPECT_THAT(bolt_warnings({"stage.support.install=[]", "stage.open.install=['crown']"}), IsEmpty());
  EXPECT_THAT(bolt_warnings({"stage=[{name='first', kind='settle', install=['crown']}, {name='open', "
                             "kind='settle', excavate=['tunnel']}]"}),
              before);
}

TEST(Bolts, InOtherUnitsAreToldOf) {
  const auto told = [](const char* change) { return bolt_warnings({change}); };
  EXPECT_THAT(told("bolt.crown.yield=245"), Contains(HasSubstr("was it in kN? That is 2.45e+05 N")));
  EXPECT_THAT(told("bolt.crown.rupture_strain=10"), Contains(HasSubstr("was it in percent? That is 0.1")));
  EXPECT_THAT(told("bolt.crown.diameter=0.25"), Contains(HasSubstr("usual is")));
  EXPECT_THAT(told("bolt.crown.grout_strength=400"), Contains(HasSubstr("was it in kN per m?")));
  EXPECT_THAT(told("bolt.crown.grout_stiffness=8e3"), Contains(HasSubstr("was it in MN/m per m?")));
  EXPECT_THAT(told("bolt.crown.young=210"), Contains(HasSubstr("was it in GPa?")));
}

}  // namespace
}  // namespace keyblock::scenario
