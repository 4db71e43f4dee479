#include "dynamics/increment_history.h"

#include <gtest/gtest.h>

#include <vector>

namespace keyblock::dynamics {
namespace {

std::vector<double> guess(const IncrementHistory& history, double dt) {
  std::vector<double> increment{9.0, 9.0};
  history.extrapolate(dt, increment);
  return increment;
}

TEST(IncrementHistory, GoesOnAsTheLastStepsDid) {
  using Increment = std::vector<double>;
  IncrementHistory history;
  EXPECT_EQ(guess(history, 0.1), (Increment{0.0, 0.0}));
  history.add(Increment{1.0, -1.0}, 0.1);
  EXPECT_EQ(guess(history, 0.1), (Increment{1.0, -1.0}));
  history.add(Increment{3.0, -1.5}, 0.1);
  EXPECT_EQ(guess(history, 0.1), (Increment{5.0, -2.0}));
  history.add(Increment{4.0, -1.5}, 0.1);
  EXPECT_EQ(guess(history, 0.1), (Increment{5.0, -1.5}));
  EXPECT_EQ(guess(history, 0.05), (Increment{0.0, 0.0})) << "a step of another length";
  history.add(Increment{2.0, 2.0}, 0.05);
  EXPECT_EQ(guess(history, 0.05), (Increment{2.0, 2.0})) << "only those of the same length";
  history.forget();
  EXPECT_EQ(guess(history, 0.05), (Increment{0.0, 0.0}));
}

}  // namespace
}  // namespace keyblock::dynamics
