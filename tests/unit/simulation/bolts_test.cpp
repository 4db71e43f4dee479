#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../hung_block.h"
#include "../one_step.h"
#include "../resumed_run.h"
#include "core/error.h"
#include "simulation/build_bolts.h"
#include "simulation/elements.h"
#include "simulation/runner.h"
#include "solve/law_updates.h"

namespace keyblock::simulation {
namespace {

/// A bolt of 25 mm in good grout.
loading::Bolt grouted(Vec2 head, Vec2 toe) {
  loading::Bolt bolt;
  bolt.name = bolt.list = "bolt";
  bolt.head = head;
  bolt.toe = toe;
  bolt.area = 4.908762e-4;
  bolt.grout_stiffness = 1e10;
  bolt.grout_strength = 7e5;
  bolt.grouted = {0.0, bolt.length()};
  bolt.active_length = 0.05;
  bolt.has_plate = false;
  return bolt;
}

loading::Bolt anchored(Vec2 head, Vec2 toe) {
  loading::Bolt bolt = grouted(head, toe);
  bolt.is_anchored = bolt.has_plate = true;
  bolt.grout_stiffness = 0.0;
  return bolt;
}

/// Three blocks in a column below a roof, without gaps.
Scene column() {
  Scene scene(1e11, 30.0);
  scene.rectangle({0.0, 3.0}, 1.0, 2.0, 0.0, true);
  for (const double y : {2.0, 1.0, 0.0}) scene.rectangle({0.0, y}, 1.0, 1.0);
  return scene;
}

std::vector<std::string> names(const Scene& scene) {
  std::vector<std::string> all;
  for (const auto& element : element_descriptions(build_model(scene.setup))) all.push_back(element.name);
  return all;
}

TEST(Bolts, FindTheRockAlongThem) {
  Scene scene = column();
  scene.setup.bolts = {grouted({0.2, 0.5}, {0.8, 4.5})};
  const std::vector<BoltPiece> pieces = bolt_pieces(scene.setup, 0);
  ASSERT_EQ(pieces.size(), 4u);
  const double length = scene.setup.bolts[0].length(), ends[] = {0.0, 0.125, 0.375, 0.625, 1.0};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(pieces[k].block, 3 - k);
    EXPECT_NEAR(pieces[k].from, ends[k] * length, 1e-6);
    EXPECT_NEAR(pieces[k].to, ends[k + 1] * length, 1e-6);
  }
}

TEST(Bolts, RockThatIsExcavatedBeforeIsNotAlongThem) {
  Scene scene = column();
  scene.setup.system.blocks[2].excavations = {0};
  scene.setup.staged_supports = {"bolt"};
  record::Stage open = stage("open", record::StageKind::settle),
                support = stage("support", record::StageKind::settle);
  open.excavate = {0};
  support.install = {"bolt"};
  scene.setup.bolts = {grouted({0.5, 0.5}, {0.5, 4.5})};
  scene.setup.bolts[0].staged = 0;
  scene.setup.stages = {open, support};
  EXPECT_EQ(bolt_pieces(scene.setup, 0).size(), 3u);
  scene.setup.stages = {support, open};
  EXPECT_EQ(bolt_pieces(scene.setup, 0).size(), 4u);
  scene.setup.stages = {open, support};
  scene.setup.bolts[0].head = {0.5, 1.5};
  EXPECT_THROW(bolt_pieces(scene.setup, 0), InputError);
}

// Along a joint and through corners, each stretch is in one block.
TEST(Bolts, AlongAJointAreInOneBlock) {
  Scene scene(1e11, 30.0);
  scene.rectangle({0.0, 2.0}, 2.0, 1.0, 0.0, true);
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0}) scene.rectangle({x, y}, 1.0, 1.0);
  scene.setup.bolts = {grouted({1.0, 0.2}, {1.0, 2.8}), grouted({0.1, 0.1}, {1.9, 1.9})};
  for (const std::size_t k : {0u, 1u}) {
    const std::vector<BoltPiece> pieces = bolt_pieces(scene.setup, k);
    for (std::size_t j = 0; j + 1 < pieces.size(); ++j)
      EXPECT_NEAR(pieces[j].to, pieces[j + 1].from, 1e-5) << k << " " << j;
  }
  EXPECT_EQ(bolt_pieces(scene.setup, 0).size(), 3u);
}

