#include "scenario/override.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

TEST(Override, ValuesAreToml) {
  EXPECT_TRUE(parse_override("rock.order=2").value.is(Value::Type::integer));
  EXPECT_TRUE(parse_override("rock.young = 1e9").value.is(Value::Type::number));
  EXPECT_TRUE(parse_override("block.a.fixed=true").value.is(Value::Type::boolean));
  EXPECT_TRUE(parse_override("gravity=[0, -1]").value.is(Value::Type::array));
  EXPECT_TRUE(parse_override("joint_set.J1.spacing={mean=1, distribution=\"exponential\"}")
                  .value.is(Value::Type::table));
}

TEST(Override, WordsNeedNoQuotes) {
  for (const char* text : {"domain.boundary=free", "domain.boundary=\"free\"", "domain.boundary='free'"}) {
    const Value value = parse_override(text).value;
    EXPECT_TRUE(value.is(Value::Type::string)) << text;
    EXPECT_EQ(value.text, "free") << text;
  }
  EXPECT_EQ(parse_override("title=two words").value.text, "two words");
  EXPECT_EQ(parse_override("title=").value.text, "");
}

TEST(Override, AnEqualsSignMayStandInAName) {
  const Override override_ = parse_override("stage.'a=b'.scale=2");
  ASSERT_EQ(override_.path.size(), 3U);
  EXPECT_EQ(override_.path[1].key, "a=b");
  EXPECT_EQ(override_.value.integer, 2);
}

TEST(Override, PositionNamesTheOverride) {
  const Value value = parse_override("block.a.outer=[[0, 0], [1, 1]]").value;
  EXPECT_EQ(value.where.file, "--set block.a.outer=[[0, 0], [1, 1]]");
  EXPECT_EQ(value.items[1].items[0].where.file, value.where.file);
  EXPECT_EQ(value.items[1].where.line, 0);
}

TEST(Override, ReplacesValuesOfTheFile) {
  const Scenario s = parse(two_blocks, {"rock.young=2e9", "block.top.order=2", "stage.quiet.duration=3"});
  EXPECT_EQ(s.rock.young, 2e9);
  EXPECT_EQ(s.blocks[1].rock.order, 2);
  EXPECT_EQ(s.stages[0].duration, 3.0);
}

TEST(Override, ElementsByNameOrPlace) {
  EXPECT_EQ(parse(two_blocks, {"block.1.spin=3"}).blocks[1].spin, 3.0);
  EXPECT_EQ(parse(two_blocks, {"block[1].spin=3"}).blocks[1].spin, 3.0);
  EXPECT_EQ(parse(two_blocks, {"block.top.outer[2]=[3, 3]"}).blocks[1].polygon.outer[2], (Vec2{3.0, 3.0}));
  EXPECT_EQ(
      parse(two_blocks, {"block[0].name=1", "block[0].name='1'", "block.1.order=3"}).blocks[0].rock.order, 3)
      << "a name goes before a place";
}

TEST(Override, MakesTablesThatAreMissing) {
  const Scenario s = parse(two_blocks, {"in_situ.depth=30", "in_situ.k0=0.5"});
  ASSERT_TRUE(s.in_situ);
  EXPECT_EQ(s.in_situ->depth, 30.0);
  EXPECT_EQ(s.in_situ->k0, 0.5);
  EXPECT_EQ(mistakes(two_blocks, {"in_situ.depth=30"}),
            "--set in_situ.depth=30: in_situ.k0: found nothing; expected a number of at least 0");
}

TEST(Override, TheLastOneWins) {
  EXPECT_EQ(parse(two_blocks, {"rock.order=2", "rock.order=3"}).rock.order, 3);
}

TEST(Override, MayMendAMistake) {
  const std::string wrong = two_blocks + "\n[damage]\nslip = -1\n";
  EXPECT_NE(mistakes(wrong), "");
  EXPECT_EQ(mistakes(wrong, {"damage.slip=0.002"}), "");
}

TEST(Override, IsKeptWithTheText) {
  EXPECT_EQ(parse(two_blocks, {"rock.order=2", "title=new"}).text,
            two_blocks + "# --set rock.order=2\n# --set title=new\n");
  EXPECT_EQ(parse(two_blocks).text, two_blocks);
  // A comment is one line: the text must stay TOML.
  const std::string lines = parse(two_blocks, {"title=one\ntwo = 2"}).text;
  EXPECT_EQ(lines, two_blocks + "# --set title=one\\ntwo = 2\n");
  EXPECT_NO_THROW(parse(lines));
}

TEST(Override, MustBeUtf8) {
  EXPECT_THAT(mistakes(two_blocks, {"title=Gr\xFCn"}), testing::HasSubstr("\\xfc', which is no UTF-8"));
  EXPECT_EQ(mistakes(two_blocks, {"title=Grün"}), "");
}

TEST(Override, WhatBeginsAsATableIsNoWord) {
  EXPECT_THAT(mistakes(jointed_domain, {"joint_set.bedding.spacing={mean=1,std=.1,distribution=\"normal\"}"}),
              testing::HasSubstr(": found text that is not TOML"));
  EXPECT_THAT(mistakes(two_blocks, {"gravity=[0, -9.81"}), testing::HasSubstr("text that is not TOML"));
  EXPECT_THAT(mistakes(two_blocks, {"title=\"half"}), testing::HasSubstr("text that is not TOML"));
  EXPECT_THAT(mistakes(two_blocks, {"title=[draft]"}), testing::HasSubstr("stands in quotes"));
  EXPECT_EQ(mistakes(two_blocks, {"title='[draft]'"}), "");
}

TEST(Override, OfAnyDepth) {
  std::string deep = "a";
  for (int k = 0; k < 100000; ++k) deep += ".a";
  EXPECT_THAT(mistakes(two_blocks, {deep + "=1"}), testing::HasSubstr("of at most 32 keys"));
  EXPECT_THAT(mistakes(two_blocks, {"title=" + std::string(100000, '[')}),
              testing::HasSubstr("more than 32 tables"));
}

TEST(Override, ResolvedPathsAreEqualWhereTheValuesAreTheSame) {
  const Value document = parse_toml("a.b = 1\nlist = [{ name = \"x\" }, { name = \"y\", c.d = 1 }]", "");
  const auto resolved = [&](const char* text) { return resolved_path(*parse_key_path(text), document); };
  EXPECT_EQ(resolved("list.x.c"), resolved("list[0].c"));
  EXPECT_EQ(resolved("list.'y'.c.d"), resolved("list[1].c.d"));
  EXPECT_EQ(resolved("a.b"), resolved("'a'.\"b\""));
  EXPECT_NE(resolved("list.x.c"), resolved("list.1.c"));
  EXPECT_EQ(resolved("new.0.c"), (std::vector<std::string>{"new", "0", "c"}));
}

TEST(Override, LeavesTheDocumentWhenItFails) {
  Value document = parse_toml("a = { b = 1 }\nlist = [{ name = \"x\" }]", "");
  const std::string before = to_toml(document);
  for (const char* text : {"a.b.c=1", "list.y.z=1", "list.1.z=1"}) {
    EXPECT_TRUE(apply_override(parse_override(text), document)) << text;
  }
  EXPECT_EQ(to_toml(document), before);
}

}  // namespace
}  // namespace keyblock::scenario
