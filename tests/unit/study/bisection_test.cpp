#include "study/bisection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

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
    for (auto values = bisection_.next(known, at_a_time); !values.empty();
         values = bisection_.next(known, at_a_time))
      for (const double value : values) known_[value] = met_(value);
    return bisection_.follow(known);
  }
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
  EXPECT_THAT(bisection.next(nothing, 2), ElementsAre(0.0, 8.0));
  EXPECT_THAT(bisection.next(nothing, 5), ElementsAre(0.0, 8.0, 4.0, 2.0, 6.0));
  const Known ends = [](double value) {
    return value == 0.0 ? std::optional(false) : value == 8.0 ? std::optional(true) : std::nullopt;
  };
  EXPECT_THAT(bisection.next(ends, 3), ElementsAre(4.0, 2.0, 6.0));
}

TEST(Bisection, EndsThatTellNothingEndIt) {
  const Bisection bisection(0.0, 8.0, 0.02);
  for (const auto& [at_from, at_to, status] : {std::tuple{true, true, Status::met_at_both},
                                               {false, false, Status::met_at_none},
                                               {true, false, Status::ends_swapped}}) {
    const bool first = at_from, last = at_to;
    const Known known = [=](double value) { return std::optional(value == 0.0 ? first : last); };
    EXPECT_EQ(bisection.follow(known).status, status);
    EXPECT_THAT(bisection.next(known, 4), IsEmpty());
  }
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
