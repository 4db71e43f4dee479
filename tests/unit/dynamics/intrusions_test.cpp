#include "dynamics/intrusions.h"

#include <gtest/gtest.h>

#include <limits>

namespace keyblock::dynamics {
namespace {

/// Two unit squares side by side, 0.1 m apart; the second one goes to the left.
struct Squares {
  Squares() {
    surface.block_begin = {0, 4, 8};
    for (const double x : {0.0, 1.1}) {
      for (const Vec2 corner : {Vec2{0.0, 0.0}, Vec2{1.0, 0.0}, Vec2{1.0, 1.0}, Vec2{0.0, 1.0}})
        surface.position.push_back({x + corner.x, (x > 0.0 ? 0.3 : 0.0) + corner.y});
    }
    surface.next = {1, 2, 3, 0, 5, 6, 7, 4};
    surface.block = {0, 0, 0, 0, 1, 1, 1, 1};
    candidates.pairs = {{.vertex = 2, .edge = 7, .block_a = 0, .block_b = 1},
                        {.vertex = 4, .edge = 1, .block_a = 1, .block_b = 0}};
    contact::BlockPair pair;
    pair.block_b = 1;
    candidates.block_pairs = {pair};
  }
  /// Whether the second square comes into the first one, where it goes by x to the left from where it lies `nearer` by already.
  bool come_in(double x, double nearer = 0.0, double closure = 0.0) {
    contact::Surface at_start = surface;
    for (std::size_t v = 4; v < 8; ++v) at_start.position[v].x -= nearer;
    std::vector<Vec2> went(8);
    for (std::size_t v = 4; v < 8; ++v) went[v] = {-x, 0.0};
    const std::function<Vec2(std::size_t)> at_end = [&](std::size_t v) {
      return at_start.position[v] + went[v];
    };
    const std::function<double(int, int)> explained = [&](int, int) { return closure; };
    return Intrusions({1.0, 1.0}).any({at_start, went, {}, at_end, explained}, candidates);
  }

  contact::Surface surface;
  contact::CandidateList candidates;
};

TEST(Intrusions, AreVerticesThatAStepTakesIntoAnotherBlock) {
  Squares squares;
  EXPECT_FALSE(squares.come_in(0.0));
  EXPECT_FALSE(squares.come_in(0.09)) << "it stays outside";
  EXPECT_FALSE(squares.come_in(0.1 + 0.9 * Intrusions::most_share));
  EXPECT_TRUE(squares.come_in(0.1 + 1.1 * Intrusions::most_share));
  EXPECT_TRUE(squares.come_in(0.4));
}

TEST(Intrusions, AreNotWhatAContactHolds) {
  EXPECT_FALSE(Squares().come_in(0.2, 0.0, std::numeric_limits<double>::infinity()));
}

TEST(Intrusions, AreNotWhatTheClosureOfJointsExplains) {
  EXPECT_FALSE(Squares().come_in(0.2, 0.0, 0.1 - 0.9 * Intrusions::most_share));
  EXPECT_TRUE(Squares().come_in(0.2, 0.0, 0.1 - 1.1 * Intrusions::most_share));
}

TEST(Intrusions, AreNotWhatLayThereBefore) {
  EXPECT_FALSE(Squares().come_in(0.001, 0.2));
  EXPECT_TRUE(Squares().come_in(0.05, 0.2)) << "and goes on";
}

TEST(Intrusions, AreThoseOfFixedBlocksThatAreMoved) {
  const Squares squares;
  const std::vector<Vec2> went(8), prescribed{{}, {-0.2, 0.0}};
  const std::function<Vec2(std::size_t)> at_end = [&](std::size_t v) {
    return squares.surface.position[v] + prescribed[v / 4];
  };
  const std::function<double(int, int)> explained = [](int, int) { return 0.0; };
  EXPECT_TRUE(
      Intrusions({1.0, 1.0}).any({squares.surface, went, prescribed, at_end, explained}, squares.candidates));
}

}  // namespace
}  // namespace keyblock::dynamics
