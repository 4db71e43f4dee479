#include "simulation/openings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../scene.h"
#include "core/index.h"
#include "record/fallen.h"

namespace keyblock::simulation {
namespace {

constexpr Vec2 straight_down{0.0, -1.0};

Polygon box(double left, double bottom, double right, double top) {
  return {{{left, bottom}, {right, bottom}, {right, top}, {left, top}}, {}};
}

Openings openings_of(const std::vector<Excavation>& excavations) {
  Openings openings;
  openings.unite(excavations, std::vector<std::uint8_t>(excavations.size(), 1));
  return openings;
}

TEST(Openings, OutlinesThatOverlapCountOnce) {
  const std::vector<Excavation> both{{"heading", box(0.0, 1.0, 4.0, 3.0).outer},
                                     {"bench", box(0.0, 0.0, 4.0, 1.5).outer}};
  EXPECT_NEAR(openings_of(both).area(), 12.0, 1e-12);
  std::vector<Excavation> twins = both;
  twins.push_back({"other tube", box(9.0, 0.0, 12.0, 3.0).outer});
  Openings heading;
  heading.unite(twins, std::vector<std::uint8_t>{1, 0, 0});
  EXPECT_NEAR(heading.area(), 8.0, 1e-12);
}

TEST(Openings, PlacesBehindTheWalls) {
  const Openings openings = openings_of({{"tunnel", box(0.0, 0.0, 4.0, 3.0).outer}});
  const auto expect = [&](const Polygon& block, double depth, record::WallPart part) {
    const Openings::Place place = openings.behind_walls(block, straight_down);
    EXPECT_NEAR(place.depth, depth, 1e-12);
    EXPECT_EQ(place.part, part);
  };
  expect(box(1.0, 3.0, 2.0, 4.5), 1.5, record::WallPart::crown);
  expect(box(1.0, -0.7, 2.0, 0.0), 0.7, record::WallPart::invert);
  expect(box(-1.2, 1.0, 0.0, 2.0), 1.2, record::WallPart::left);
  expect(box(4.0, 1.0, 5.1, 2.0), 1.1, record::WallPart::right);
  // Beyond a corner of the outline: up to 45° from the vertical it is the crown.
  expect(box(4.0, 3.0, 4.3, 3.4), 0.5, record::WallPart::crown);
  expect(box(4.0, 3.0, 4.4, 3.3), 0.5, record::WallPart::right);
  EXPECT_EQ(Openings().behind_walls(box(0.0, 0.0, 1.0, 1.0), straight_down).part, record::WallPart::none);
  // Gravity that leans takes the crown with it.
  EXPECT_EQ(openings.behind_walls(box(4.0, 1.0, 5.1, 2.0), {-1.0, 0.0}).part, record::WallPart::crown);
  EXPECT_EQ(openings.behind_walls(box(1.0, 3.0, 2.0, 4.5), {-1.0, 0.0}).part, record::WallPart::left);
}

TEST(Openings, TheNearestOneCounts) {
  const Openings openings =
      openings_of({{"left", box(0.0, 0.0, 2.0, 2.0).outer}, {"right", box(6.0, 0.0, 8.0, 2.0).outer}});
  const Openings::Place place = openings.behind_walls(box(5.0, 0.5, 6.0, 1.0), straight_down);
  EXPECT_NEAR(place.depth, 1.0, 1e-12);
  EXPECT_EQ(place.part, record::WallPart::left);  // of the right one
}

TEST(Fallen, NamesOfParts) {
  for (const record::WallPart part :
       {record::WallPart::crown, record::WallPart::left, record::WallPart::right, record::WallPart::invert})
    EXPECT_EQ(record::wall_part_of(record::wall_part_name(part)), part);
  EXPECT_EQ(record::wall_part_name(record::WallPart::none), nullptr);
  EXPECT_EQ(record::wall_part_of("roof"), record::WallPart::none);
}

/// A tunnel of 4 m by 3 m with two blocks over its crown and one in its left wall; density 2600 kg/m³.
class FallingRock : public ::testing::Test {
 protected:
  FallingRock() : scene_(made()), simulator_(scene_), gauge_(scene_.setup, simulator_.model) {
    const std::vector<int> tunnel{0};
    gauge_.open(tunnel, simulator_.state);
    gauge_.start(simulator_.state, {});
  }
  void drop(std::size_t b) {
    const dynamics::Block& block = simulator_.model.blocks[b];
    simulator_.state.position[block.first + 1] -= std::sqrt(block.area);
  }
  record::Damage measure() { return gauge_.measure(simulator_.state); }

