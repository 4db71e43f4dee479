#include "loading/motion_units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "loading/motion_direction.h"
#include "motion_texts.h"

namespace keyblock::loading {
namespace {

using testing::HasSubstr;

TEST(MotionUnits, SpellingsOfAccelerations) {
  const std::pair<const char*, double> known[] = {
      {"g", 9.80665},       {"G's", 9.80665},         {"cm/s2", 0.01},
      {"CM/SEC/SEC", 0.01}, {"cm/sec**2", 0.01},      {"cm/s^2", 0.01},
      {"cm/s²", 0.01},      {"cm s-2", 0.01},         {"cm.s-2", 0.01},
      {"cm_s2", 0.01},      {"cm / sec / sec", 0.01}, {"centimeters per second squared", 0.01},
      {"gal", 0.01},        {"Gals.", 0.01},          {"m/s/s", 1.0},
      {"m s^-2", 1.0},      {"metres/second^2", 1.0}, {"mm/s/s", 1e-3},
      {"in/sec2", 0.0254},  {"ft/s2", 0.3048},        {"mg", 0.00980665},
      {"%g", 0.0980665},    {"g/10", 0.980665},       {"mgal", 1e-5}};
  for (const auto& [words, in_si] : known) {
    const auto unit = acceleration_unit(words);
    ASSERT_TRUE(unit) << words;
    EXPECT_DOUBLE_EQ(unit->in_si, in_si) << words;
  }
  for (const char* words : {"", "m", "cm", "cm/s", "kine", "m/s3", "furlong/s2", "counts", "in", "g g",
                            "cm/s2 or g", "s", "1/s2", "points", "hospital", "rad/s2", "10g"}) {
    EXPECT_FALSE(acceleration_unit(words)) << words;
  }
}

// The line of a file in another form: `title` in place of the line with the unit.
std::string with_title(const std::string& title) {
  return replaced(at2_text(), "ACCELERATION TIME HISTORY IN UNITS OF G", title);
}

TEST(MotionUnits, OfALineOfAnAt2File) {
  const std::pair<const char*, const char*> known[] = {
      {"ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=23.0 Hz", "g"},
      {"UNITS OF G.", "g"},
      {"ACCELERATION TIME SERIES (CM/SEC2)", "cm/s2"},
      {"Acceleration in cm/s/s", "cm/s2"},
      {"ACCELERATION (G)", "g"},
      {"UNITS: MM/SEC/SEC", "mm/s2"},
      {"values in m/s^2, corrected", "m/s2"}};
  for (const auto& [title, unit] : known) {
    SCOPED_TRACE(title);
    const auto c = read_text(with_title(title)).front();
    EXPECT_EQ(c.file_unit, unit);
    EXPECT_TRUE(c.notes.empty());
  }
  for (const char* title :
       {"ACCELERATION IN UNITS OF FURLONGS", "ACCELERATION (FURLONGS/SEC2)", "ACCELERATION IN CM/SEC",
        "UNITS: CM", "VELOCITY TIME HISTORY IN UNITS OF CM/S", "DISPLACEMENT", "VELOCITY (M/S)",
        "ACCELERATION IN 0.001 G", "ACCELERATION (0.01 CM/S2)", "ACCELERATION SCALED BY 980 CM/S2",
        "ACCELERATION IN UNITS OF G OR CM/S2", "UNITS: COUNTS", "UNITS OF"}) {
    SCOPED_TRACE(title);
    const Diagnostic d = error_of(with_title(title));
    EXPECT_EQ(d.where.line, 3);
    EXPECT_THAT(d.expected, HasSubstr("acceleration"));
  }
}

TEST(MotionUnits, TheUserStatesTheUnitOfAFileThatNamesNone) {
  MotionReading reading;
  reading.unit = "gal";
  const auto c = read_text(with_title("CORRECTED"), reading).front();
  EXPECT_EQ(c.file_unit, "cm/s2");
  EXPECT_TRUE(c.notes.empty());
  EXPECT_THAT(error_of(at2_text(), reading).found, HasSubstr("unit = \"gal\", and g in the file"));
  reading.unit = "furlongs";
  EXPECT_THAT(error_of(at2_text(), reading).expected, HasSubstr("a unit of acceleration"));
}

TEST(MotionDirections, Words) {
  const std::pair<const char*, double> azimuths[] = {{"N", 0.0},         {"NS", 0.0},
                                                     {"N-S", 0.0},       {"E", 90.0},
                                                     {"EW", 90.0},       {"W-E", 90.0},
                                                     {"north", 0.0},     {"S", 180.0},
                                                     {"west", 270.0},    {"164 (CDMG STATION 279)", 164.0},
                                                     {"360 Deg", 360.0}, {"N21E", 21.0},
                                                     {"S 62 W", 242.0},  {"N28W", 332.0}};
  for (const auto& [words, azimuth] : azimuths) EXPECT_EQ(parse_direction(words).azimuth, azimuth) << words;
  for (const char* words : {"UD", "U-D", "UP", "V", "vert", "Z"})
    EXPECT_TRUE(parse_direction(words).vertical) << words;
  EXPECT_TRUE(parse_direction("DWN").downwards);
  for (const char* words : {"", "L", "T", "H1", "FN", "400", "N95E", "-10"})
    EXPECT_FALSE(parse_direction(words).stated()) << words;
  EXPECT_EQ(channel_code_direction("HNE").azimuth, 90.0);
  EXPECT_FALSE(channel_code_direction("ONE").azimuth == 0.0);
  EXPECT_FALSE(channel_code_direction("H1").stated());
}

}  // namespace
}  // namespace keyblock::loading