TEST(Bolts, ElementsAreTheirJoints) {
  Scene scene = column();
  scene.setup.bolts = {grouted({0.5, 0.2}, {0.5, 4.5})};
  scene.setup.bolts[0].dowel_stiffness = 1e7;
  EXPECT_EQ(names(scene), (std::vector<std::string>{"bolt.1", "bolt.1.dowel", "bolt.2", "bolt.2.dowel",
                                                    "bolt.3", "bolt.3.dowel"}));
  scene.setup.bolts[0].head.y = 2.2;
  scene.setup.bolts[0].grouted.second = scene.setup.bolts[0].length();
  EXPECT_EQ(names(scene), (std::vector<std::string>{"bolt", "bolt.dowel"}));
  scene.setup.bolts[0].grouted.first = 1.5;  // nothing holds the bar below the joint
  EXPECT_EQ(names(scene), std::vector<std::string>{});
  scene.setup.bolts[0].has_plate = true;
  EXPECT_EQ(names(scene).size(), 2u);
}

/// A block under a roof, held by bolts that a stage installs before its ballast doubles.
Scene bolted_block(const std::vector<loading::Bolt>& bolts) {
  Scene scene = hung_block();
  scene.setup.bolts = bolts;
  for (loading::Bolt& bolt : scene.setup.bolts) bolt.staged = 0;
  return scene;
}

// Whatever the bolt gives way in the stage that installs it, at its end it has the force that was asked for.
TEST(Bolts, HaveTheirPretensionAtTheEndOfTheStage) {
  loading::Bolt bolt = anchored({0.5, 0.2}, {0.5, 3.5});
  bolt.pretension = 8e3;
  bolt.spacing = 2.0;
  const Scene scene = bolted_block({bolt});
  const double weight = 2600.0 * g, hanger = 2.0 * hanger_stiffness,  // with the second spring
      k = bolt.bar() / bolt.length() / bolt.spacing;
  record::RunObserver nobody;
  Runner runner(scene.setup, {}, nobody);
  std::vector<double> force, height;
  while (!runner.done()) {
    if (!runner.advance().ended_stage) continue;
    force.push_back(element_states(runner.model(), runner.state()).back().force);
    height.push_back(runner.state().position[runner.model().blocks[1].first + 1]);
  }
  EXPECT_EQ(force[0], 0.0);
  EXPECT_DOUBLE_EQ(force[1], 4e3);
  EXPECT_NEAR(height[1] - height[0], 4e3 / hanger, 1e-4 * 4e3 / hanger);
  EXPECT_NEAR(height[2] - height[1], 0.2 * weight / (hanger + k), 1e-4 * weight / (hanger + k));
  EXPECT_NEAR(force[2], 4e3 - k * (height[2] - height[1]), 1.0);
  EXPECT_LT(runner.finish().energy.residual_ratio, 1e-6);
}

/// A block that leaves its roof at 0.3 m/s on bolts, of which one yields and the other breaks.
Scene breaking_bolts(int order = 1) {
  Scene scene(1e11, 30.0);
  scene.rectangle({0.0, 1.0}, 1.0, 2.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, false, order);
  loading::Bolt weak = grouted({0.25, 0.0}, {0.25, 2.5}), strong = grouted({0.75, 0.0}, {0.75, 2.5});
  weak.name = weak.list = "weak";
  strong.name = strong.list = "strong";
  weak.yield = 12e3;
  weak.rupture_strain = 0.01;
  strong.yield = 30e3;
  weak.dowel_stiffness = strong.dowel_stiffness = 2e7;
  weak.dowel_strength = strong.dowel_strength = 5e3;
  scene.setup.properties[1].velocity = {0.0, -0.3};
  scene.setup.bolts = {weak, strong};
  scene.setup.time_step = 0.002;
  scene.setup.stages = {stage("let go", record::StageKind::rest, 4.3)};
  return scene;
}

