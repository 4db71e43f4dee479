// What is odd about the ground surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* cut = R"(
[domain]
x = [0.0, 70.0]
y = [0.0, 40.0]
boundary = "frame"
[rock]
density = 2600.0
young = 10e9
poisson = 0.25
state = "plane-strain"
[joints]
friction = 40.0
[[trace_map]]
name = "bedding"
points = [[20.0, 11.3], [50.0, 28.6]]
[[excavation]]
name = "cut"
shape = "polygon"
outer = [[0.0, 10.0], [20.0, 10.0], [37.0, 40.0], [0.0, 40.0]]
[time]
step = 0.005
[[stage]]
name = "excavated"
kind = "settle"
excavate = ["cut"]
)";

const auto closed_ground = HasSubstr("closed ground: excavation.cut comes up to the top of the domain");

TEST(GroundWarnings, OfAFrameThatLiesOnTheGroundBesideACut) {
  EXPECT_THAT(warnings_of(cut), Contains(closed_ground));
  EXPECT_THAT(warnings_of(cut, {"accept_warnings=[\"closed-ground\"]"}), Not(Contains(closed_ground)));
}

TEST(GroundWarnings, OfACutThatIsDrawnALittleShortOfTheTop) {
  EXPECT_THAT(
      warnings_of(cut, {"excavation.cut.outer=[[0.0, 10.0], [20.0, 10.0], [37.0, 39.99], [0.0, 39.99]]"}),
      Contains(closed_ground));
  EXPECT_THAT(
      warnings_of(cut, {"excavation.cut.outer=[[0.0, 10.0], [20.0, 10.0], [37.0, 39.0], [0.0, 39.0]]"}),
      Not(Contains(closed_ground)));
}

TEST(GroundWarnings, NotWhereTheGroundIsFree) {
  EXPECT_THAT(warnings_of(cut, {"domain.boundary=free"}), Not(Contains(closed_ground)));
  EXPECT_THAT(warnings_of(cut, {"domain={x=[0, 70], y=[0, 40]}",
                                "boundary={base=\"rigid\", sides=\"roller\", top=\"free\"}"}),
              Not(Contains(closed_ground)));
}

TEST(GroundWarnings, NotUnderRockNorWhereAllOfTheTopIsTakenAway) {
  EXPECT_THAT(warnings_of(cut, {"in_situ={depth=30.0, k0=1.0}"}), Not(Contains(closed_ground)));
  EXPECT_THAT(warnings_of(cut, {"in_situ={depth=0.0, k0=1.0}"}), Contains(closed_ground));
  EXPECT_THAT(
      warnings_of(cut, {"excavation.cut.outer=[[0.0, 10.0], [70.0, 10.0], [70.0, 40.0], [0.0, 40.0]]"}),
      Not(Contains(closed_ground)));
  EXPECT_THAT(
      warnings_of(cut, {"excavation.cut.outer=[[10.0, 10.0], [20.0, 10.0], [20.0, 20.0], [10.0, 20.0]]"}),
      Not(Contains(closed_ground)));
}

}  // namespace
}  // namespace keyblock::scenario
