#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion_texts.h"

namespace keyblock::loading {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

MotionReading by_hand(std::optional<int> skip, std::optional<int> column, std::optional<double> dt,
                      std::string unit = "g") {
  MotionReading reading;
  reading.skip = skip;
  reading.column = column;
  reading.dt = dt;
  reading.unit = std::move(unit);
  return reading;
}

TEST(MotionTable, ThreeComponentsWithDirectionsAndUnits) {
  for (const char* header :
       {"time (s),N-S (g),E-W (g),U-D (g)", "t;NS [g];EW [g];UD [g]", "Time\tacc_n_g\tacc_e_g\tacc_z_g",
        "time N E Z\n(s) (g) (g) (g)", "# time N E up_g", "time_s,acc_000_g,acc_090_g,acc_up_g",
        "Time,HNN (g),HNE (g),HNZ (g)", "time,N,E,Z [g]"}) {
    SCOPED_TRACE(header);
    const std::string text = header;
    const char separator = text.find(';') != std::string::npos   ? ';'
                           : text.find(',') != std::string::npos ? ','
                                                                 : ' ';
    const auto components =
        read_text(fmt::format("{0}\n0{1}1{1}2{1}3\n0.5{1}-1{1}-2{1}-3\n", header, separator));
    ASSERT_EQ(components.size(), 3U);
    EXPECT_EQ(components[0].azimuth, 0.0);
    EXPECT_EQ(components[1].azimuth, 90.0);
    EXPECT_TRUE(components[2].vertical);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(components[c].dt, 0.5);
      EXPECT_DOUBLE_EQ(components[c].acceleration[0], (1.0 + static_cast<double>(c)) * standard_gravity);
      EXPECT_TRUE(components[c].notes.empty());
    }
  }
}

TEST(MotionTable, WithoutNamesThereAreNoDirections) {
  MotionReading stated;
  stated.unit = "m/s2";
  const auto components = read_text("0 1 2 3\n0.5 -1 -2 -3\n", stated);
  ASSERT_EQ(components.size(), 3U);
  EXPECT_FALSE(components[1].azimuth);
  EXPECT_FALSE(components[2].vertical);
  EXPECT_THAT(error_of("0 1 2 3\n0.5 -1 -2 -3\n").hint, HasSubstr("unit = \"m/s2\""));
  EXPECT_THAT(error_of("0 1 2 3 4\n0.5 -1 -2 -3 4\n").expected,
              HasSubstr("a table of time and accelerations"));
}

TEST(MotionTable, ACountBeforeTheTimesIsNoTime) {
  std::string text;
  for (int k = 0; k < 12; ++k) text += fmt::format("{} {:.2f} {}\n", k + 1, 0.01 * k, k % 3);
  EXPECT_THAT(error_of(text).expected, HasSubstr("times in the first column only"));
}

TEST(MotionTable, OtherColumnsAreLeftOut) {
  const auto components =
      read_text("time (s),acceleration (cm/s2),velocity (cm/s),displ_cm\n0,100,2,3\n0.5,200,4,6\n");
  ASSERT_EQ(components.size(), 1U);
  EXPECT_THAT(components[0].acceleration, ElementsAre(1.0, 2.0));
  EXPECT_THAT(components[0].processing, HasSubstr("velocity (cm/s)"));
  EXPECT_THAT(error_of("time (s),velocity (cm/s)\n0,1\n1,2\n").expected,
              HasSubstr("time series of acceleration"));
}

TEST(MotionTable, TheFirstColumnIsTime) {
  for (const char* header : {"N-S,E-W", "acc (g),time (s)", "no,time (s),acc (g)"}) {
    const std::string more = std::string(header).starts_with("no") ? ",3" : "";
    EXPECT_THAT(error_of(fmt::format("{0}\n0,1{1}\n1,2{1}\n", header, more)).expected,
                HasSubstr("time in the first column"))
        << header;
  }
}

