#include "contact/competition.h"

#include <gtest/gtest.h>

#include "contact/entry_face.h"
#include "corner_scene.h"

namespace keyblock::contact {
namespace {

/// Two blocks whose ends are this far apart: the upper block is shifted to the right by `shift`.
CornerScene stacked(double shift) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));                  // vertices 0 to 3; edge 2 is its top
  add_block(surface, rectangle(shift, 1, 1.0 + shift, 2.0));  // vertices 4 to 7; edge 4 is its bottom
  return CornerScene(surface);
}

/// Those whose vertex it is.
std::vector<Competitor*> competitors_of(const CornerView& view, std::span<Competitor> all, int vertex) {
  std::vector<Competitor*> found;
  for (Competitor& c : all) {
    if (view.candidate(c).vertex == vertex) found.push_back(&c);
  }
  return found;
}

TEST(Competitors, MeetAtTheEndsOfAFace) {
  const CornerScene scene = stacked(0.001);
  std::vector<Competitor> all = scene.competitors(0);
  ASSERT_EQ(all.size(), 4U);
  const CornerView view = scene.view();
  // Left: vertex 4 over the top, and vertex 3 beside the bottom. Right: vertex 2 and vertex 5.
  Competitor *left = competitor_of(view, all, 4, 2), *left_other = competitor_of(view, all, 3, 4);
  ASSERT_TRUE(left != nullptr && left_other != nullptr);
  EXPECT_TRUE(left->disputed && left_other->disputed);
  EXPECT_EQ(left->corners, left_other->corners);
  EXPECT_NEAR(left->along, 0.999, 1e-12);
  EXPECT_FALSE(left->first_half);
  EXPECT_NEAR(left_other->along, -0.001, 1e-12);
  EXPECT_NEAR(inside(view, *left_other), -0.001, 1e-12);
  EXPECT_NE(competitor_of(view, all, 2, 4)->corners, left->corners);
  // Far from an end a vertex meets no corner.
  const CornerScene apart = stacked(0.3);
  std::vector<Competitor> far = apart.competitors(0);
  ASSERT_EQ(far.size(), 2U);
  EXPECT_FALSE(far[0].disputed || far[1].disputed);
  EXPECT_EQ(far[0].corners, 0U);
}

/// Outcome at the left end of that face: vertex of the winner; −1: none.
int winner_at_left_end(CornerScene& scene, bool& handed_over) {
  std::vector<Competitor> all = scene.competitors(0);
  const CornerView view = scene.view();
  std::vector<Competitor*> left;
  for (Competitor& c : all) {
    const int vertex = view.candidate(c).vertex;
    if (vertex == 4 || vertex == 3) left.push_back(&c);
  }
  EXPECT_EQ(left.size(), 2U);
  const Outcome outcome = compete(view, left);
  EXPECT_TRUE(outcome.parallel);
  EXPECT_FALSE(outcome.left_out);
  handed_over = outcome.handed_over;
  return outcome.winner == nullptr ? -1 : view.candidate(*outcome.winner).vertex;
}

TEST(Competition, OfParallelLinesTheVertexOverTheEdgeWins) {
  for (const double shift : {0.001, -0.001}) {
    CornerScene scene = stacked(shift);
    bool handed_over = true;
    EXPECT_EQ(winner_at_left_end(scene, handed_over), shift > 0.0 ? 4 : 3);
    EXPECT_FALSE(handed_over);
  }
}

TEST(Competition, TheLastContactStaysUntilItHasClearlyLeft) {
  const double leaves = -leave(Tolerances(1.0));
  for (const double share : {0.9, 1.1}) {
    CornerScene scene = stacked(-share * leaves);  // vertex 4 has left the top by that
    scene.press(scene.candidate_of(4, 2));
    bool handed_over = false;
    EXPECT_EQ(winner_at_left_end(scene, handed_over), share < 1.0 ? 4 : 3);
    EXPECT_EQ(handed_over, share > 1.0);
  }
}

/// Corner to corner: the tip of the upper block, vertex 4, has passed the top of the lower one, edge 2, by `depth` and its side, edge 1, by
/// `beside`.
CornerScene corner_to_corner(double depth, double beside) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, {{{1.0 - beside, 1.0 - depth}, {1.7, 1.1}, {1.6, 1.6}, {1.1, 1.7}}, {}});
  return CornerScene(surface);
}

