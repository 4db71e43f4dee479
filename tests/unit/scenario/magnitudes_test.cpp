#include "scenario/magnitudes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

TEST(Warnings, OfUnusualValues) {
  const auto warned = [](const char* override_) { return warnings_of(two_blocks, {override_}); };
  EXPECT_THAT(warnings_of("units = \"SI\"\n" + two_blocks), IsEmpty());
  EXPECT_THAT(
      warned("rock.density=2.6"),
      UnorderedElementsAre("rock.density = 2.6 kg/m3 (--set): usual is 1000 to 4000 kg/m3; was it in t/m3 or "
                           "g/cm3? That is 2600 kg/m3"));
  EXPECT_THAT(warned("rock.density=26"),
              UnorderedElementsAre(HasSubstr("kN/m3, a weight? That is 2650 kg/m3")));
  EXPECT_THAT(warned("rock.young=8"), UnorderedElementsAre(HasSubstr("was it in GPa? That is 8e+09 Pa")));
  EXPECT_THAT(warned("rock.young=8000"), UnorderedElementsAre(HasSubstr("was it in MPa? That is 8e+09 Pa")));
  EXPECT_THAT(warned("joints.friction=0.55"),
              UnorderedElementsAre(
                  HasSubstr("joints.friction = 0.55 degrees (--set): usual is 5 to 75 degrees; was it "
                            "a coefficient? 0.55 is the tangent of 28.81 degrees")));
  EXPECT_THAT(warned("joints.cohesion=0.5"),
              UnorderedElementsAre(HasSubstr("usual is at least 100 Pa; was it in MPa? That is 5e+05 Pa")));
  EXPECT_THAT(warned("joints.normal_stiffness=10"),
              UnorderedElementsAre(HasSubstr("in GPa/m? That is 1e+10 Pa/m")));
  EXPECT_THAT(warned("gravity=[0, -1]"), IsEmpty());
  EXPECT_THAT(warned("gravity=[0, -981]"),
              UnorderedElementsAre(HasSubstr("was it in cm/s2? That is 9.81 m/s2")));
  EXPECT_THAT(warned("in_situ.syy=-5"), UnorderedElementsAre(HasSubstr("was it in MPa? That is -5e+06 Pa")));
  EXPECT_THAT(warnings_of(two_blocks, {"in_situ.depth=50", "in_situ.k0=70"}),
              UnorderedElementsAre(
                  HasSubstr("in_situ.k0 = 70 (--set): usual is 0.05 to 5; was it in percent? That is 0.7")));
  // What is set to nothing is meant, and what is fixed neither weighs nor deforms.
  for (const char* nothing : {"joints.friction=0", "gravity=[0, 0]", "block.base.density=1",
                              "block.base.young=1", "joints.cohesion=1e15"})
    EXPECT_THAT(warned(nothing), IsEmpty()) << nothing;
  EXPECT_THAT(warned("block.top.density=1"), UnorderedElementsAre(HasSubstr("block.top.density = 1 kg/m3")));
  // Where it stands in the file.
  EXPECT_THAT(warnings_of("\n[[region]]\nouter = [[9, 9], [10, 9], [10, 10]]\nyoung = 8.0\n" + two_blocks),
              UnorderedElementsAre(HasSubstr("region[0].young = 8 Pa (line 4)")));
}

TEST(Warnings, OfUnusualValuesOfWhatHoldsAndSurroundsTheRock) {
  const auto warned = [](const std::vector<std::string>& overrides) {
    return warnings_of(two_blocks, overrides);
  };
  const std::string spring =
      "spring=[{ name = \"K\", from = [0.5, 0.5], to = [1.5, 1.5], stiffness = 2e8, yield = 1e5 }]";
  EXPECT_THAT(warned({spring}), Not(Contains(HasSubstr("usual is"))));
  EXPECT_THAT(warned({spring, "spring.K.stiffness=200"}),
              Contains(HasSubstr("kN/m per m? That is 2e+05 N/m per m")));
  EXPECT_THAT(warned({spring, "spring.K.yield=100"}), Contains(HasSubstr("in kN/m? That is 1e+05 N/m")));
}

TEST(Warnings, OfUnusualValuesAreNotOfOtherUnits) {
  const std::vector<std::string> tonnes{"rock.density=2.6", "rock.young=8e6", "joints.friction=0.55"};
  EXPECT_EQ(warnings_of(two_blocks, tonnes).size(), 3U);
  EXPECT_THAT(warnings_of("units = \"other\"\n" + two_blocks, tonnes), IsEmpty());
  EXPECT_THAT(mistakes("units = \"imperial\"\n" + two_blocks), HasSubstr("expected \"SI\" or \"other\""));
}

}  // namespace
}  // namespace keyblock::scenario