TEST(MotionTable, DecimalCommas) {
  for (const char* text : {"t (s);a (m/s2)\n0,00;1,5\n0,01;-2,25\n", "t a_m/s2\n0,00 1,5\n0,01 -2,25\n",
                           "t (s)\ta (m/s2)\n0,00\t1,5\n0,01\t-2,25\n"}) {
    SCOPED_TRACE(text);
    const auto c = read_text(text).front();
    EXPECT_DOUBLE_EQ(c.dt, 0.01);
    EXPECT_THAT(c.acceleration, ElementsAre(1.5, -2.25));
  }
  EXPECT_THAT(error_of("0,00;1,5\n0,01;2.5\n").expected, HasSubstr("decimal commas only"));
  EXPECT_THAT(error_of("0;1.234,5\n1;2\n").expected, HasSubstr("finite numbers"));
}

TEST(MotionTable, ACommentMayNameTheUnit) {
  for (const char* comment : {"# units: cm/s2", "# acceleration in gal",
                              "#AmplitudeUnit:  gal. DCoffset(corr)", "% unit=cm/sec/sec"}) {
    SCOPED_TRACE(comment);
    const auto c = read_text(fmt::format("{}\n0 100\n1 200\n", comment)).front();
    EXPECT_THAT(c.acceleration, ElementsAre(1.0, 2.0));
    EXPECT_THAT(c.notes, ElementsAre(HasSubstr("comment in line 1")));
  }
  for (const char* comment : {"# units: cm/s", "# units: furlongs/s2", "# units: g\n# acceleration in gal"})
    EXPECT_THROW(read_text(fmt::format("{}\n0 100\n1 200\n", comment)), InputError) << comment;
}

TEST(MotionTable, RowsOfAnotherLengthNameTheirLine) {
  const Diagnostic more = error_of("0,1,2\n1,2,3\n2,3\n");
  EXPECT_EQ(more.where.line, 3);
  EXPECT_THAT(more.expected, HasSubstr("3 finite numbers"));
  const Diagnostic word = error_of("0,1,2\n1,x,3\n");
  EXPECT_EQ(word.where.line, 2);
  EXPECT_EQ(word.where.column, 3);
}

TEST(MotionByHand, NumbersInColumns) {
  const std::string text = "a report\nof 3 lines\n\n0.0 1 10\n0.5 2 20\n1.0 -3 30\n";
  const auto second = read_text(text, by_hand(3, {}, {})).front();
  EXPECT_EQ(second.dt, 0.5);
  EXPECT_DOUBLE_EQ(second.acceleration[2], -3.0 * standard_gravity);
  const auto third = read_text(text, by_hand(3, 3, {}, "gal")).front();
  EXPECT_DOUBLE_EQ(third.acceleration[2], 0.3);
  const auto stepped = read_text(text, by_hand(3, 2, 0.01)).front();
  EXPECT_EQ(stepped.dt, 0.01);
  EXPECT_DOUBLE_EQ(stepped.acceleration[0], standard_gravity);
  EXPECT_TRUE(stepped.notes.empty());
}

TEST(MotionByHand, NumbersOneAfterTheOther) {
  const auto c = read_text("head\n 1.0 -2.0 3.0-4.0\n5.D0 6.0\n", by_hand({}, {}, 0.02)).front();
  EXPECT_EQ(c.dt, 0.02);
  ASSERT_EQ(c.acceleration.size(), 2U + 4U);
  EXPECT_DOUBLE_EQ(c.acceleration[3], -4.0 * standard_gravity);
}

TEST(MotionByHand, SaysWhatIsMissing) {
  const std::string text = "0 1\n1 2\n2 3\n";
  EXPECT_THAT(error_of(text, by_hand(0, {}, {}, "")).expected, HasSubstr("the unit of the samples"));
  EXPECT_THAT(error_of(text, by_hand(0, {}, {}, "m")).expected, HasSubstr("a unit of acceleration"));
  EXPECT_THAT(error_of(text, by_hand(7, {}, {})).expected, HasSubstr("lines of numbers"));
  EXPECT_THAT(error_of(text, by_hand(0, 3, {})).found, HasSubstr("2 columns"));
  EXPECT_THAT(error_of(text, by_hand(0, 1, {})).expected, HasSubstr("or dt"));
  EXPECT_THAT(error_of("words\n" + text, by_hand(0, {}, 0.01)).found, HasSubstr("words"));
}

}  // namespace
}  // namespace keyblock::loading
