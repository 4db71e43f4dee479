#include "study/bisection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace keyblock::study {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using Status = Bisection::Status;

// Tries so many values at a time; the criterion holds on the side of `to` of the limit.
class Trials {
 public:
  Trials(const Bisection& bisection, double from, double to, double limit) : bisection_(bisection) {
    met_ = [=](double value) { return to > from ? value >= limit : value <= limit; };
  }
  Bisection::State run(std::size_t at_a_time) {
    const Known known = [&](double value) -> std::optional<bool> {
      const auto found = known_.find(value);
      return found == known_.end() ? std::nullopt : std::optional(found->second);
    };
    for (auto next = bisection_.next(known, at_a_time); !next.values.empty();
         next = bisection_.next(known, at_a_time))
      for (const double value : next.values) known_[value] = met_(value);
    return bisection_.follow(known);
  }
  /// The criterion holds where this says so.
  void hold_where(std::function<bool(double)> met) { met_ = std::move(met); }
  [[nodiscard]] std::size_t count() const { return known_.size(); }

 private:
  const Bisection& bisection_;
  std::function<bool(double)> met_;
  std::map<double, bool> known_;
};

TEST(Bisection, FindsTheBracketWithinTheTolerance) {
  for (const auto& [from, to, limit] : {std::tuple{45.0, 5.0, 30.0}, {0.0, 1e6, 1234.0}, {-3.0, 8.0, -0.7}}) {
    const Bisection bisection(from, to, 0.02);
    const auto state = Trials(bisection, from, to, limit).run(1);
    EXPECT_EQ(state.status, Status::found);
    EXPECT_GE(limit, std::min(state.not_met, state.met));
    EXPECT_LE(limit, std::max(state.not_met, state.met));
    EXPECT_LE(std::abs(state.met - state.not_met),
              0.02 * std::max(std::abs(state.met), std::abs(state.not_met)));
  }
}

TEST(Bisection, TriesTheSameValuesHoweverManyAtATime) {
  const Bisection bisection(45.0, 5.0, 0.01);
  Trials one(bisection, 45.0, 5.0, 31.7), three(bisection, 45.0, 5.0, 31.7);
  const auto expected = one.run(1), found = three.run(3);
  EXPECT_EQ(found.path, expected.path);
  EXPECT_EQ(found.not_met, expected.not_met);
  EXPECT_EQ(found.met, expected.met);
  EXPECT_EQ(one.count(), expected.path.size());
  EXPECT_GT(three.count(), found.path.size());
}

TEST(Bisection, FirstBothEndsThenWhatMayFollow) {
  const Bisection bisection(0.0, 8.0, 0.02);
  const Known nothing = [](double) { return std::optional<bool>(); };
  EXPECT_THAT(bisection.next(nothing, 2).values, ElementsAre(0.0, 8.0));
  EXPECT_THAT(bisection.next(nothing, 5).values, ElementsAre(0.0, 8.0, 4.0, 2.0, 6.0));
  const Known ends = [](double value) {
    return value == 0.0 ? std::optional(false) : value == 8.0 ? std::optional(true) : std::nullopt;
  };
  EXPECT_THAT(bisection.next(ends, 3).values, ElementsAre(4.0, 2.0, 6.0));
}

TEST(Bisection, WhatIsToBeDecidedIsNoInnerPointOfABracket) {
  for (const double limit : {0.7, 0.99, 1.0, 1.001, 1.8}) {
    for (const auto& [from, to] : {std::pair{0.5, 2.0}, {2.0, 0.5}}) {
      const Bisection bisection(from, to, 0.2, 1, 1.0);
      const Bisection::State state = Trials(bisection, from, to, limit).run(3);
      EXPECT_EQ(state.status, Status::found);
      const auto [low, high] = std::minmax(state.not_met, state.met);
      EXPECT_LE(low, limit);
      EXPECT_GE(high, limit);
      EXPECT_TRUE(high <= 1.0 || low >= 1.0) << low << " " << high;
    }
  }
  EXPECT_EQ(Bisection(2.0, 3.0, 0.2, 1, 1.0).next([](double) { return std::nullopt; }, 2).needed, 2U)
      << "beyond the ends";
}

TEST(Bisection, EndsThatTellNothingEndIt) {
  const Bisection bisection(0.0, 8.0, 0.02);
  for (const auto& [at_from, at_to, status] : {std::tuple{true, true, Status::met_at_both},
                                               {false, false, Status::met_at_none},
                                               {true, false, Status::ends_swapped}}) {
    const bool first = at_from, last = at_to;
    const Known known = [=](double value) { return std::optional(value == 0.0 ? first : last); };
    EXPECT_EQ(bisection.follow(known).status, status);
    EXPECT_THAT(bisection.next(known, 4).values, IsEmpty());
  }
}

// It holds from 2.9 to 6.7, and from 7.3 on.
TEST(Bisection, AScanFindsAllLimitsThatShow) {
  const auto island = [](double value) { return (value >= 2.9 && value <= 6.7) || value >= 7.3; };
  const Bisection bisection(1.0, 7.0, 0.02, 8);
  for (const std::size_t at_a_time : {1UL, 4UL}) {
    Trials trials(bisection, 1.0, 7.0, 0.0);
    trials.hold_where(island);
    const auto state = trials.run(at_a_time);
    EXPECT_EQ(state.status, Status::found);
    ASSERT_EQ(state.limits.size(), 2U);
    EXPECT_THAT(state.not_met, DoubleNear(2.9, 0.06));
    EXPECT_THAT(state.limits[0].met, DoubleNear(2.9, 0.06));
    EXPECT_GT(state.limits[1].not_met, state.limits[1].met);  // it ends to hold
    EXPECT_THAT(state.limits[1].met, DoubleNear(6.7, 0.14));
  }
  Trials trials(bisection, 1.0, 7.0, 0.0);
  trials.hold_where([](double value) { return value < 1.1; });
  const auto state = trials.run(1);
  EXPECT_EQ(state.status, Status::ends_swapped);
  EXPECT_EQ(state.limits.size(), 1U);
}

TEST(Bisection, AllThatIsNeededComesAtOnce) {
  const Bisection bisection(0.0, 8.0, 0.02, 4);
  const Known nothing = [](double) { return std::optional<bool>(); };
  const Bisection::Next scan = bisection.next(nothing, 1);
  EXPECT_THAT(scan.values, ElementsAre(0.0, 8.0, 2.0, 4.0, 6.0));
  EXPECT_EQ(scan.needed, 5U);
  const Known island = [](double value) {
    return std::fmod(value, 2.0) == 0.0 ? std::optional(value == 4.0) : std::nullopt;
  };
  const Bisection::Next both = bisection.next(island, 1);
  EXPECT_THAT(both.values, ElementsAre(3.0, 5.0));
  EXPECT_EQ(both.needed, 2U);
}

TEST(Bisection, EndsWhereTheLimitIsZero) {
  const Bisection bisection(-1.0, 2.0, 0.02);
  Trials trials(bisection, -1.0, 2.0, 0.0);
  const auto state = trials.run(1);
  EXPECT_EQ(state.status, Status::found);
  EXPECT_THAT(state.met, DoubleNear(0.0, 1e-5));
  EXPECT_LT(trials.count(), 30U);
}

}  // namespace
}  // namespace keyblock::study
