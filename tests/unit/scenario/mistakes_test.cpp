#include "scenario/mistakes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scenario/parse.h"

namespace keyblock::scenario {
namespace {

using testing::HasSubstr;
using testing::Not;

Diagnostic mistake_in(int line, std::string found = "two") {
  return {{"f.toml", line, 1}, "rock.young", std::move(found), "one", ""};
}

TEST(Mistakes, EachIsKeptOnce) {
  Mistakes mistakes;
  EXPECT_TRUE(mistakes.empty());
  mistakes.add({mistake_in(3), mistake_in(2), mistake_in(3), mistake_in(3, "three")});
  Diagnostic with_hint = mistake_in(2);
  with_hint.hint = "with rock.young = 2";
  mistakes.add(with_hint);
  ASSERT_EQ(mistakes.kept().size(), 3U);
  mistakes.sort("f.toml");
  EXPECT_EQ(mistakes.kept().front().where.line, 2);
  EXPECT_THAT(mistakes.error().what(), Not(HasSubstr("more mistake")));
}

TEST(Mistakes, ThoseAfterAThousandAreCounted) {
  Mistakes mistakes, all;
  for (int line = 1; line <= 1201; ++line) mistakes.add(mistake_in(line));
  EXPECT_TRUE(mistakes.full());
  EXPECT_EQ(mistakes.kept().size(), Mistakes::most);
  all.add(mistakes);
  const std::string text = all.error().what();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 50);
  EXPECT_THAT(text, HasSubstr("\nf.toml:50:1: rock.young: found two; expected one\nand 1151 more mistakes"));
}

// Were each compared with all others, these two would take minutes, and the time limit of the tests would end them.
TEST(Mistakes, AScenarioFullOfThemIsReadAsFastAsOthers) {
  std::string text;
  for (int k = 0; k < 8000; ++k) text += fmt::format("k{} = 1\n", k);
  const auto read = [&] { static_cast<void>(parse_scenario_text(text, "many.toml")); };
  EXPECT_THAT(read, testing::Throws<InputError>(
                        testing::Property(&InputError::what, HasSubstr("\nand 7952 more mistakes"))));
}

TEST(Mistakes, UnknownNamesAmongManyNames) {
  std::string text;
  for (int k = 0; k < 3000; ++k) {
    text += fmt::format(
        "[[excavation]]\nname = \"e{0}\"\n[[stage]]\nname = \"s{0}\"\nkind = \"settle\"\nexcavate = "
        "[\"x{0}\"]\n",
        k);
  }
  const auto read = [&] { static_cast<void>(parse_scenario_text(text, "many.toml")); };
  EXPECT_THAT(read,
              testing::Throws<InputError>(testing::Property(&InputError::what, HasSubstr("more mistakes"))));
}

}  // namespace
}  // namespace keyblock::scenario
