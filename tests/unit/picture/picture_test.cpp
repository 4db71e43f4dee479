#include "picture/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "picture/force_chains.h"
#include "picture/quantities.h"
#include "picture/view.h"

namespace keyblock::picture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

record::ContactRecord contact(int a, int b, Vec2 place, Vec2 normal, double force) {
  record::ContactRecord c;
  c.block_a = a;
  c.block_b = b;
  c.position = place;
  c.normal = normal;
  c.normal_force = force;
  c.length = 0.5;
  return c;
}

// Three blocks of 1 m side by side; the last one has flown 100 m away at the end, the first one is fixed.
results::RunData three_blocks() {
  results::RunData run;
  run.model.title = "Three <blocks> & a stone";
  run.model.stage_names = {"fall"};
  for (int b = 0; b < 3; ++b) {
    record::ModelRecord::Block block;
    block.area = 1.0;
    block.fixed = b == 0;
    block.centroid = {b + 0.5, 0.5};
    block.ring_start = {4 * b, 4 * b + 4};
    run.model.blocks.push_back(block);
    for (const Vec2 corner : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}})
      run.model.vertices.push_back(corner + Vec2{static_cast<double>(b), 0.0});
  }
  run.model.edge_label.resize(12);
  record::Frame frame;
  frame.displacement.resize(12);
  frame.stress.resize(3);
  frame.status.resize(3);
  frame.order.assign(3, 1);
  run.frames = {frame, frame};
  run.frames[1].time = 2.0;
  run.frames[1].step = 100;
  for (std::size_t v = 4; v < 8; ++v) run.frames[1].displacement[v] = {0.0F, -0.25F};
  for (std::size_t v = 8; v < 12; ++v) run.frames[1].displacement[v] = {100.0F, 0.0F};
  return run;
}

TEST(Scale, IsRound) {
  EXPECT_DOUBLE_EQ(nice_above(0.0013), 0.002);
  EXPECT_DOUBLE_EQ(nice_above(5.0), 5.0);
  EXPECT_DOUBLE_EQ(nice_below(7.0), 5.0);
  EXPECT_DOUBLE_EQ(nice_below(1.9), 1.0);
  EXPECT_EQ(with_unit(0.0034, Quantity::length), "3.4\u00a0mm");
  EXPECT_EQ(with_unit(-2.5e6, Quantity::stress), "-2.5\u00a0MPa");
}

TEST(Scale, HasDecadesWhereAFewAreFarAboveTheRest) {
  EXPECT_FALSE(scale_of_sizes({0.001, 0.002, 0.003}).logarithmic);
  const Scale scale = scale_of_sizes({0.001, 0.001, 0.001, 3.0});
  EXPECT_TRUE(scale.logarithmic);
  EXPECT_DOUBLE_EQ(scale.high, 5.0);
  EXPECT_DOUBLE_EQ(scale.place(5.0), 1.0);
  EXPECT_DOUBLE_EQ(scale.place(0.0), 0.0);
}

TEST(ForceChains, AddUpAndLieWhereTheResultantIs) {
  record::ContactFrame contacts;
  // A joint from 0 to 1 m: 3 N at its begin, 1 N at its end, so the resultant is at 1/4.
  contacts.contacts = {contact(1, 0, {0.0, 0.0}, {0, 1}, 3.0), contact(0, 1, {1.0, 0.0}, {0, -1}, 1.0),
                       contact(1, 2, {0.0, 2.0}, {0, 1}, 5.0), contact(1, 2, {1.0, 2.0}, {0, 1}, 0.0)};
  const auto chains = force_chains(contacts);
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_DOUBLE_EQ(chains[0].force, 4.0);
  EXPECT_DOUBLE_EQ(chains[0].middle.x, 0.25);
  EXPECT_DOUBLE_EQ(std::abs(chains[0].eccentricity), 0.5);
  EXPECT_FALSE(chains[0].is_hinge());
  EXPECT_DOUBLE_EQ(std::abs(chains[1].eccentricity), 1.0);
  EXPECT_TRUE(chains[1].is_hinge());
  const auto lines = lines_of_thrust(three_blocks().model, chains);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].block, 1);
  EXPECT_EQ(lines[0].to, (Vec2{0.0, 2.0}));
}

