#include "solve/increment_history.h"

#include <gtest/gtest.h>

#include <vector>

namespace keyblock::dynamics {
namespace {

using Increment = std::vector<double>;

class History {
 public:
  void add(const Increment& increment, double dt, bool quiet = false) {
    history_.add(increment, dt, quiet, team_);
  }
  void forget() { history_.forget(); }
  [[nodiscard]] bool is_smooth() const { return history_.is_smooth(); }
  [[nodiscard]] Increment guess(double dt) {
    Increment increment{9.0, 9.0};
    history_.extrapolate(dt, increment, team_);
    return increment;
  }

 private:
  ThreadTeam team_{1};
  IncrementHistory history_;
};

TEST(IncrementHistory, GoesOnAsTheLastStepsDid) {
  History history;
  EXPECT_EQ(history.guess(0.1), (Increment{0.0, 0.0}));
  history.add({1.0, -1.0}, 0.1);
  EXPECT_EQ(history.guess(0.1), (Increment{1.0, -1.0}));
  history.add({3.0, -1.5}, 0.1);
  EXPECT_EQ(history.guess(0.1), (Increment{5.0, -2.0}));
  history.add({4.0, -1.5}, 0.1);
  EXPECT_EQ(history.guess(0.1), (Increment{5.0, -1.5}));
  EXPECT_EQ(history.guess(0.05), (Increment{0.0, 0.0})) << "a step of another length";
  history.add({2.0, 2.0}, 0.05);
  EXPECT_EQ(history.guess(0.05), (Increment{2.0, 2.0})) << "only those of the same length";
  history.forget();
  EXPECT_EQ(history.guess(0.05), (Increment{0.0, 0.0}));
}

// Small whole numbers, so that nothing is rounded.
TEST(IncrementHistory, FollowsACurveWhileNoContactChanges) {
  const auto cubic = [](int k) { return Increment{2.0 * k * k * k - k * k + 3.0, 5.0 - k}; };
  History history;
  for (int k = 0; k < 6; ++k) {
    history.add(cubic(k), 0.1, true);
    if (k < 3) continue;
    EXPECT_EQ(history.guess(0.1), cubic(k + 1)) << k;
  }
  const Increment last = cubic(5), jolt{100.0, -7.0};
  history.add(jolt, 0.1, false);
  EXPECT_EQ(history.guess(0.1), (Increment{2.0 * jolt[0] - last[0], 2.0 * jolt[1] - last[1]}));
  // The jolt is one of the first three steps after it, and the curve does without what was before.
  for (int k = 0; k < 4; ++k) history.add(cubic(k), 0.1, true);
  EXPECT_EQ(history.guess(0.1), cubic(4));
}

TEST(IncrementHistory, IsSmoothAfterThreeStepsWithoutAChange) {
  History history;
  const auto add = [&](bool quiet, double dt = 0.1) {
    history.add({1.0, 2.0}, dt, quiet);
    return history.is_smooth();
  };
  EXPECT_FALSE(history.is_smooth());
  EXPECT_FALSE(add(true) || add(true));
  EXPECT_TRUE(add(true));
  EXPECT_FALSE(add(false)) << "a contact changed";
  EXPECT_FALSE(add(true) || add(true));
  EXPECT_TRUE(add(true) && add(true) && add(true));
  EXPECT_FALSE(add(true, 0.05)) << "a step of another length";
  EXPECT_FALSE(add(true, 0.05));
  EXPECT_TRUE(add(true, 0.05));
  history.forget();
  EXPECT_FALSE(history.is_smooth());
}

// The curve goes through four increments at most, so that what lies farther back has no part in it.
TEST(IncrementHistory, KnowsNoMoreThanFourIncrements) {
  History history;
  history.add({1e6, -1e6}, 0.1, true);
  for (int k = 0; k < 4; ++k) history.add({7.0, 2.0 * k}, 0.1, true);
  EXPECT_EQ(history.guess(0.1), (Increment{7.0, 8.0}));
}

}  // namespace
}  // namespace keyblock::dynamics
