#include "simulation/bolt_nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../hung_block.h"
#include "../resumed_run.h"
#include "loading/bolt.h"
#include "simulation/build_bolts.h"
#include "simulation/build_model.h"
#include "simulation/elements.h"
#include "simulation/runner.h"

namespace keyblock::simulation {
namespace {

/// A bar of 25 mm in good grout.
loading::Bolt bolt_of_nodes(Vec2 head, Vec2 toe) {
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
  bolt.has_nodes = true;
  return bolt;
}

/// A block of an area of 3 m² below a roof, on a bolt that is grouted 1.5 m deep in both. It weighs `weight`, N/m.
Scene hung_by_nodes(double weight, int order = 1) {
  Scene scene(1e13, 30.0);
  scene.rectangle({0.0, 3.0}, 1.0, 3.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 3.0, 0.0, false, order);
  scene.setup.properties[1].material.density = weight / (3.0 * g);
  scene.setup.bolts = {bolt_of_nodes({0.5, 1.5}, {0.5, 4.5})};
  scene.setup.time_step = 0.0002;
  record::Stage hang = stage("hang", record::StageKind::settle);
  hang.tolerance = 1e-6;
  scene.setup.stages = {hang};
  return scene;
}

double total_grout(const std::vector<BoltNode>& nodes) {
  double sum = 0.0;
  for (const BoltNode& node : nodes) sum += node.grouted();
  return sum;
}

// Cells fill the grout, whatever the joints; two bodies take turns.
TEST(BoltNodes, FillTheGroutAndWholeBodies) {
  for (const int order : {1, 2, 3}) {
    Scene scene = hung_by_nodes(1e5, order);
    for (const bool plate : {false, true}) {
      scene.setup.bolts[0].has_plate = plate;
      for (const std::pair<double, double>& grouted :
           {std::pair(0.0, 3.0), std::pair(0.3, 2.0), std::pair(1.45, 3.0), std::pair(1.6, 3.0)}) {
        scene.setup.bolts[0].grouted = grouted;
        const std::vector<BoltNode> nodes = bolt_nodes(scene.setup, 0);
        if (grouted.first > 1.5 && !plate) {
          EXPECT_TRUE(nodes.empty());  // on one side of the joint alone
          continue;
        }
        ASSERT_FALSE(nodes.empty());
        EXPECT_EQ(nodes.size() % (order == 2 ? 12 : 6), 0u);
        EXPECT_NEAR(total_grout(nodes), grouted.second - grouted.first, 1e-12);
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
          EXPECT_LT(nodes[i].middle(), nodes[i + 1].middle());
        const dynamics::Model model = build_model(scene.setup);
        BoltSprings made;
        add_bolts_of_nodes(scene.setup, model, made);
        for (std::size_t k = 0; k < made.springs.size(); ++k)
          EXPECT_NE(made.points[2 * k].block, made.points[2 * k + 1].block) << made.springs[k].name;
        double area = 0.0;
        for (const dynamics::LineBody& line : model.lines) area += line.area;
        EXPECT_NEAR(area, 4.908762e-4 * (nodes.back().middle() - nodes.front().middle()), 1e-12);
      }
    }
  }
}

// The pull-out of a bar in grout that slips (loading::BoltSide) on both sides of a joint, at loads before and after slip begins.
TEST(BoltNodes, ComeOutAsABarInGroutDoes) {
  for (const double weight : {35e3, 71e3, 333e3, 858e3}) {
    const Scene scene = hung_by_nodes(weight);
    record::RunObserver nobody;
    Runner runner(scene.setup, {}, nobody);
    while (!runner.done()) runner.advance();
    const dynamics::Block& block = runner.model().blocks[1];
    const double opening = 1.5 - runner.state().position[block.first + 1] / std::sqrt(3.0),
                 side = loading::BoltSide(scene.setup.bolts[0], 0.0, 1.5, false).displacement(weight);
    EXPECT_NEAR(opening, 2.0 * side, 3e-3 * 2.0 * side) << weight;
    const record::RunRecord end = runner.finish();
    EXPECT_LT(end.energy.residual_ratio, 1e-8);
    const auto bar = std::ranges::find(end.elements, std::string("bolt"), &record::ElementRecord::name);
    ASSERT_NE(bar, end.elements.end());
    EXPECT_NEAR(bar->force, weight, 1e-4 * weight);
  }
}

/// A block that leaves its roof at 0.3 m/s on two bolts, one of which yields until it breaks.
Scene breaking_nodes(int order) {
  Scene scene(1e11, 30.0);
  scene.rectangle({0.0, 1.0}, 1.0, 2.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, false, order);
  for (const double x : {0.25, 0.75}) {
    loading::Bolt bolt = bolt_of_nodes({x, 0.0}, {x, 2.5});
    bolt.name = bolt.list = x < 0.5 ? "weak" : "strong";
    bolt.yield = x < 0.5 ? 12e3 : 30e3;
    bolt.dowel_stiffness = 2e7;
    bolt.dowel_strength = 5e3;
    bolt.node_spacing = 0.25;
    if (x < 0.5) bolt.rupture_strain = 0.01;
    scene.setup.bolts.push_back(bolt);
  }
  scene.setup.properties[1].velocity = {0.0, -0.3};
  scene.setup.time_step = 0.002;
  scene.setup.stages = {stage("let go", record::StageKind::rest, 4.3)};
  return scene;
}

TEST(BoltNodes, HaveTheSameBitsForAnyThreadsAndAfterAnInterruption) {
  using enum dynamics::TimeIntegration;
  for (const int order : {1, 2, 3}) {
    for (const auto rule : order == 1 ? std::vector{shi, generalized_alpha} : std::vector{shi}) {
      Scene scene = breaking_nodes(order);
      scene.setup.solver.integrator = rule;
      record::RunObserver nobody;
      const record::RunRecord whole = run(scene.setup, {}, nobody);
      EXPECT_EQ(whole.stages.back().damage.ruptured_elements,
                1);  // the dowel goes with its bar
      EXPECT_LT(whole.energy.residual_ratio, 1e-3) << order;
      RunOptions threads;
      for (threads.threads = 2; threads.threads <= 4; threads.threads += 2)
        EXPECT_EQ(run(scene.setup, threads, nobody).state_hash, whole.state_hash) << order;
      Stopper stopper(2100);
      EXPECT_EQ(resumed_run(scene.setup, stopper).state_hash, whole.state_hash) << order;
    }
  }
}

// Put in without force where rock has moved, they move nothing, and their nodes are in their holes.
TEST(BoltNodes, AreInstalledWithoutForce) {
  Scene scene = hung_block();
  loading::Bolt bolt = bolt_of_nodes({0.5, 0.2}, {0.5, 3.5});
  bolt.staged = 0;
  scene.setup.bolts = {bolt};
  record::RunObserver nobody;
  Runner runner(scene.setup, {}, nobody);
  std::vector<double> height;
  std::vector<record::ElementState> installed;
  while (!runner.done()) {
    if (!runner.advance().ended_stage) continue;
    height.push_back(runner.state().position[runner.model().blocks[1].first + 1]);
    if (height.size() == 2) installed = element_states(runner.model(), runner.state());
  }
  EXPECT_NEAR(height[1], height[0], 1e-9);
  EXPECT_GT(height[2] - height[1], 1e-6);
  ASSERT_GT(installed.size(), 50u);
  for (std::size_t k = 2; k < installed.size(); ++k) {  // after the springs
    EXPECT_TRUE(installed[k].present);
    EXPECT_NEAR(installed[k].elongation, 0.0, 1e-9);
  }
  EXPECT_LT(runner.finish().energy.residual_ratio, 1e-6);
}

// What rock that is excavated held goes with it.
TEST(BoltNodes, GoWithTheRockThatTheyAreIn) {
  Scene scene = hung_by_nodes(1e5);
  scene.rectangle({0.0, -1.0}, 1.0, 1.0, 0.0, true);  // that the block falls on
  scene.setup.system.blocks[1].excavations = {0};
  scene.setup.excavations.push_back({"hole", {{0.0, 0.0}, {1.0, 0.0}, {1.0, 3.0}, {0.0, 3.0}}});
  record::Stage open = stage("open", record::StageKind::settle);
  open.excavate = {0};
  scene.setup.stages.push_back(open);
  record::RunObserver nobody;
  Runner runner(scene.setup, {}, nobody);
  while (!runner.done()) runner.advance();
  for (const record::ElementRecord& element : runner.finish().elements) {
    EXPECT_EQ(element.present, element.from.y > 2.999) << element.name;
  }
}

// A plate holds a bar that its grout cannot, and does not push.
TEST(BoltNodes, PlatesHoldTheirHeads) {
  for (const bool plate : {false, true}) {
    Scene scene = hung_by_nodes(3e5);
    scene.setup.bolts[0].head = {0.5, 2.8};
    scene.setup.bolts[0].grouted = {0.0, 1.7};
    scene.setup.bolts[0].has_plate = plate;
    record::RunObserver nobody;
    const record::RunRecord end = run(scene.setup, {}, nobody);
    EXPECT_EQ(end.stages[0].moving.empty(), plate);
    if (!plate) continue;
    const auto found =
        std::ranges::find(end.elements, std::string("bolt.plate"), &record::ElementRecord::name);
    ASSERT_NE(found, end.elements.end());
    EXPECT_NEAR(found->force, 3e5 - 0.2 * 7e5, 2e3);
  }
}

}  // namespace
}  // namespace keyblock::simulation
