#include "study/variant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/parse.h"

namespace keyblock::study {
namespace {

using testing::ElementsAre;

scenario::Scenario gallery(const std::vector<std::string>& overrides = {}) {
  return scenario::parse_scenario(std::filesystem::path(KEYBLOCK_TEST_DATA) / "study/gallery.toml",
                                  overrides);
}

std::vector<std::string> stages(const scenario::Scenario& scenario) {
  std::vector<std::string> names;
  for (const auto& stage : scenario.stages) names.push_back(stage.name);
  return names;
}

TEST(Variant, FrictionOfAllJoints) {
  scenario::Scenario s = gallery();
  apply_variant(s, "friction-", {{3.0, 0.5}, ""});
  EXPECT_DOUBLE_EQ(*s.joints.friction, 27.0);
  EXPECT_FALSE(s.joint_sets[0].joints.friction);
  EXPECT_DOUBLE_EQ(*s.joint_sets[1].joints.friction, 22.0);
  EXPECT_DOUBLE_EQ(s.domain->frame_friction, 0.0);
  apply_variant(s, "friction-", {{26.0, 0.5}, ""});
  EXPECT_DOUBLE_EQ(*s.joint_sets[1].joints.friction, 0.0);
  apply_variant(s, "friction+", {{89.0, 0.5}, ""});
  EXPECT_DOUBLE_EQ(*s.joints.friction, 89.9);
}

TEST(Variant, ReleasedAtOnce) {
  scenario::Scenario s = gallery();
  apply_variant(s, "released", {});
  EXPECT_THAT(stages(s), ElementsAre("in situ", "shaken", "after"));
  EXPECT_THAT(s.stages[1].excavate, ElementsAre(0));
  EXPECT_TRUE(s.stages[0].excavate.empty());
}

// What the stages install that are left out is installed where they would have led.
TEST(Variant, ReleasedAtOnceKeepsSupports) {
  scenario::Scenario s = gallery();
  s.stages[1].install = {"bolt"};
  s.stages[2].install = {"late"};
  apply_variant(s, "released", {});
  EXPECT_THAT(s.stages[1].install, ElementsAre("bolt", "late"));
}

TEST(Variant, UnshakenIsWhatFollowsWhereMeasuresBegin) {
  scenario::Scenario s = gallery();
  apply_variant(s, unshaken_variant, {{}, "excavated"});
  EXPECT_THAT(stages(s), ElementsAre("in situ", "excavated", "shaken", "after"));
  EXPECT_EQ(s.stages[2].scale, 0.0);
  scenario::Scenario later = gallery();
  apply_variant(later, unshaken_variant, {{}, "shaken"});
  EXPECT_EQ(later.stages[2].scale, 1.0);
}

TEST(Variant, OnlyThoseThatMeanSomething) {
  EXPECT_THAT(variants_of(gallery(), {"after"}), ElementsAre("", "friction-", "friction+", "released"));
  EXPECT_THAT(variants_of(gallery(), {"after", "excavated"}), ElementsAre("", "friction-", "friction+"));
  // Excavated in a dynamic stage: released already.
  const scenario::Scenario dynamic =
      gallery({"stage.excavated.excavate=[]", "stage.shaken.excavate=['gallery']"});
  EXPECT_THAT(variants_of(dynamic, {"after"}), ElementsAre("", "friction-", "friction+"));
  scenario::Scenario at_rest = gallery();
  at_rest.stages.resize(2);  // nothing dynamic follows
  EXPECT_THAT(variants_of(at_rest, {"in situ"}), ElementsAre("", "friction-", "friction+"));
}

}  // namespace
}  // namespace keyblock::study
