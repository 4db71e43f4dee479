#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::string> warnings_of(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> warnings;
  build_setup(parse(text, overrides), 0, &warnings);
  return warnings;
}

TEST(Warnings, TheTunnelHasNone) {
  EXPECT_THAT(plausibility_warnings(parse_scenario(examples / "01-tunnel.toml")), IsEmpty());
  EXPECT_THAT(plausibility_warnings(parse_scenario(examples / "02-tunnel-in-situ.toml")), IsEmpty());
}

TEST(Warnings, OfStress) {
  EXPECT_THAT(warnings_of(runnable_domain, {"in_situ.depth=30", "in_situ.k0=0.3"}),
              UnorderedElementsAre(HasSubstr("3 K0 < 1")));
  EXPECT_THAT(warnings_of(two_blocks, {"in_situ.syy=1e6"}), UnorderedElementsAre(HasSubstr("tension")));
}

TEST(Warnings, OfExcavations) {
  EXPECT_THAT(warnings_of(runnable_domain, {"stage.settled.excavate=[]"}),
              UnorderedElementsAre(HasSubstr("excavation.tunnel: no stage excavates it")));
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.center=[4, 2]"}),
              UnorderedElementsAre(HasSubstr("reaches beyond the domain")));
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.center=[14, 2]"}),
              UnorderedElementsAre(HasSubstr("reaches beyond the domain"), HasSubstr("holds no block")));
}

TEST(Warnings, OfStages) {
  const std::string shaken = runnable_domain + R"(
[[motion]]
name = "sine"
x = { amplitude = 1.0, frequency = 1.0, cycles = 1 }
[[stage]]
name = "shaken"
kind = "shake"
motion = "sine"
)";
  EXPECT_THAT(warnings_of(shaken), UnorderedElementsAre(HasSubstr("comes down during the shaking")));
  EXPECT_THAT(warnings_of(shaken, {"stage.settled.excavate=[]", "stage.shaken.excavate=['tunnel']"}),
              UnorderedElementsAre(HasSubstr("shakes before the rock has settled")));
  EXPECT_THAT(plausibility_warnings(parse(jointed_domain)), UnorderedElementsAre(HasSubstr("no [[stage]]")));
}

TEST(Warnings, OfBlocksThatOverlap) {
  EXPECT_THAT(warnings_of(two_blocks), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"block.top.outer=[[1, 0.9], [3, 0.9], [3, 2], [1, 2]]"}),
              UnorderedElementsAre(HasSubstr("block.base and block.top overlap by 0.1 m at")));
}

TEST(Warnings, OfDistributionsThatAreCutOff) {
  EXPECT_THAT(
      warnings_of(runnable_domain, {"joint_set.bedding.gap={mean=0.5, std=0.5, distribution=\"normal\"}"}),
      UnorderedElementsAre(HasSubstr("joint_set.bedding.gap: cut off at zero")));
}

}  // namespace
}  // namespace keyblock::scenario