TEST(Principal, IsThatOfMohrsCircle) {
  // Pure shear of 2 Pa: ±2 Pa at 45°.
  const Principal p = principal_of({0.0F, 0.0F, 2.0F});
  EXPECT_DOUBLE_EQ(p.larger, 2.0);
  EXPECT_DOUBLE_EQ(p.smaller, -2.0);
  EXPECT_DOUBLE_EQ(p.angle, std::atan(1.0));
}

TEST(Window, IsThatOfTheStructureNotOfTheStoneThatFlewFarthest) {
  const results::RunData run = three_blocks();
  const Box window = window_of(run);
  EXPECT_LT(window.max.x, 4.0);
  EXPECT_LE(window.min.y, 0.0);
}

TEST(Quantities, DisplacementIsThatOfTheCentroids) {
  const results::RunData run = three_blocks();
  const BlockValues values(run, *find_quantity("displacement"));
  EXPECT_THAT(values.at(1), ElementsAre(0.0, 0.25, 100.0));
  EXPECT_EQ(find_quantity("color"), nullptr);
}

TEST(Picture, HasTitleTimeLegendAndScaleBar) {
  const results::RunData run = three_blocks();
  const SectionPicture picture(run, {});
  const std::string svg = picture.draw(1);
  EXPECT_THAT(svg, HasSubstr("Three &lt;blocks&gt; &amp; a stone"));
  EXPECT_THAT(svg, HasSubstr("fall, t = 2.000 s"));
  EXPECT_THAT(svg, HasSubstr("Displacement of the blocks"));
  EXPECT_THAT(svg, HasSubstr("200\u00a0mm"));
  EXPECT_EQ(picture.file_name(1), "three-blocks-a-stone-displacement-2.000s");
  EXPECT_EQ(svg, SectionPicture(run, {}).draw(1)) << "the same bytes again";
}

TEST(Picture, DoesNotPaintAFrameThatCarriesNoFriction) {
  results::RunData run = three_blocks();
  for (auto& label : run.model.edge_label) label.kind = cutting::EdgeKind::domain;
  record::ContactFrame contacts;
  contacts.contacts = {contact(1, 0, {1.0, 0.25}, {1, 0}, 3.0)};
  contacts.contacts[0].state = record::ContactState::sliding;
  run.contacts = {contacts};
  Options options;
  options.color = "plain";
  options.joints = "state";
  const std::string frame = SectionPicture(run, options).draw(0);
  for (auto& label : run.model.edge_label) label.kind = cutting::EdgeKind::joint_set;
  const std::string joints = SectionPicture(run, options).draw(0);
  EXPECT_THAT(frame, Not(HasSubstr("stroke=\"#d55e00\"")));
  EXPECT_THAT(joints, HasSubstr("stroke=\"#d55e00\""));
}

TEST(Picture, EveryQuantityAndMarkIsDrawn) {
  const results::RunData run = three_blocks();
  Options options;
  options.forces = options.stress = options.thrust = options.outline = true;
  options.arrows = "displacement";
  options.joints = "slip";
  for (const BlockQuantity& quantity : block_quantities()) {
    options.color = quantity.name;
    EXPECT_THAT(SectionPicture(run, options).draw(1), HasSubstr("</svg>")) << quantity.name;
  }
}

TEST(FrameNear, IsTheNearest) {
  const results::RunData run = three_blocks();
  EXPECT_EQ(frame_near(run, 0.4), 0U);
  EXPECT_EQ(frame_near(run, 1.6), 1U);
}

TEST(FileWord, HasNothingThatAFolderWouldMind) {
  EXPECT_EQ(file_word("../a b/Ü c"), "a-b-c");
  EXPECT_EQ(file_word(""), "section");
}

}  // namespace
}  // namespace keyblock::picture
