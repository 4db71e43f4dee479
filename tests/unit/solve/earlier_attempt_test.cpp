#include "solve/earlier_attempt.h"

#include <gtest/gtest.h>

#include <vector>

namespace keyblock::dynamics {
namespace {

using Shear = SpringArray::Shear;
constexpr SpringArray::Branch open{}, held{true, Shear::held}, slips{true, Shear::forward};

std::vector<contact::Contact> contacts_of(const std::vector<int>& candidates) {
  std::vector<contact::Contact> contacts(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) contacts[c].candidate = candidates[c];
  return contacts;
}

SpringArray springs_of(const std::vector<SpringArray::Branch>& branches, const std::vector<double>& bounds) {
  SpringArray springs;
  springs.resize(branches.size());
  springs.branch = branches;
  for (std::size_t c = 0; c < branches.size(); ++c) springs.kn[c] = 1.0;
  for (std::size_t c = 0; c < bounds.size(); ++c) springs.bound[c] = bounds[c];
  return springs;
}

TEST(EarlierAttempt, SpringsOfTheSameContactsGoOn) {
  SpringArray before = springs_of({held, slips, slips}, {1.0, 2.0, 3.0});
  before.bounds_updated = true;
  EarlierAttempt look;
  look.keep(contacts_of({3, 5, 9}), before);

  // 5 has gone, 4 and 12 have come.
  const SpringArray fresh = springs_of({open, open, open, open}, {7.0, 7.0, 7.0, 7.0});
  auto contacts = contacts_of({3, 4, 9, 12});
  SpringArray springs = fresh;
  look.give(contacts, springs);
  EXPECT_EQ(springs.branch, (std::vector{held, open, slips, open}));
  EXPECT_EQ(std::vector(springs.bound.begin(), springs.bound.begin() + 4), (std::vector{1.0, 7.0, 3.0, 7.0}));
  EXPECT_TRUE(springs.bounds_updated);

  contacts[0].memory.bonded = true;
  springs = fresh;
  look.give(contacts, springs);
  EXPECT_EQ(springs.branch, (std::vector{open, open, slips, open})) << "a bond is begun anew";

  look.forget();
  springs = fresh;
  look.give(contacts, springs);
  EXPECT_EQ(springs.branch, fresh.branch);
  EXPECT_EQ(springs.bound, fresh.bound);
  EXPECT_FALSE(springs.bounds_updated);
}

TEST(EarlierAttempt, OfNoContactsGivesNothing) {
  EarlierAttempt attempt;
  SpringArray springs = springs_of({held, slips}, {1.0, 2.0});
  attempt.give(contacts_of({1, 2}), springs);
  EXPECT_EQ(springs.branch, (std::vector{held, slips}));
  attempt.keep(contacts_of({}), springs_of({}, {}));
  attempt.give(contacts_of({1, 2}), springs);
  EXPECT_EQ(springs.branch, (std::vector{held, slips}));
  EXPECT_FALSE(springs.bounds_updated);
}

// Only the last attempt is known.
TEST(EarlierAttempt, KeepsTheLastOne) {
  EarlierAttempt attempt;
  attempt.keep(contacts_of({1, 2}), springs_of({held, held}, {1.0, 2.0}));
  attempt.keep(contacts_of({2}), springs_of({slips}, {5.0}));
  SpringArray springs = springs_of({open, open}, {0.0, 0.0});
  attempt.give(contacts_of({1, 2}), springs);
  EXPECT_EQ(springs.branch, (std::vector{open, slips}));
  EXPECT_EQ(springs.bound[0], 0.0);
  EXPECT_EQ(springs.bound[1], 5.0);
}

}  // namespace
}  // namespace keyblock::dynamics
