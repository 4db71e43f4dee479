#include "scenario/value.h"

#include <gtest/gtest.h>

namespace keyblock::scenario {
namespace {

constexpr const char* toml = R"(title = "a \"b\""
[rock]
young = 1e9
  [rock.inner]
  flags = [true, 3, -2.5]
[[stage]]
name = "first"
[[stage]]
name = "second"
table = { x = 1, "two words" = [] }
when = 07:32:00
)";

TEST(Toml, PositionsAreThoseOfKeysAndValues) {
  const Value document = parse_toml(toml, "f.toml");
  const Value* rock = document.find("rock");
  ASSERT_NE(rock, nullptr);
  EXPECT_EQ(rock->where.file, "f.toml");
  EXPECT_EQ(rock->where.line, 2);
  const Value* young = rock->find("young");
  ASSERT_NE(young, nullptr);
  EXPECT_EQ(young->key_where.line, 3);
  EXPECT_EQ(young->key_where.column, 1);
  EXPECT_EQ(young->where.column, 9);
  const Value& number = rock->find("inner")->find("flags")->items[2];
  EXPECT_EQ(number.where.line, 5);
  EXPECT_EQ(number.where.column, 21);
}

TEST(Toml, MembersKeepTheOrderOfTheFile) {
  const Value document = parse_toml("b = 1\na = 2\nc = 3", "");
  ASSERT_EQ(document.items.size(), 3U);
  EXPECT_EQ(document.items[0].key, "b");
  EXPECT_EQ(document.items[1].key, "a");
  EXPECT_EQ(document.items[2].key, "c");
}

TEST(Toml, NamesOfElements) {
  const Value document = parse_toml(toml, "");
  const Value& stages = *document.find("stage");
  ASSERT_EQ(stages.items.size(), 2U);
  ASSERT_NE(stages.items[1].name(), nullptr);
  EXPECT_EQ(*stages.items[1].name(), "second");
  EXPECT_EQ(document.find("rock")->name(), nullptr);
}

TEST(Toml, SyntaxErrorsHaveAPosition) {
  try {
    parse_toml("a = 1\nb = = 2\n", "f.toml");
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1U);
    EXPECT_EQ(error.diagnostics()[0].where.file, "f.toml");
    EXPECT_EQ(error.diagnostics()[0].where.line, 2);
  }
}

TEST(Toml, MalformedTextIsAlwaysAnInputError) {
  for (const char* malformed :
       {"[ = ]", "a = [}", "a = {]", "[[a]", "a.=1", "= 1", "a = \xC3\x97", "\"a", "a = 'b\n", "[\xC2\xA0x]",
        "a = \"\xFF\"", "a = 1e", "a = 99999999999999999999"}) {
    EXPECT_THROW(parse_toml(malformed, ""), InputError) << malformed;
  }
}

TEST(Toml, CharactersBeyondAsciiBelongIntoStringsAndComments) {
  const char* right =
      "\xEF\xBB\xBF# größe\n"
      R"(a = "\"größe\"" # ×
b = 'ß\'
c = """ß"ß"""""
d = '''
ß''')";
  EXPECT_NO_THROW(parse_toml(right, ""));
  try {
    parse_toml("a = 'ü'\nbß = 1", "f.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].where.line, 2);
    EXPECT_EQ(error.diagnostics()[0].where.column, 2);
    EXPECT_EQ(error.diagnostics()[0].found, "the character 'ß' (U+00DF)");
  }
  // No string begins within a number.
  EXPECT_THROW(parse_toml("a = 2'600·\n", "f.toml"), InputError);
  EXPECT_NO_THROW(parse_toml("a.\"·\" = ['·', '·']\n", ""));
}

