#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "study/outputs.h"
#include "synthetic_study.h"

namespace keyblock::study {
namespace {

using record::BlockStatus;

/// A square block of side 1 with its lower left corner at (x, y).
void add_block(record::ModelRecord& model, record::Frame& frame, double x, double y, BlockStatus status,
               std::array<float, 2> u = {0.0F, 0.0F}) {
  record::ModelRecord::Block block;
  const int first = static_cast<int>(model.vertices.size());
  block.ring_start = {first, first + 4};
  block.area = 1.0;
  model.blocks.push_back(block);
  for (const Vec2 p : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) {
    model.vertices.push_back(p + Vec2{x, y});
    frame.displacement.push_back(u);
  }
  frame.status.push_back(status);
}

std::string path_of(const std::string& svg, char name) {
  const std::string mark = std::string("<path class=\"") + name + "\"";
  const std::size_t at = svg.find(mark);
  if (at == std::string::npos) return "";
  const std::size_t from = svg.find(" d=\"", at) + 4;
  return svg.substr(from, svg.find('"', from) - from);
}

TEST(Thumbnail, DrawsBlocksWhereTheyAreByStatus) {
  record::ModelRecord model;
  record::Frame frame;
  add_block(model, frame, 0, 0, BlockStatus::in_place);
  add_block(model, frame, 1, 0, BlockStatus::excavated);
  add_block(model, frame, 1, 1, BlockStatus::fallen, {0.0F, -1.0F});
  add_block(model, frame, 0, 1, BlockStatus::loosened);
  const std::string svg = thumbnail_svg(model, frame);
  EXPECT_NE(svg.find("viewBox=\"0 0 2000 2000\""), std::string::npos);
  // No opening: the window is that of the rock, 2 × 2 m, 1000 units a metre, y down.
  EXPECT_EQ(path_of(svg, 'r'), "m0 2000l1000 0 0-1000-1000 0z");
  EXPECT_EQ(path_of(svg, 'f'), "m1000 2000l1000 0 0-1000-1000 0z");
  EXPECT_EQ(path_of(svg, 'l'), "m0 1000l1000 0 0-1000-1000 0z");
}

TEST(Thumbnail, ShowsTheSurroundingsOfTheOpening) {
  record::ModelRecord model;
  record::Frame frame;
  for (int i = -20; i < 20; ++i)
    for (int j = -20; j < 20; ++j) add_block(model, frame, i, j, BlockStatus::in_place);
  model.excavation_outlines = {{{-2, -1}, {2, -1}, {2, 1}, {-2, 1}}};
  const std::string svg = thumbnail_svg(model, frame);
  // 4 × 2 m and 3.2 m on each side.
  EXPECT_NE(svg.find("viewBox=\"0 0 2000 1615\""), std::string::npos) << svg.substr(0, 200);
  const std::string rock = path_of(svg, 'r');
  EXPECT_LE(std::count(rock.begin(), rock.end(), 'z'), 12 * 10);
  EXPECT_EQ(path_of(svg, 'o').substr(0, 4), "m615");
}

TEST(Thumbnail, FixedBlocksAreToldApartAndDoNotSetTheWindow) {
  record::ModelRecord model;
  record::Frame frame;
  add_block(model, frame, 0, 0, BlockStatus::in_place);
  add_block(model, frame, 5, 5, BlockStatus::in_place);
  add_block(model, frame, 0.5, 0.5, BlockStatus::in_place);
  model.blocks[1].fixed = model.blocks[2].fixed = true;
  const std::string svg = thumbnail_svg(model, frame);
  EXPECT_EQ(path_of(svg, 'r'), "m0 2000l2000 0 0-2000-2000 0z");
  EXPECT_EQ(path_of(svg, 'x'), "m1000 1000l2000 0 0-2000-2000 0z");
}

TEST(Thumbnail, NothingIsAPictureToo) {
  const std::string svg = thumbnail_svg({}, {});
  EXPECT_EQ(svg.substr(0, 4), "<svg");
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST(Thumbnail, OfATunnelOfEightHundredBlocksIsSmall) {
  for (int r = 0; r < 5; ++r) {
    const auto [model, frame] = made_up::synthetic_tunnel(r, 0.5);
    const std::string svg = thumbnail_svg(model, frame);
    EXPECT_LE(svg.size(), 12'000U);
    EXPECT_GE(svg.size(), 5'000U);
    // Enlarged, the opening is still round.
    EXPECT_GE(std::atoi(svg.substr(svg.find("viewBox=\"0 0 ") + 13).c_str()), 700);
    EXPECT_FALSE(path_of(svg, 'f').empty());
    EXPECT_FALSE(path_of(svg, 'l').empty());
    EXPECT_EQ(svg, thumbnail_svg(model, frame));
  }
}

}  // namespace
}  // namespace keyblock::study
