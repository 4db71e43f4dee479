#include "census/census.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cutting/cut.h"

namespace keyblock::census {
namespace {

using cutting::BlockSystem;
using cutting::CutInput;
using rockmass::TraceSource;

constexpr double density = 2600.0;
const TraceSource first_map{TraceSource::Kind::trace_map, 0};

void add_line(CutInput& input, const std::vector<Vec2>& points) {
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    input.traces.push_back({points[k], points[k + 1], first_map});
}

/// Rock of 20 × 20 m with an opening of 8 × 3 m, its roof at y = 0.
CutInput rock_with_opening() {
  CutInput input;
  input.domain = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
  input.excavations = {{{-4, -3}, {4, -3}, {4, 0}, {-4, 0}}};
  return input;
}

Input input_of(const BlockSystem& system, double friction_coefficient = 0.5, double cohesion = 0.0) {
  Input input{.system = system};
  input.density.assign(system.blocks.size(), density);
  input.fixed.assign(system.blocks.size(), 0);
  input.trace_maps = {{friction_coefficient, cohesion}};
  return input;
}

BlockSystem explicit_blocks(const std::vector<Ring>& rings) {
  BlockSystem system;
  for (const Ring& ring : rings) {
    cutting::CutBlock block;
    block.polygon.outer = ring;
    block.labels.emplace_back(ring.size());
    system.blocks.push_back(block);
  }
  return system;
}

TEST(Faces, AreDividedWhereBlocksBeyondThemEnd) {
  // One block of 4 m on two of 2 m, of which the second reaches 1 m beyond it; the third does not touch.
  const BlockSystem system = explicit_blocks({{{0, 1}, {4, 1}, {4, 2}, {0, 2}},
                                              {{0, 0}, {2, 0}, {2, 1}, {0, 1}},
                                              {{2, 0}, {5, 0}, {5, 1}, {2, 1}},
                                              {{4.2, 1}, {5, 1}, {5, 2}, {4.2, 2}}});
  const auto faces = find_faces(system);
  const auto length_to = [&](std::size_t block, int beyond) {
    double sum = 0.0;
    for (const Face& face : faces[block]) sum += face.beyond == beyond ? face.length : 0.0;
    return sum;
  };
  EXPECT_NEAR(length_to(0, 1), 2.0, 1e-12);
  EXPECT_NEAR(length_to(0, 2), 2.0, 1e-12);
  EXPECT_NEAR(length_to(0, nothing), 6.0, 1e-12);
  EXPECT_NEAR(length_to(2, 0), 2.0, 1e-12);
  EXPECT_NEAR(length_to(2, 3), 0.8, 1e-12);
  EXPECT_NEAR(length_to(2, nothing), 0.2 + 1.0 + 3.0, 1e-12);
  EXPECT_NEAR(length_to(2, 1), 1.0, 1e-12);
}

TEST(Census, TakesAwayLayerByLayer) {
  CutInput cut = rock_with_opening();
  add_line(cut, {{-1, 0}, {-1, 3}, {1, 3}, {1, 0}});
  add_line(cut, {{-1, 1}, {1, 1}});
  add_line(cut, {{-1, 2}, {1, 2}});
  const BlockSystem system = cutting::cut(cut);
  const Census census = take_census(input_of(system));
  EXPECT_EQ(census.layers, 3);
  ASSERT_EQ(census.blocks.size(), 4U);  // with the rock around, which is not removable
  for (int k = 0; k < 3; ++k) {
    const KeyBlock& key = census.blocks[static_cast<std::size_t>(k)];
    EXPECT_EQ(key.layer, k + 1);
    EXPECT_NEAR(key.area, 2.0, 1e-9);
    EXPECT_NEAR(key.depth, k + 1.0, 1e-9);
    EXPECT_NEAR(key.weight, 2.0 * density * 9.81, 1e-6);
    EXPECT_EQ(key.removal.mode, Mode::falls);
  }
  EXPECT_EQ(census.blocks[3].removal.mode, Mode::not_removable);
  EXPECT_FALSE(census.blocks[3].moves());
  EXPECT_NEAR(census.wall, 22.0, 1e-9);
  const Totals sum = totals(census);
  EXPECT_EQ(sum.moving, 3);
  EXPECT_NEAR(sum.area, 6.0, 1e-9);
  EXPECT_NEAR(sum.first_layer_area, 2.0, 1e-9);
  EXPECT_NEAR(sum.deepest, 3.0, 1e-9);
  EXPECT_NEAR(sum.force, sum.weight, 1e-6);
}

TEST(Census, StopsAtABlockThatStays) {
  // Cohesion of 20 kPa on 2 m of joints holds 51 kN below a factor of 1, 30 kPa above 1 and below 1.5 with 40 kN each side.
  CutInput cut = rock_with_opening();
  add_line(cut, {{-1, 0}, {-1, 2}, {1, 2}, {1, 0}});
  add_line(cut, {{-1, 1}, {1, 1}});
  const BlockSystem system = cutting::cut(cut);
  const double weight = 2.0 * density * 9.81;
  const Census held = take_census(input_of(system, 0.5, 30e3));
  ASSERT_EQ(held.layers, 0);
  const auto block = std::find_if(held.blocks.begin(), held.blocks.end(),
                                  [](const KeyBlock& key) { return key.area < 3.0; });
  ASSERT_NE(block, held.blocks.end());
  EXPECT_NEAR(block->removal.factor(), 60e3 / weight, 1e-9);
  EXPECT_NEAR(block->force, weight - 60e3 / 1.5, 1e-4);
  EXPECT_EQ(totals(held).supported, 1);
  EXPECT_EQ(take_census(input_of(system, 0.5, 20e3)).layers, 2);
}

TEST(Census, OfASlopeGoesByTheSeismicCoefficient) {
  CutInput cut;
  cut.domain = {{-10, 0}, {10, 0}, {10, 10}, {-10, 10}};
  cut.excavations = {{{0, 2}, {10, 2}, {10, 10}, {0, 10}}};
  add_line(cut, {{0, 4}, {-10, 4 + 10 * std::tan(0.5)}});  // dips out of the face at 0.5 rad
  const BlockSystem system = cutting::cut(cut);
  Input input = input_of(system, 0.8);
  input.rock_above = false;
  input.rock_around = true;
  Census census = take_census(input);
  EXPECT_EQ(census.layers, 0);
  input.seismic = {0.4, 0.0};
  census = take_census(input);
  ASSERT_EQ(census.layers, 1);
  const double normal = std::cos(0.5) - 0.4 * std::sin(0.5), driving = std::sin(0.5) + 0.4 * std::cos(0.5);
  EXPECT_NEAR(census.blocks[0].removal.factor(), 0.8 * normal / driving, 1e-9);
  EXPECT_EQ(census.blocks[0].joints.size(), 1U);
  input.rock_above = true;  // it slides away from that
  EXPECT_EQ(take_census(input).layers, 1);
}

TEST(Census, LeavesFixedBlocksAlone) {
  const BlockSystem system =
      explicit_blocks({{{0, 0}, {4, 0}, {4, 1}, {0, 1}}, {{1, 1}, {2, 1}, {2, 2}, {1, 2}}});
  Input input = input_of(system);
  input.fixed[0] = 1;
  const Census census = take_census(input);
  ASSERT_EQ(census.blocks.size(), 1U);
  EXPECT_EQ(census.blocks[0].block, 1);
  EXPECT_EQ(census.blocks[0].removal.mode, Mode::stable);
  input.fixed[0] = 0;
  EXPECT_EQ(take_census(input).layers, 2);
}

TEST(Census, IsEmptyWithoutAWall) {
  CutInput cut = rock_with_opening();
  cut.excavations.clear();
  const BlockSystem system = cutting::cut(cut);
  const Census census = take_census(input_of(system));
  EXPECT_TRUE(census.blocks.empty());
  EXPECT_EQ(census.wall, 0.0);
}

}  // namespace
}  // namespace keyblock::census