TEST(Bolts, HaveTheSameBitsForAnyThreadsAndAfterAnInterruption) {
  for (const int order : {1, 2, 3}) {
    const Scene scene = breaking_bolts(order);
    record::RunObserver nobody;
    const record::RunRecord whole = run(scene.setup, {}, nobody);
    ASSERT_EQ(whole.elements.size(), 4u);
    EXPECT_TRUE(whole.elements[0].ruptured);
    EXPECT_FALSE(whole.elements[0].present);
    EXPECT_TRUE(whole.elements[1].ruptured);
    EXPECT_FALSE(whole.elements[2].ruptured);
    EXPECT_GT(whole.elements[2].yielded, 0.0);
    EXPECT_EQ(whole.stages.back().damage.ruptured_elements, 1);  // the dowel goes with its bar
    EXPECT_LT(whole.energy.residual_ratio, 1e-3);
    RunOptions threads;
    for (threads.threads = 2; threads.threads <= 4; threads.threads += 2)
      EXPECT_EQ(run(scene.setup, threads, nobody).state_hash, whole.state_hash) << order;
    Stopper stopper(2100);
    const record::RunRecord resumed = resumed_run(scene.setup, stopper);
    EXPECT_EQ(resumed.state_hash, whole.state_hash) << order;
    // The bar, and not the dowel that goes with it.
    ASSERT_EQ(whole.breaks.size(), 1u);
    ASSERT_EQ(resumed.breaks.size(), 1u);
    EXPECT_EQ(whole.breaks[0].element, 0);
    EXPECT_EQ(whole.breaks[0].events, 1);
    EXPECT_LT(whole.breaks[0].first, 2.0);
    EXPECT_DOUBLE_EQ(resumed.breaks[0].first, whole.breaks[0].first);
    EXPECT_EQ(resumed.breaks[0].events, 1);
  }
}

