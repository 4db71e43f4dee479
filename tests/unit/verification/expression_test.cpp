#include "verification/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyblock::verification {
namespace {

using ::testing::HasSubstr;

/// Says what it was asked for.
class Asked final : public Quantities {
 public:
  [[nodiscard]] double get(std::string_view function, const std::vector<Argument>& arguments) const override {
    asked = std::string(function);
    for (const Argument& argument : arguments) {
      if (const auto* text = std::get_if<std::string>(&argument)) asked += " '" + *text + "'";
      if (const auto* number = std::get_if<double>(&argument)) asked += " " + std::to_string(*number);
    }
    return 7.0;
  }
  mutable std::string asked;
};

double value(const std::string& text) {
  return Expression(text).evaluate(Asked());
}

TEST(Expression, Arithmetic) {
  EXPECT_EQ(value("1 + 2*3 - 4/8"), 6.5);
  EXPECT_EQ(value("10 - 3 - 2"), 5.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("2^3^2"), 512.0);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("(1 + 2)*-(3)"), -9.0);
  EXPECT_EQ(value("1.5e3"), 1500.0);
}

TEST(Expression, FunctionsOfNumbers) {
  EXPECT_EQ(value("sqrt(16) + abs(-1) + max(1, 2) + min(1, 2)"), 8.0);
  EXPECT_EQ(value("hypot(3, 4)"), 5.0);
  EXPECT_NEAR(value("sin(rad(30))"), 0.5, 1e-15);
  EXPECT_NEAR(value("deg(atan2(1, 1))"), 45.0, 1e-13);
  EXPECT_NEAR(value("0.5*9.81*(sin(rad(30)) - cos(rad(30))*tan(rad(20)))"), 0.906407, 1e-6);
  EXPECT_EQ(value("pi"), std::acos(-1.0));
  EXPECT_EQ(value("log(exp(2))"), 2.0);
}

TEST(Expression, AsksForTheRest) {
  const Asked quantities;
  EXPECT_EQ(Expression("2*at('s.ux', 1 + 1)").evaluate(quantities), 14.0);
  EXPECT_EQ(quantities.asked, "at 's.ux' 2.000000");
  EXPECT_EQ(Expression("max('s.uy')").evaluate(quantities), 7.0);
  EXPECT_EQ(quantities.asked, "max 's.uy'");
  EXPECT_EQ(Expression("row('a run', 'a, quantity')").evaluate(quantities), 7.0);
  EXPECT_EQ(quantities.asked, "row 'a run' 'a, quantity'");
}

struct Wrong {
  const char* text;
  std::size_t column;
  const char* message;

  friend std::ostream& operator<<(std::ostream& out, const Wrong& wrong) { return out << wrong.text; }
};

class Mistake : public ::testing::TestWithParam<Wrong> {};

TEST_P(Mistake, IsNamedWithItsPlace) {
  try {
    Expression expression(GetParam().text);
    FAIL() << GetParam().text;
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.column, GetParam().column) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(Expressions, Mistake,
                         ::testing::Values(Wrong{"", 1, "the end at character 1"}, Wrong{"1 +", 4, "the end"},
                                           Wrong{"1 2", 3, "an operator or the end"},
                                           Wrong{"(1", 3, "expected ')'"},
                                           Wrong{"sqt(2)", 1, "did you mean 'sqrt'?"},
                                           Wrong{"end(1)", 1, "expected end('string')"},
                                           Wrong{"max('a', 2)", 1, "max(number, number) or max('string')"},
                                           Wrong{"end('a)", 6, "a closing quote"},
                                           Wrong{"pi(2)", 3, "an operator"}, Wrong{"1e999", 1, "a number"}));

TEST(Expression, DeepNestingIsRefused) {
  EXPECT_THROW(Expression(std::string(100000, '(')), ExpressionError);
}

}  // namespace
}  // namespace keyblock::verification