TEST(Toml, OtherEncodingsAreNamed) {
  const auto refused = [](std::string_view other) -> std::string {
    try {
      parse_toml(other, "f");
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(refused(std::string_view("\xFF\xFE[\0r\0", 6)),
            "f:1:1: found the byte 0xFF, which is no UTF-8; expected text in UTF-8; the file seems to be in "
            "UTF-16; save "
            "it as UTF-8");
  EXPECT_EQ(refused("a = 1\nb = 2 # gesch\xE4tzt\n"),
            "f:2:14: found the byte 0xE4, which is no UTF-8; expected text in UTF-8");
}

TEST(SameValue, IsThatOfNumbersHoweverTheyAreWritten) {
  const auto same = [](const std::string& a, const std::string& b) {
    return same_value(parse_toml("v = " + a, ""), parse_toml("v = " + b, ""));
  };
  EXPECT_TRUE(same("1", "1.0"));
  EXPECT_TRUE(same("1e3", "1000"));
  EXPECT_FALSE(same("1", "true"));
  EXPECT_FALSE(same("1", "\"1\""));
  EXPECT_FALSE(same("9007199254740992", "9007199254740993"));
  EXPECT_TRUE(same("[1, [2.0, 3]]", "[1.0, [2, 3.0]]"));
  EXPECT_FALSE(same("[1, 2]", "[1, 2, 3]"));
  EXPECT_TRUE(same("{ mean = 1, std = 2 }", "{ std = 2.0, mean = 1.0 }"));
  EXPECT_FALSE(same("{ mean = 1, std = 2 }", "{ mean = 1, gap = 2 }"));
}

// The parser recurses, and so does what reads its tables.
TEST(Toml, OfAnyDepth) {
  const auto many = [](const std::string& piece) {
    std::string all;
    for (int k = 0; k < 100000; ++k) all += piece;
    return all;
  };
  for (const std::string& deep :
       {many("a.") + "b = 1", "[" + many("a.") + "b]\nc = 1", many("'a'.") + "b = 1", "a = " + many("["),
        "a = " + many("{a="), "x = 1\n" + many("a . ") + "b = 1"}) {
    try {
      parse_toml(deep, "f.toml");
      ADD_FAILURE() << deep.substr(0, 20);
    } catch (const InputError& error) {
      const Diagnostic& d = error.diagnostics().front();
      EXPECT_EQ(d.found, "more than 32 tables or lists in each other") << d.to_string();
      EXPECT_EQ(d.where.line, deep[0] == 'x' ? 2 : 1);
    }
  }
  const Value flat = parse_toml("a = [" + many("0.5, [1.5, 2.5], ") + "]\nb.c.d.e = 1.0", "");
  EXPECT_EQ(flat.items.front().items.size(), 200000U);
}

TEST(Describe, TypeAndValue) {
  const Value document = parse_toml(toml, "");
  EXPECT_EQ(describe(*document.find("title")), R"(the string "a \"b\"")");
  EXPECT_EQ(describe(*document.find("rock")), "a table");
  const Value& flags = *document.find("rock")->find("inner")->find("flags");
  EXPECT_EQ(describe(flags), "an array of 3");
  EXPECT_EQ(describe(flags.items[0]), "the boolean true");
  EXPECT_EQ(describe(flags.items[1]), "the integer 3");
  EXPECT_EQ(describe(flags.items[2]), "the number -2.5");
  EXPECT_EQ(describe(*document.find("stage")->items[1].find("when")), "the date or time 07:32:00");
}

TEST(ToToml, IsReadBack) {
  const Value document = parse_toml(toml, "");
  const std::string once = to_toml(document);
  const Value again = parse_toml("v = " + once, "");
  EXPECT_EQ(to_toml(again.items.front()), once);
  EXPECT_EQ(to_toml(*document.find("stage")->items[1].find("table")), R"({ x = 1, 'two words' = [] })");
}

TEST(ToToml, NumbersKeepTheirTypeAndDigits) {
  const Value document = parse_toml("a = 1.0\nb = 1\nc = 0.1\nd = 1e300\ne = inf", "");
  EXPECT_EQ(to_toml(document.items[0]), "1.0");
  EXPECT_EQ(to_toml(document.items[1]), "1");
  EXPECT_EQ(to_toml(document.items[2]), "0.1");
  EXPECT_EQ(to_toml(document.items[3]), "1e+300");
  EXPECT_EQ(to_toml(document.items[4]), "inf");
}

}  // namespace
}  // namespace keyblock::scenario
