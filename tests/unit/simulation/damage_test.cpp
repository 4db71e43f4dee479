#include "simulation/damage.h"

#include <gtest/gtest.h>

#include "../scene.h"
#include "core/index.h"

namespace keyblock::simulation {
namespace {

// Rock around an opening, cut into quarters by joints through its centre.
Scene quartered_rock(Vec2 centre, double radius, int chords) {
  Scene scene(1e9, 30.0);
  Excavation opening;
  for (int k = 0; k < chords; ++k) {
    const double angle = 360.0 * degree * k / chords;
    opening.outline.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double turn = 90.0 * degree * quarter;
    const Vec2 x{std::round(std::cos(turn)), std::round(std::sin(turn))}, y{-x.y, x.x};
    Ring ring{centre + radius * x, centre + 5.0 * x, centre + 5.0 * x + 5.0 * y, centre + 5.0 * y,
              centre + radius * y};
    for (int k = chords / 4 - 1; k > 0; --k) {
      ring.push_back(opening.outline[static_cast<std::size_t>((quarter * chords / 4 + k) % chords)]);
    }
    scene.add(std::move(ring));
  }
  scene.setup.excavations.push_back(std::move(opening));
  return scene;
}

// The ends of both diameters lie on joints, and the rays to them meet corners of the outline.
TEST(Damage, ClosureWhereJointsMeetTheOpeningAtItsDiameters) {
  const Scene scenes[] = {quartered_rock({0.0, 0.0}, 1.0, 4), quartered_rock({0.0, 0.0}, 1.0, 48),
                          quartered_rock({0.1, -0.7}, 0.3, 48), quartered_rock({3.3, 0.4}, 1.7, 24)};
  for (const Scene& scene : scenes) {
    Simulator simulator(scene);
    DamageGauge gauge(scene.setup, simulator.model);
    gauge.start(simulator.state, {});
    const auto move = [&](std::size_t b, Vec2 by) {
      const dynamics::Block& block = simulator.model.blocks[b];
      simulator.state.position[block.first] += by.x * std::sqrt(block.area);
      simulator.state.position[block.first + 1] += by.y * std::sqrt(block.area);
    };
    // Upper quarters down, then right ones to the left.
    for (const std::size_t b : {std::size_t{0}, std::size_t{1}}) move(b, {0.0, -0.001});
    EXPECT_NEAR(gauge.measure(simulator.state).closure_vertical, 0.001, 1e-12);
    for (const std::size_t b : {std::size_t{0}, std::size_t{3}}) move(b, {-0.002, 0.0});
    EXPECT_NEAR(gauge.measure(simulator.state).closure_horizontal, 0.002, 2e-6);
  }
}

// A heading and the bench below it; the rock that fills the bench settles before it is opened.
TEST(Damage, OnlyOpeningsAreFilled) {
  Scene scene(1e9, 30.0);
  const auto box = [](double bottom, double top) {
    return Ring{{0.0, bottom}, {2.0, bottom}, {2.0, top}, {0.0, top}};
  };
  // The outline of the bench reaches into the heading: what both cover counts once.
  scene.setup.excavations = {{"heading", box(1.0, 2.0)}, {"bench", box(0.0, 1.5)}};
  scene.add(box(0.0, 0.8));
  scene.add(box(2.0, 3.0));
  Simulator simulator(scene);
  DamageGauge gauge(scene.setup, simulator.model);
  const auto sink = [&](std::size_t b, double by) {
    const dynamics::Block& block = simulator.model.blocks[b];
    contact::Surface& surface = simulator.model.surface;
    simulator.state.position[block.first + 1] -= by * std::sqrt(block.area);
    for (int v = surface.block_begin[b]; v < surface.block_begin[b + 1]; ++v) surface.position[at(v)].y -= by;
  };
  const std::vector<int> heading{0}, bench{1};
  gauge.open(heading, simulator.state);
  gauge.start(simulator.state, {});
  sink(0, 0.02);
  EXPECT_EQ(gauge.measure(simulator.state).opening_filled_ratio, 0.0);
  sink(1, 0.05);
  EXPECT_NEAR(gauge.measure(simulator.state).opening_filled_ratio, 0.05 / 1.0, 1e-12);
  gauge.open(bench, simulator.state);
  EXPECT_NEAR(gauge.measure(simulator.state).opening_filled_ratio, (0.05 + 0.78) / 2.0, 1e-12);
}

// Rock above and below a heading; what is below is excavated next.
TEST(Damage, ClosureStaysWhereAWallIsExcavated) {
  Scene scene(1e9, 30.0);
  scene.setup.excavations = {{"heading", {{0.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {0.0, 2.0}}},
                             {"bench", {{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}}}};
  scene.rectangle({0.0, 0.0}, 2.0, 1.0);
  scene.rectangle({0.0, 2.0}, 2.0, 1.0);
  Simulator simulator(scene);
  DamageGauge gauge(scene.setup, simulator.model);
  const auto sink_crown = [&](double by) {
    const dynamics::Block& crown = simulator.model.blocks[1];
    simulator.state.position[crown.first + 1] -= by * std::sqrt(crown.area);
  };
  const std::vector<int> heading{0}, bench{1};
  gauge.open(heading, simulator.state);
  gauge.start(simulator.state, {});
  EXPECT_EQ(gauge.measure(simulator.state).closure_vertical, 0.0);
  sink_crown(0.003);
  EXPECT_NEAR(gauge.measure(simulator.state).closure_vertical, 0.003, 1e-12);
  gauge.open(bench, simulator.state);
  simulator.model.surface.present[0] = 0;
  sink_crown(0.1);
  EXPECT_NEAR(gauge.measure(simulator.state).closure_vertical, 0.003, 1e-12);
  EXPECT_EQ(gauge.measure(simulator.state).closure_horizontal, 0.0);  // no walls at the sides
}

// The crown of a heading falls: where its wall was, nobody knows.
TEST(Damage, NoClosureOnAFallenBlock) {
  Scene scene(1e9, 30.0);
  scene.setup.excavations = {{"heading", {{0.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {0.0, 2.0}}},
                             {"bench", {{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}}}};
  scene.rectangle({0.0, 0.0}, 2.0, 1.0);
  scene.rectangle({0.0, 2.0}, 2.0, 1.0);
  Simulator simulator(scene);
  DamageGauge gauge(scene.setup, simulator.model);
  const auto sink_crown = [&](double by) {
    const dynamics::Block& crown = simulator.model.blocks[1];
    simulator.state.position[crown.first + 1] -= by * std::sqrt(crown.area);
  };
  const std::vector<int> heading{0}, bench{1};
  gauge.open(heading, simulator.state);
  gauge.start(simulator.state, {});
  sink_crown(0.09);  // a fall begins at 0.1 m
  EXPECT_NEAR(gauge.measure(simulator.state).closure_vertical, 0.09, 1e-12);
  sink_crown(0.02);
  ASSERT_EQ(gauge.measure(simulator.state).fallen_blocks, 1);
  EXPECT_TRUE(std::isnan(gauge.measure(simulator.state).closure_vertical));
  gauge.open(bench, simulator.state);
  simulator.model.surface.present[0] = 0;
  EXPECT_TRUE(std::isnan(gauge.measure(simulator.state).closure_vertical));
  EXPECT_EQ(gauge.measure(simulator.state).closure_horizontal, 0.0);
}

// Down is where gravity pulls, as on a slope that is given by a gravity that leans.
TEST(Damage, BlocksFallAlongGravity) {
  for (const Vec2 gravity : {Vec2{0.0, -g}, Vec2{g, 0.0}, Vec2{-g, g}, Vec2{}}) {
    Scene scene(1e9, 30.0);
    scene.setup.gravity = gravity;
    scene.setup.damage.fall_distance = 0.1;
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    Simulator simulator(scene);
    DamageGauge gauge(scene.setup, simulator.model);
    gauge.start(simulator.state, {});
    const Vec2 down = gravity == Vec2{} ? Vec2{0.0, -1.0} : normalized(gravity);
    const auto move = [&](Vec2 by) {
      simulator.state.position[simulator.model.blocks[0].first] += by.x;
      simulator.state.position[simulator.model.blocks[0].first + 1] += by.y;
    };
    move(0.5 * Vec2{-down.y, down.x});
    EXPECT_EQ(gauge.status(simulator.state)[0], record::BlockStatus::loosened);
    move(0.11 * down);
    EXPECT_EQ(gauge.status(simulator.state)[0], record::BlockStatus::fallen);
  }
}

}  // namespace
}  // namespace keyblock::simulation
