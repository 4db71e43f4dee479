#include "scenario/key_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyblock::scenario {
namespace {

using testing::ElementsAre;

std::vector<std::string> keys(std::string_view text) {
  const auto path = parse_key_path(text);
  std::vector<std::string> result;
  for (const PathSegment& segment : path.value_or(std::vector<PathSegment>{})) result.push_back(segment.key);
  return result;
}

TEST(KeyPath, SegmentsAreBareOrQuoted) {
  EXPECT_THAT(keys("rock"), ElementsAre("rock"));
  EXPECT_THAT(keys("rock.order"), ElementsAre("rock", "order"));
  EXPECT_THAT(keys("stage.'first earthquake'.scale"), ElementsAre("stage", "first earthquake", "scale"));
  EXPECT_THAT(keys("stage.\"it's a.b\".scale"), ElementsAre("stage", "it's a.b", "scale"));
}

TEST(KeyPath, PlacesInLists) {
  const auto point = parse_key_path("stage.2.scale");
  const auto bracket = parse_key_path("stage[2].scale");
  ASSERT_TRUE(point);
  ASSERT_TRUE(bracket);
  ASSERT_EQ(bracket->size(), 3U);
  EXPECT_EQ((*point)[1].index, 2U);
  EXPECT_EQ((*bracket)[1].index, 2U);
  EXPECT_FALSE((*bracket)[2].index);
  EXPECT_FALSE((*parse_key_path("stage.'2'.scale"))[1].index) << "a quoted segment is a name";
}

TEST(KeyPath, WhatIsNoPath) {
  for (const char* text : {"", ".", "rock.", ".rock", "rock..order", "rock order", "stage.'open", "stage[1",
                           "stage[x]", "a'b'", "stage[]"}) {
    EXPECT_FALSE(parse_key_path(text)) << text;
  }
}

TEST(KeyPath, JoinedPathsAreReadBack) {
  const std::string path = join_path(join_index(join_path("", "stage"), 3), "first earthquake");
  EXPECT_EQ(path, "stage[3].'first earthquake'");
  EXPECT_THAT(keys(path), ElementsAre("stage", "3", "first earthquake"));
  EXPECT_EQ(join_path("a", "it's"), "a.\"it's\"");
  EXPECT_THAT(keys("a.\"it's\""), ElementsAre("a", "it's"));
}

TEST(Suggestion, SlipsOfThePen) {
  const std::vector<std::string> words{"friction", "cohesion", "tension", "dip", "dip_direction"};
  EXPECT_EQ(closest_word("friktion", words), "friction");
  EXPECT_EQ(closest_word("frictoin", words), "friction");
  EXPECT_EQ(closest_word("Tension", words), "tension");
  EXPECT_EQ(closest_word("dipp", words), "dip");
  EXPECT_EQ(closest_word("dipdirection", words), "dip_direction");
  EXPECT_EQ(suggestion("friktion", words), "did you mean 'friction'?");
}

TEST(Suggestion, LettersThatWereMeantAreThere) {
  EXPECT_EQ(closest_word("sqt", {"set", "sqrt"}), "sqrt");
  EXPECT_EQ(closest_word("sxz", {"sxx", "sxy"}), "") << "two are as near";
  EXPECT_EQ(closest_word("fallen_area", {"fallen_area_m2", "fallen_blocks"}), "fallen_area_m2");
  EXPECT_EQ(closest_word("closure", {"closure_vertical_m", "closure_horizontal_m"}), "") << "two begin so";
  EXPECT_EQ(closest_word("normalstifness", {"normal_stiffness", "shear_stiffness"}), "normal_stiffness");
}

// Each of them was a hint once.
TEST(Suggestion, NoGuessThatIsFar) {
  EXPECT_EQ(closest_word("units", {"until"}), "");
  EXPECT_EQ(closest_word("kn", {"k0"}), "");
  EXPECT_EQ(closest_word("water", {"outer"}), "");
  EXPECT_EQ(closest_word("excavation", {"excavate"}), "");
}

TEST(Suggestion, NoneForOtherWords) {
  const std::vector<std::string> words{"friction", "cohesion", "x", "y"};
  EXPECT_EQ(closest_word("stiffness", words), "");
  EXPECT_EQ(closest_word("z", words), "") << "one letter replaced by another is no suggestion";
  EXPECT_EQ(suggestion("stiffness", words), "");
  EXPECT_EQ(suggestion("stiffness", {}), "");
}

TEST(ListWords, ReadsAsASentence) {
  EXPECT_EQ(list_words({}), "");
  EXPECT_EQ(list_words({"a"}), "\"a\"");
  EXPECT_EQ(list_words({"a", "b", "c"}), "\"a\", \"b\" or \"c\"");
}

}  // namespace
}  // namespace keyblock::scenario
