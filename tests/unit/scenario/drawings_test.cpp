// What a scenario takes from drawings: traces, outlines, blocks; and masonry by its measures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <numbers>

#include "guide_snippet.h"
#include "scenario/block_shapes.h"
#include "scenario/sections.h"
#include "scenario_text.h"
#include "warnings_of.h"

namespace keyblock::scenario::drawings_of_scenarios {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string drawn = KEYBLOCK_SOURCE_DIR "/tests/data/drawings/";

const std::string rock = R"(
[rock]
density = 2300.0
young = 5.0e9
poisson = 0.2
[joints]
friction = 35.0
)";

Scenario read(const std::string& more) {
  return parse_scenario_text(rock + more, "a.toml");
}

std::string mistakes(const std::string& more) {
  try {
    read(more);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no mistake in " << more;
  return {};
}

std::string block_map(const std::string& file, const std::string& keys) {
  return "\n[[block_map]]\nfile = \"" + (file.front() == '/' ? file : drawn + file) + "\"\n" + keys + "\n";
}

double area_of_all(const Scenario& scenario) {
  double sum = 0.0;
  for (const BlockSpec& block : scenario.blocks) sum += area(block.polygon);
  return sum;
}

/// A file of its own for each test, removed at its end.
class Drawings : public testing::Test {
 protected:
  std::string write(const std::string& entities) {
    path_ = testing::TempDir() + "keyblock_" + testing::UnitTest::GetInstance()->current_test_info()->name() +
            std::to_string(::getpid()) + ".dxf";
    std::string text = "0 SECTION 2 ENTITIES " + entities + "0 ENDSEC 0 EOF ";
    for (char& c : text) c = c == ' ' ? '\n' : c;
    std::ofstream(path_) << text;
    return path_;
  }
  void TearDown() override {
    if (!path_.empty()) std::filesystem::remove(path_);
  }

 private:
  std::string path_;
};

std::string square(const char* layer, const char* corner, const char* end) {
  const std::string a = corner, b = end;
  return std::string("0 LWPOLYLINE 8 ") + layer + " 70 1 10 " + a + " 20 0 10 " + b + " 20 0 10 " + b +
         " 20 1 10 " + a + " 20 1 ";
}

TEST_F(Drawings, AWallIsItsStones) {
  const Scenario wall = read(block_map("wall.dxf", "layers = [\"stones\"]\ndensity = 2500.0") +
                             block_map("wall.dxf", "layers = [\"GROUND\"]\nfixed = true"));
  ASSERT_EQ(wall.blocks.size(), 305U);
  EXPECT_EQ(wall.blocks[0].name, "stones 1");
  EXPECT_EQ(wall.blocks[303].name, "stones 304");
  EXPECT_EQ(wall.blocks[304].name, "GROUND");
  EXPECT_TRUE(wall.blocks[304].fixed);
  EXPECT_EQ(wall.blocks[0].rock.density, 2500.0);
  EXPECT_NEAR(area_of_all(wall), 5.0 * 5.8 + 7.0 * 0.5, 1e-9);
  EXPECT_EQ(wall.where(wall.blocks[303].path).file, drawn + "wall.dxf");
  EXPECT_GT(wall.where(wall.blocks[303].path).line, 1000);
  EXPECT_EQ(input_paths(wall).size(), 1U);
  EXPECT_THAT(plausibility_warnings(wall), Not(Contains(HasSubstr("left out"))));
}

TEST_F(Drawings, WhatIsLeftOutIsWarnedOf) {
  const std::string file = write(square("A", "0", "1") + "0 TEXT 8 A 1 note 0 TEXT 8 B 1 note ");
  EXPECT_THAT(
      plausibility_warnings(read(block_map(file, "name = \"a\""))),
      Contains(HasSubstr(
          "block_map.a: left out of the drawing: 1 TEXT on layer A (line 28), 1 TEXT on layer B (line 34)")));
  EXPECT_THAT(plausibility_warnings(parse_scenario_text(
                  "accept_warnings = [\"skipped\"]\n" + rock + block_map(file, ""), "a.toml")),
              Not(Contains(HasSubstr("left out"))));
}

TEST_F(Drawings, StonesWithArcs) {
  const Scenario arch = read(block_map("arch.dxf", "name = \"arch\"\nlayers = [\"VOUSSOIRS\"]"));
  ASSERT_EQ(arch.blocks.size(), 15U);
  // Four chords for the 12° of a stone, so that of a sector sin 3° / 3° is left.
  const double chord = std::numbers::pi / 60.0;
  EXPECT_NEAR(area_of_all(arch), 0.5 * std::numbers::pi * (2.5 * 2.5 - 4.0) * std::sin(chord) / chord, 1e-9);
}

TEST_F(Drawings, PlacementOfBlocks) {
  const std::string file = write(square("A", "100", "300"));
  const Scenario placed = read(block_map(file, "scale = 0.01\norigin = [100.0, 0.0]\nrotate = 90.0"));
  const Box box = bounds(placed.blocks.at(0).polygon);
  EXPECT_NEAR(box.min.x, -0.01, 1e-12);
  EXPECT_NEAR(box.max.y, 2.0, 1e-12);
}

TEST_F(Drawings, MistakesOfBlocksHaveLineAndLayer) {
  const std::string open = "0 LINE 8 A 10 0 20 0 11 3 21 4 ";
  EXPECT_THAT(mistakes(block_map(write(open), "")),
              HasSubstr(".dxf:6:1: LINE on layer A: found an open line, whose ends are 5 m apart"));
  EXPECT_THAT(mistakes(block_map(write(square("A", "0", "3") + square("B", "2", "4")), "")),
              HasSubstr("LWPOLYLINE on layer B: found a block that overlaps the LWPOLYLINE on layer A of "
                        "line 6 by 50 % of the smaller one"));
  const std::string bow = "0 LWPOLYLINE 8 A 70 1 10 0 20 0 10 1 20 1 10 1 20 0 10 0 20 1 ";
  EXPECT_THAT(mistakes(block_map(write(bow), "")), HasSubstr("a polygon that crosses or touches itself"));
  EXPECT_THAT(mistakes(block_map(write(square("A", "0", "9000")), "")),
              HasSubstr("scale: found 9000 by 1 units, and no unit in the drawing"));
  EXPECT_THAT(
      mistakes(block_map("wall.dxf", "layers = [\"BRICKS\"]")),
      HasSubstr(
          "layers: found \"BRICKS\", on which there is no line; expected layers with lines: STONES, GROUND"));
  EXPECT_THAT(mistakes(block_map("make.py", "")),
              HasSubstr("found a file of another kind; expected a drawing"));
  EXPECT_THAT(mistakes(block_map("wall.dxf", "span = 3.0")), HasSubstr("span"));
  EXPECT_THAT(mistakes("[[block_map]]\nshape = \"wall\""), HasSubstr("corner"));
  EXPECT_THAT(mistakes(block_map("arch.dxf", "layers = [\"VOUSSOIRS\"]") +
                       block_map("arch.dxf", "layers = [\"VOUSSOIRS\"]")),
              HasSubstr("the name of another block"));
}

TEST_F(Drawings, RingsThatTouchDoNotOverlap) {
  const std::string file = write(square("A", "0", "1") + square("A", "1", "2"));
  EXPECT_EQ(read(block_map(file, "")).blocks.size(), 2U);
}

TEST_F(Drawings, BlocksOfMapsAreNamedElsewhere) {
  const Scenario scenario =
      read(block_map(write(square("A", "0", "1") + square("A", "1", "2")), "name = \"s\"") +
           "[[interface]]\nbetween = [\"s 1\", \"s 2\"]\nfriction = 10.0\n"
           "[[history]]\nname = \"h\"\nblock = \"s 2\"\npoint = [1.5, 0.5]\n");
  EXPECT_EQ(scenario.interfaces.at(0).name, "s 1-s 2");
  EXPECT_EQ(build_blocks(scenario, 0).system.interfaces.size(), 1U);
}

TEST_F(Drawings, AnExcavationFollowsItsOutline) {
  const std::string domain =
      "[domain]\nx = [-5.0, 5.0]\ny = [-5.0, 5.0]\n[[excavation]]\nname = \"adit\"\nshape = \"file\"\nfile = "
      "\"";
  const std::string file = write(square("TUNNEL", "0", "2") + "0 LINE 8 AXIS 10 0 20 0 11 0 21 4 ");
  const Scenario scenario = read(domain + file + "\"\nlayers = [\"TUNNEL\"]\n");
  EXPECT_EQ(scenario.excavations.at(0).outer.size(), 4U);
  EXPECT_EQ(build_blocks(scenario, 0).system.blocks.size(), 2U);
  EXPECT_THAT(mistakes(domain + file + "\"\n"), HasSubstr("LINE on layer AXIS: found an open line"));
  EXPECT_THAT(mistakes(domain + drawn + "arch.dxf\"\n"), HasSubstr("found 17 closed lines"));
  EXPECT_THAT(mistakes(domain + file + "\"\ndiameter = 3.0\n"), HasSubstr("diameter"));
}

TEST_F(Drawings, TracesByLayer) {
  const std::string text = "[domain]\nx = [0.0, 4.0]\ny = [0.0, 4.0]\n";
  const std::string file =
      write("0 LINE 8 J1 10 0 20 2 11 4 21 2 0 LINE 8 J2 10 2 20 0 11 2 21 4 0 TEXT 8 J2 1 note ");
  const auto map = [&](const std::string& keys) {
    return "[[trace_map]]\nfile = \"" + file + "\"\n" + keys + "\n";
  };
  const Scenario both =
      read(text + map("layers = [\"j1\"]\nfriction = 20.0") + map("layers = [\"J2\"]\nfriction = 40.0"));
  EXPECT_EQ(both.trace_maps.at(0).name, "j1");
  EXPECT_EQ(both.trace_maps.at(1).joints.friction, 40.0);
  const BlockModel blocks = build_blocks(both, 0);
  EXPECT_EQ(blocks.system.blocks.size(), 4U);
  std::vector<std::string> warnings;
  add_block_warnings(both, blocks, warnings);
  EXPECT_THAT(warnings, Contains(HasSubstr("trace_map[1]: left out of the drawing: 1 TEXT on layer J2")));
  EXPECT_THAT(mistakes(text + "[[trace_map]]\nname = \"a\"\npoints = [[0, 0], [1, 1]]\nscale = 2.0"),
              HasSubstr("scale"));
}

TEST(BlockShapes, AnArchHasItsArea) {
  // A chord of 1 m and a rise of 0.2 m: r = (0.25 + 0.04)/0.4 = 0.725.
  const std::vector<Ring> stones = arch_stones({{3.0, 1.0}, 1.0, 0.2, 0.1, 7});
  ASSERT_EQ(stones.size(), 7U);
  const double angle = 2.0 * std::atan2(0.5, 0.525) / 7.0;
  for (const Ring& stone : stones)
    EXPECT_NEAR(signed_area(stone), 0.5 * (0.825 * 0.825 - 0.725 * 0.725) * std::sin(angle), 1e-12);
  EXPECT_LT(norm(stones.front()[0] - Vec2{2.5, 1.0}), 1e-12);
  EXPECT_LT(norm(stones.back()[1] - Vec2{3.5, 1.0}), 1e-12);
  EXPECT_NEAR(stones[3][2].y, 1.0 + 0.2 + 0.1 - 0.825 * (1.0 - std::cos(0.5 * angle)), 1e-12);
}

TEST(BlockShapes, AWallInBondAndAColumn) {
  const WallShape wall{{1.0, 2.0}, 3.0, 0.9, 0.62, 0.2, 0.5};  // 5 stones of 0.6, 4 courses … of 0.225
  const std::vector<Ring> stones = wall_stones(wall);
  ASSERT_EQ(stones.size(), 2U * 5U + 2U * 6U + (std::round(0.9 / 0.2) == 5.0 ? 5U : 0U));
  double sum = 0.0;
  for (const Ring& stone : stones) sum += signed_area(stone);
  EXPECT_NEAR(sum, 2.7, 1e-12);
  EXPECT_NEAR(signed_area(stones[5]), 0.5 * signed_area(stones[0]), 1e-12);
  WallShape stack = wall;
  stack.bond = 0.0;
  EXPECT_EQ(wall_stones(stack).size() % 5, 0U);
  const std::vector<Ring> drums = column_stones({{0.0, 0.0}, 6.0, 1.2, 0.8, 4});
  ASSERT_EQ(drums.size(), 4U);
  double column = 0.0;
  for (const Ring& drum : drums) column += signed_area(drum);
  EXPECT_NEAR(column, 6.0, 1e-12);
}

TEST(Tessellations, CutADomainIntoTheirBlocks) {
  const std::string domain = "[domain]\nx = [0.0, 10.0]\ny = [0.0, 8.0]\n[[trace_map]]\nname = \"t\"\n";
  const Scenario bricks = read(domain + "pattern = \"brick\"\nsize = 1.0\ncourse_height = 0.5\n");
  EXPECT_EQ(build_blocks(bricks, 0).system.blocks.size(), 8U * 10U + 8U * 11U);
  const Scenario voronoi = read(domain + "pattern = \"voronoi\"\nsize = 1.0\nfriction = 20.0\n");
  EXPECT_EQ(build_blocks(voronoi, 0).system.blocks.size(), 80U);
  EXPECT_NE(build_blocks(voronoi, 1).system.blocks[0].polygon.outer,
            build_blocks(voronoi, 0).system.blocks[0].polygon.outer);
  const Scenario part = read(domain +
                             "pattern = \"brick\"\nsize = 1.0\ncourse_height = 1.0\nbond = 0.0\nregion = "
                             "[[2, 2], [2, 5], [6, 5], [6, 2]]\n");
  EXPECT_EQ(build_blocks(part, 0).system.blocks.size(), 12U + 1U);
  EXPECT_THAT(mistakes(domain + "pattern = \"voronoi\"\nsize = 0.01\n"),
              HasSubstr("trace_map.t.size: found about 8e+05 blocks"));
  EXPECT_THAT(mistakes(domain + "pattern = \"voronoi\"\nsize = 1.0\nbond = 0.5\n"), HasSubstr("bond"));
  EXPECT_THAT(mistakes(domain + "pattern = \"brick\"\nsize = 1.0\n"),
              HasSubstr("course_height: found nothing"));
  EXPECT_THAT(
      mistakes(domain + "pattern = \"brick\"\nsize = 1.0\ncourse_height = 1.0\npoints = [[0, 0], [1, 1]]\n"),
      HasSubstr("one of the two"));
}

TEST(Slopes, WithBerms) {
  // Three benches of 4 m at 63.4°, 2 m back each, with berms of 1 m: the crest is 8 m behind the toe.
  const SlopeShape slope{{10.0, 0.0}, true, 10.0, std::atan(2.0) * 180.0 / std::numbers::pi, 4.0, 1.0, 3};
  const Ring right = slope_outline(slope);
  ASSERT_EQ(right.size(), 8U);
  EXPECT_LT(norm(right[6] - Vec2{18.0, 12.0}), 1e-12);
  // Above bench k: 10 m of floor, what is behind it, and half of its own setback.
  EXPECT_NEAR(signed_area(right), 4.0 * (11.0 + 14.0 + 17.0), 1e-9);
  SlopeShape other = slope;
  other.rises_to_the_right = false;
  EXPECT_NEAR(signed_area(slope_outline(other)), signed_area(right), 1e-9);
  const Scenario scenario = read(
      "[domain]\nx = [0.0, 30.0]\ny = [-10.0, 12.0]\n[[excavation]]\nname = \"cut\"\nshape = \"slope\"\ntoe "
      "= [10, 0]\nfloor = 10\n"
      "face_angle = 90\nbench_height = 4\nberm = 1\nbenches = 3\n");
  EXPECT_EQ(build_blocks(scenario, 0).system.blocks.size(), 2U);
}

TEST(Guide, SnippetsOfDrawingsWork) {
  EXPECT_EQ(read(snippet("name = \"arch\"", "drawings.md")).blocks.size(), 15U + 6U + 6U * 10U + 6U * 11U);
  const std::string domain = "[domain]\nx = [0.0, 30.0]\ny = [-5.0, 12.0]\n";
  EXPECT_EQ(build_blocks(read(domain + snippet("name = \"cut\"", "drawings.md")), 0).system.blocks.size(),
            2U);
  EXPECT_EQ(read(domain + snippet("name = \"bricks\"", "drawings.md")).trace_maps.size(), 2U);
}

TEST(BlockShapes, AreBlocksOfAScenario) {
  const Scenario scenario = read(R"(
[[block_map]]
name = "pier"
shape = "column"
foot = [0.0, 0.0]
height = 4.0
width = 1.0
drums = 5
[[block_map]]
name = "wall"
shape = "wall"
corner = [2.0, 0.0]
length = 2.0
height = 1.0
stone_length = 0.5
course_height = 0.25
bond = 0.25
fixed = true
)");
  EXPECT_EQ(scenario.blocks.size(), 5U + 4U * 2U + 5U * 2U);
  EXPECT_EQ(scenario.blocks[4].name, "pier 5");
  EXPECT_EQ(scenario.blocks[4].path, "block_map.pier.'pier 5'");
  EXPECT_TRUE(scenario.blocks[5].fixed);
  EXPECT_THAT(mistakes("[[block_map]]\nname = \"w\"\nshape = \"wall\"\ncorner = [0, 0]\nlength = 1e4\nheight "
                       "= 1e4\nstone_length = 0.01\ncourse_height = 0.01"),
              HasSubstr("at most 1e+05"));
}

}  // namespace
}  // namespace keyblock::scenario::drawings_of_scenarios