/// A block that leaves a roof at 1 m/s, held by bolts that yield at once.
Scene torn_off(int bolts) {
  Scene scene(1e11, 30.0);
  scene.rectangle({0.0, 1.0}, 1.0, 2.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.setup.properties[1].velocity = {0.0, -1.0};
  for (int k = 0; k < bolts; ++k) {
    const double x = (k + 0.5) / bolts;
    loading::Bolt bolt = anchored({x, 0.2}, {x, 2.5});
    bolt.yield = 10.0;
    bolt.rupture_strain = 1e-3 * (1.0 + 0.01 * ((7 * k) % bolts)) / bolt.length();
    scene.setup.bolts.push_back(bolt);
  }
  return scene;
}

// Of many bolts that a step would break a tenth breaks before the others are asked again: those that are farthest beyond. What is
// remembered stays as it was.
TEST(Bolts, BreakOneAfterTheOther) {
  for (const int bolts : {3, 25}) {
    Simulator s(torn_off(bolts));
    const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
    dynamics::OneStep step(s, *solver);
    const auto before = s.state.couplings;
    step.d[s.model.blocks[1].first + 1] = -5e-3;  // of an area of 1
    step.iterate.place(step.system());
    step.iterate.find_gradient(step.system());
    dynamics::LawUpdates laws;
    laws.begin();
    ASSERT_TRUE(laws.change_couplings(step.system(), step.iterate));
    const std::size_t first = step.problem.parts()[1].first;
    int broken = 0;
    for (int k = 0; k < bolts; ++k) {
      const bool is_broken = step.problem.springs().bound[first + static_cast<std::size_t>(k)] == 0.0;
      broken += is_broken ? 1 : 0;
      EXPECT_EQ(is_broken, (7 * k) % bolts < std::max(1, bolts / 10)) << k;
    }
    EXPECT_EQ(broken, std::max(1, bolts / 10));
    EXPECT_EQ(s.state.couplings, before);
    for (int k = 1; k < bolts; ++k) laws.change_couplings(step.system(), step.iterate);
    EXPECT_FALSE(laws.change_couplings(step.system(), step.iterate));
  }
}

// Of steps that are taken again, or halved, nothing is remembered: what has yielded is what the bolts are longer by, once.
TEST(Bolts, RememberAcceptedStepsAlone) {
  Scene scene = torn_off(3);
  for (loading::Bolt& bolt : scene.setup.bolts) {
    bolt.rupture_strain.reset();
    bolt.pretension = 0.0;
  }
  scene.setup.bolts[1].rupture_strain = 5e-3 / scene.setup.bolts[1].length();
  // Steps in which springs change need more iterations than one, and are cut.
  scene.setup.solver.max_iterations = 1;
  for (const auto& [name, member] : dynamics::accelerator_names)
    scene.setup.solver.accelerators.*member = false;
  Simulator s(scene);
  s.run(0.02, 0.002);
  EXPECT_GT(s.retried, 0);
  const std::vector<record::ElementState> bolts = element_states(s.model, s.state);
  const double way = 1.0 - s.centroid(1).y - 0.5;
  EXPECT_GT(way, 0.02);
  for (const std::size_t k : {0u, 2u}) EXPECT_NEAR(bolts[k].yielded, way, 1e-6) << k;
  EXPECT_FALSE(bolts[1].present);
  EXPECT_NEAR(bolts[1].yielded, 5e-3, 2.1e-3);
}

// A short bolt that nothing presses is slack.
TEST(Bolts, BreakWhereTheBarYieldsAndNotWhereTheGroutSlips) {
  Scene scene = column();
  scene.setup.bolts = {grouted({0.5, 0.0}, {0.5, 4.5})};
  loading::Bolt& bolt = scene.setup.bolts[0];
  bolt.yield = 1e6;  // of the joints at 1, 2 and 3 m the shorter sides hold 0.7, 1.4 and 1.05 MN
  bolt.rupture_strain = 0.1;
  BoltSprings made;
  add_bolts(scene.setup, build_model(scene.setup), made);
  ASSERT_EQ(made.springs.size(), 3u);
  EXPECT_NEAR(made.springs[0].yield, 0.7e6, 1.0);
  EXPECT_TRUE(std::isinf(made.springs[0].rupture));
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_EQ(made.springs[k].yield, 1e6);
    EXPECT_DOUBLE_EQ(made.springs[k].rupture, 0.1 * 0.05);
  }
}

// A plate holds a bar that is pulled. Pushed out of the rock, the bar takes its plate along.
TEST(Bolts, PlatesHoldNothingThatIsPushedOut) {
  Scene scene = column();
  scene.setup.bolts = {grouted({0.5, 0.9}, {0.5, 4.5})};
  scene.setup.bolts[0].has_plate = true;
  BoltSprings made;
  add_bolts(scene.setup, build_model(scene.setup), made);
  ASSERT_EQ(made.springs.size(), 3u);
  EXPECT_NEAR(made.springs[0].yield, 7e5 * 3.5, 1.0);  // all of the far side, as the plate holds the near one
  EXPECT_NEAR(made.springs[0].least(), -7e5 * 0.1, 1.0);
  EXPECT_NEAR(made.springs[1].least(), -7e5 * 1.1, 1.0);
  EXPECT_NEAR(made.springs[2].least(), -7e5 * 1.5, 1.0);  // of the far side
}

TEST(Bolts, AnchoredOnesDoNotPress) {
  Scene scene(1e11, 30.0);
  scene.setup.gravity = {};
  scene.rectangle({0.0, 2.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.setup.properties[1].velocity = {0.0, 0.1};
  scene.setup.bolts = {anchored({0.5, 0.5}, {0.5, 2.5})};
  Simulator s(scene);
  s.run(0.1, 0.002);
  EXPECT_NEAR(s.velocity(1).y, 0.1, 1e-12);
  EXPECT_EQ(element_states(s.model, s.state)[0].force, 0.0);
  EXPECT_NEAR(element_states(s.model, s.state)[0].elongation, -0.01, 1e-9);
  EXPECT_EQ(element_states(s.model, s.state)[0].yielded, 0.0);
}

}  // namespace
}  // namespace keyblock::simulation