  Scene scene_;
  Simulator simulator_;
  DamageGauge gauge_;

 private:
  static Scene made() {
    Scene scene(1e9, 30.0);
    scene.rectangle({1.0, 3.0}, 1.0, 0.5);
    scene.rectangle({1.0, 3.5}, 1.0, 1.5);
    scene.rectangle({-0.8, 1.0}, 0.8, 0.5);
    scene.setup.excavations = {{"tunnel", {{0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}, {0.0, 3.0}}}};
    return scene;
  }
};

TEST_F(FallingRock, WeightPressureLargestBlockAndDepths) {
  record::Damage damage = measure();
  for (const auto member : {&record::Damage::fallen_weight, &record::Damage::largest_block_pressure,
                            &record::Damage::fallen_depth, &record::Damage::fallen_depth_crown,
                            &record::Damage::largest_fallen_area})
    EXPECT_EQ(damage.*member, 0.0);
  for (std::size_t b = 0; b < 3; ++b) drop(b);
  damage = measure();
  const double weight = 2600.0 * g;
  EXPECT_EQ(damage.fallen_blocks, 3);
  EXPECT_NEAR(damage.fallen_weight, 2.4 * weight, 1e-6);
  EXPECT_NEAR(damage.largest_block_pressure, 1.5 * weight / 1.0, 1e-6);
  EXPECT_NEAR(damage.largest_fallen_area, 1.5, 1e-12);
  EXPECT_NEAR(damage.largest_fallen_weight, 1.5 * weight, 1e-6);
  EXPECT_NEAR(damage.fallen_depth, 2.0, 1e-12);
  EXPECT_NEAR(damage.fallen_depth_crown, 2.0, 1e-12);
  EXPECT_NEAR(damage.fallen_depth_left, 0.8, 1e-12);
  EXPECT_EQ(damage.fallen_depth_right, 0.0);
  EXPECT_EQ(damage.fallen_depth_invert, 0.0);
  const auto fallen = gauge_.fallen(gauge_.status(simulator_.state));
  ASSERT_EQ(fallen.size(), 3U);
  EXPECT_EQ(fallen[2].block, 2);
  EXPECT_EQ(fallen[2].part, record::WallPart::left);
  EXPECT_NEAR(fallen[2].weight, 0.4 * weight, 1e-6);
}

// There is weight, but no wall to be behind of and no width to carry it.
TEST(Fallen, WithoutAnOpening) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.setup.damage.fall_distance = 0.5;
  Simulator simulator(scene);
  DamageGauge gauge(scene.setup, simulator.model);
  gauge.start(simulator.state, {});
  simulator.state.position[simulator.model.blocks[0].first + 1] -= 1.0;
  const record::Damage damage = gauge.measure(simulator.state);
  EXPECT_NEAR(damage.fallen_weight, 2600.0 * g, 1e-6);
  EXPECT_NEAR(damage.largest_fallen_weight, 2600.0 * g, 1e-6);
  EXPECT_TRUE(std::isnan(damage.largest_block_pressure));
  EXPECT_TRUE(std::isnan(damage.fallen_depth));
  EXPECT_TRUE(std::isnan(damage.fallen_depth_crown));
}

}  // namespace
}  // namespace keyblock::simulation
