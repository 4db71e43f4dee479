#include <gtest/gtest.h>

#include "contact/blocking.h"
#include "contact/contact_choice.h"
#include "contact/joint_continuity.h"
#include "corner_scene.h"

namespace keyblock::contact {
namespace {

/// Two blocks side by side, the right one `step` higher, and a small one whose left bottom corner is just past the joint between them.
CornerScene over_joint(double step, double past) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));                                    // edge 2: its top
  add_block(surface, rectangle(1, 0, 2, 1.0 + step));                           // edge 6: its top
  add_block(surface, rectangle(1.0 - past - 0.5, 1 - 0.001, 1.0 + past, 1.5));  // vertex 9: right bottom
  return CornerScene(surface);
}

TEST(JointContinuity, AFaceContinuesOverAJointThatIsEven) {
  for (const double step : {0.0, 1e-4, 1e-3}) {
    const CornerScene scene = over_joint(step, 0.005);
    EXPECT_EQ(continues(scene.view(), 9, 2, 6), step < 2e-4) << step;
    EXPECT_FALSE(continues(scene.view(), 9, 2, 5)) << "not to a side";
  }
  EXPECT_FALSE(continues(over_joint(0.0, -0.005).view(), 9, 2, 6))
      << "the vertex is still over the first face";
}

TEST(JointContinuity, TheNextFaceTakesOverTheMemory) {
  for (const double past : {0.002, 0.01}) {  // m; the end zone is 3 mm
    CornerScene scene = over_joint(0.0, past);
    const int held = scene.candidate_of(9, 2);
    ASSERT_GE(held, 0);
    scene.press(held, 7.0);
    const std::size_t pair = scene.pair_of(1, 2);
    ASSERT_LT(pair, scene.list.block_pairs.size());
    std::vector<Competitor> all = scene.competitors(pair);
    const CornerView view = scene.view();
    Competitor* on_next = competitor_of(view, all, 9, 6);
    ASSERT_NE(on_next, nullptr);
    EXPECT_EQ(on_next->memory, -1);
    EXPECT_TRUE(take_over_joint(view, scene.list.block_pairs[pair], all, *on_next));
    EXPECT_EQ(on_next->memory >= 0, past > 0.003) << "once it has left the end zone";
    if (Competitor* side = competitor_of(view, all, 9, 7)) {
      EXPECT_FALSE(take_over_joint(view, scene.list.block_pairs[pair], all, *side));
    }
  }
}

/// Four squares that meet in a point.
CornerScene crossing() {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, rectangle(1, 0, 2, 1));
  add_block(surface, rectangle(0, 1, 1, 2));
  add_block(surface, rectangle(1, 1, 2, 2));
  return CornerScene(surface);
}

TEST(Blocking, ASideThatAnotherBlockCoversIsClosed) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));  // edge 1: its right side, edge 2: its top
  add_block(surface, rectangle(1, 0, 2, 1));
  add_block(surface, {{{0.9995, 0.999}, {1.8, 1.5}, {1.2, 1.9}}, {}});  // vertex 8: a tip behind both
  const CornerScene scene(surface);
  const std::size_t pair = scene.pair_of(0, 2);
  ASSERT_LT(pair, scene.list.block_pairs.size());
  std::vector<Competitor> all = scene.competitors(pair);
  const Competitor *side = competitor_of(scene.view(), all, 8, 1),
                   *top = competitor_of(scene.view(), all, 8, 2);
  ASSERT_TRUE(side != nullptr && top != nullptr);
  const BlockPair& blocks = scene.list.block_pairs[pair];
  EXPECT_EQ(find_blocking(scene.view(), blocks, *side).in_the_way, Blocking::closed);
  const Blocking of_top = find_blocking(scene.view(), blocks, *top);
  EXPECT_EQ(of_top.in_the_way, 0.0);
  EXPECT_TRUE(of_top.is_beside);
  EXPECT_FALSE(of_top.is_in_front);
  // The side is passed last, but only the top is left.
  std::vector<Competitor*> tip;
  for (Competitor& c : all) {
    if (scene.view().candidate(c).vertex == 8) tip.push_back(&c);
  }
  EXPECT_EQ(compete(scene.view(), tip).winner, side);
  const Outcome outcome = compete_among_blocks(scene.view(), blocks, tip);
  EXPECT_EQ(outcome.winner, top);
  EXPECT_TRUE(outcome.left_out);
}

TEST(Blocking, AFaceThatTwoBlocksShareIsOpen) {
  CornerScene scene = crossing();
  const std::size_t pair = scene.pair_of(0, 1);
  const std::vector<Competitor> all = scene.competitors(pair);
  ASSERT_FALSE(all.empty());
  for (const Competitor& c : all) {
    if (!faces(scene.view(), c)) continue;
    EXPECT_EQ(find_blocking(scene.view(), scene.list.block_pairs[pair], c).in_the_way, 0.0);
  }
}

TEST(Blocking, ATipAloneHasNoBlockInItsWay) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, {{{0.9995, 0.99}, {1.6, 0.8}, {1.9, 1.5}, {1.2, 1.8}}, {}});
  CornerScene scene(surface);
  std::vector<Competitor> all = scene.competitors(0);
  ASSERT_FALSE(all.empty());
  for (const Competitor& c : all) {
    const Blocking found = find_blocking(scene.view(), scene.list.block_pairs[0], c);
    EXPECT_EQ(found.in_the_way, 0.0);
    EXPECT_FALSE(found.is_beside || found.is_in_front);
    if (c.is_beyond) {
      EXPECT_TRUE(is_out(scene.view(), scene.list.block_pairs[0], c));
    }
  }
  const std::vector<Competitor*> meeting = pointers_to(all);
  const std::span<Competitor* const> some =
      std::span(meeting).first(std::min(meeting.size(), most_competitors));
  EXPECT_EQ(compete_among_blocks(scene.view(), scene.list.block_pairs[0], some).winner,
            compete(scene.view(), some).winner);
}

TEST(ContactChoice, OneContactIsLeftWhereTwoCornersMeet) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, rectangle(0.001, 1, 1.001, 2));
  CornerScene scene(surface);
  std::vector<Competitor> all = scene.competitors(0);
  ASSERT_EQ(all.size(), 4U);
  BlockPair pair = scene.list.block_pairs[0];
  choose_contacts(SteadyPairs(), scene.view(), scene.list.pairs.size(), all, pair);
  EXPECT_EQ(std::ranges::count_if(all, [](const Competitor& c) { return c.candidate >= 0; }), 2);
}

}  // namespace
}  // namespace keyblock::contact