TEST(Competition, OfLinesThatWerePassedTheShortestWayOutWins) {
  for (const bool by_side : {true, false}) {
    const CornerScene scene = by_side ? corner_to_corner(0.002, 0.0005) : corner_to_corner(0.0005, 0.002);
    std::vector<Competitor> all = scene.competitors(0);
    const CornerView view = scene.view();
    const std::vector<Competitor*> of_tip = competitors_of(view, all, 4);
    ASSERT_EQ(of_tip.size(), 2U);
    const Outcome outcome = compete(view, of_tip);
    EXPECT_FALSE(outcome.parallel);
    ASSERT_NE(outcome.winner, nullptr);
    EXPECT_EQ(view.candidate(*outcome.winner).edge, by_side ? 1 : 2);
    EXPECT_TRUE(part_otherwise(view, *of_tip[0], *of_tip[1]));
    EXPECT_NEAR(cosine_between(view, *of_tip[0], *of_tip[1]), 0.0, 1e-12);
  }
}

TEST(Competition, TipToTipIsATieUnlessOneLinePressed) {
  CornerScene scene = corner_to_corner(-2e-5, -2e-5);
  for (const bool pressed : {false, true}) {
    if (pressed) scene.press(scene.candidate_of(4, 1));
    std::vector<Competitor> all = scene.competitors(0);
    ASSERT_GE(all.size(), 2U);
    const CornerView view = scene.view();
    const Outcome outcome = compete(view, pointers_to(all));
    ASSERT_EQ(outcome.winner != nullptr, pressed);
    if (pressed) {
      EXPECT_EQ(view.candidate(*outcome.winner).edge, 1);
    }
  }
}

TEST(Competition, ThePredictedDisplacementTellsWhichLineIsPassedLast) {
  for (const bool over_side : {true, false}) {
    CornerScene scene = corner_to_corner(-1e-4, -1e-4);
    // The upper block goes far past one line and a little past the other, which it passes last.
    const Vec2 goes = over_side ? Vec2{-0.0006, -0.004} : Vec2{-0.004, -0.0006};
    std::vector<Vec2> predicted(8);
    std::fill(predicted.begin() + 4, predicted.end(), goes);
    scene.motion.predicted = predicted;
    std::vector<Competitor> all = scene.competitors(0);
    const CornerView view = scene.view();
    const std::vector<Competitor*> of_tip = competitors_of(view, all, 4);
    ASSERT_EQ(of_tip.size(), 2U);
    const Outcome outcome = compete(view, of_tip);
    ASSERT_NE(outcome.winner, nullptr);
    EXPECT_EQ(view.candidate(*outcome.winner).edge, over_side ? 1 : 2);
  }
}

TEST(EntryFace, DistanceIsToTheNearestOtherEdge) {
  Surface surface;
  add_block(surface, rectangle(0, 0, 1, 1));
  add_block(surface, {{{0.3, 0.99}, {0.8, 1.5}, {0.2, 1.5}}, {}});
  const CornerScene scene(surface);
  const CornerView view = scene.view();
  EXPECT_NEAR(distance_to_other_edges(view, 4, 2), 0.3, 1e-12);  // to the left side
  EXPECT_NEAR(distance_to_other_edges(view, 4, 2, 3), 0.7, 1e-12);
}

TEST(EntryFace, AVertexThatSlidPastACornerCameInElsewhere) {
  // The tip is 5 mm behind the top, and 2 mm behind the side.
  const CornerScene scene = corner_to_corner(0.005, 0.002);
  std::vector<Competitor> all = scene.competitors(0);
  const CornerView view = scene.view();
  Competitor *top = competitor_of(view, all, 4, 2), *side = competitor_of(view, all, 4, 1);
  ASSERT_TRUE(top != nullptr && side != nullptr);
  EXPECT_TRUE(has_come_in_elsewhere(view, *top));
  EXPECT_FALSE(has_come_in_elsewhere(view, *top, 1)) << "the side does not count";
  EXPECT_FALSE(has_come_in_elsewhere(view, *side));
  CornerScene pressed = corner_to_corner(0.005, 0.002);
  pressed.press(pressed.candidate_of(4, 2));
  std::vector<Competitor> again = pressed.competitors(0);
  const Competitor* held = competitor_of(pressed.view(), again, 4, 2);
  EXPECT_TRUE(holds_vertex(pressed.view(), *held));
  EXPECT_FALSE(has_come_in_elsewhere(pressed.view(), *held)) << "however deep it is pressed in";
}

}  // namespace
}  // namespace keyblock::contact
