#include "loading/motion_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "motion_texts.h"

namespace keyblock::loading {
namespace {

using testing::HasSubstr;

const std::filesystem::path data = motion_data;
const std::filesystem::path records = std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "../shared/data/motions";
const std::string classical_at2 = at2_text(), cosmos = cosmos_text();

std::string content(const std::filesystem::path& path) {
  return file_content(path);
}

TEST(MotionFile, SmcExcerpt) {
  const auto components = read_motion_file(data / "excerpt.smc");
  ASSERT_EQ(components.size(), 1U);
  const MotionComponent& c = components[0];
  EXPECT_EQ(c.format, "USGS SMC");
  EXPECT_EQ(c.event, "1989 10 18 0004 Loma Prieta, CA");
  EXPECT_EQ(c.station, "San Francisco, 1295 Shafter, F");
  EXPECT_TRUE(c.vertical);
  EXPECT_FALSE(c.azimuth);
  EXPECT_DOUBLE_EQ(c.dt, 0.005);
  EXPECT_EQ(c.file_unit, "cm/s2");
  ASSERT_EQ(c.acceleration.size(), 20U);
  EXPECT_DOUBLE_EQ(c.acceleration[0], -0.12518);
  EXPECT_DOUBLE_EQ(c.acceleration[19], 0.087130);
  EXPECT_EQ(c.peak_index(), 0U);
  EXPECT_TRUE(c.notes.empty());
}

TEST(MotionFile, CsmipExcerptTakesTheAccelerationOfEveryChannel) {
  const auto components = read_motion_file(data / "excerpt.V2");
  ASSERT_EQ(components.size(), 2U);
  EXPECT_EQ(components[0].station, "PARKFIELD FAULT ZONE 14");
  EXPECT_EQ(components[0].event, "COALINGA EARTHQUAKE");
  EXPECT_EQ(components[0].azimuth, 90.0);
  EXPECT_TRUE(components[1].vertical);
  for (const MotionComponent& c : components) {
    EXPECT_DOUBLE_EQ(c.dt, 0.02);
    EXPECT_EQ(c.acceleration.size(), 16U);
    EXPECT_TRUE(c.notes.empty());
  }
  EXPECT_DOUBLE_EQ(components[0].acceleration[0], -0.03038);
  EXPECT_DOUBLE_EQ(components[0].acceleration[15], -0.00955);
  EXPECT_DOUBLE_EQ(components[1].acceleration[15], -0.30532);
}

TEST(MotionFile, At2WithFreeText) {
  const auto components = read_motion_file(data / "excerpt_free_text.AT2");
  ASSERT_EQ(components.size(), 1U);
  EXPECT_EQ(components[0].format, "PEER AT2");
  EXPECT_EQ(components[0].file_unit, "g");
  EXPECT_DOUBLE_EQ(components[0].dt, 0.02);
  EXPECT_FALSE(components[0].azimuth);
  ASSERT_EQ(components[0].acceleration.size(), 24U);
  EXPECT_DOUBLE_EQ(components[0].acceleration[0], 0.00630 * standard_gravity);
  EXPECT_DOUBLE_EQ(components[0].acceleration[23], -0.00992 * standard_gravity);
}

TEST(MotionFile, At2Classical) {
  for (const auto& text : {classical_at2, replaced(classical_at2, "NPTS=     7, DT= .00500 SEC",
                                                   "    7   0.0050    NPTS, DT")}) {
    const auto components = read_text(text);
    ASSERT_EQ(components.size(), 1U);
    EXPECT_EQ(components[0].station, "EL CENTRO ARRAY 6");
    EXPECT_EQ(components[0].azimuth, 230.0);
    EXPECT_DOUBLE_EQ(components[0].dt, 0.005);
    ASSERT_EQ(components[0].acceleration.size(), 7U);
    EXPECT_DOUBLE_EQ(components[0].acceleration[6], -0.007 * standard_gravity);
  }
  const auto down = read_text(replaced(classical_at2, "6, 230", "6, DWN"));
  EXPECT_TRUE(down[0].vertical);
  EXPECT_DOUBLE_EQ(down[0].acceleration[6], 0.007 * standard_gravity);
  EXPECT_THAT(down[0].notes, testing::ElementsAre(HasSubstr("downwards")));
}

TEST(MotionFile, CosmosReadsAccelerationsByTheStatedColumns) {
  const auto components = read_text(cosmos);
  ASSERT_EQ(components.size(), 2U);
  EXPECT_EQ(components[0].format, "COSMOS V2");
  EXPECT_EQ(components[0].azimuth, 270.0);
  EXPECT_DOUBLE_EQ(components[0].dt, 0.01);  // of the series in the file, not of the recorder
  EXPECT_THAT(components[0].acceleration, testing::ElementsAre(10.005, -2.0025, 10.00125));
  EXPECT_TRUE(components[1].vertical);
  EXPECT_THAT(components[1].acceleration, testing::ElementsAre(-0.01, -0.02, -0.03));
}

TEST(MotionFile, Csv) {
  MotionReading stated;
  stated.unit = "m/s2";
  const auto plain = read_text("0,1\n0.5,2\n1.0,-3\n", stated);
  EXPECT_EQ(plain[0].format, "table");
  EXPECT_DOUBLE_EQ(plain[0].dt, 0.5);
  EXPECT_THAT(plain[0].acceleration, testing::ElementsAre(1.0, 2.0, -3.0));
  EXPECT_TRUE(plain[0].notes.empty());

  const auto gal = read_text("# a comment\nt (s); a (cm/s2)\r\n0; 100\r\n0.1; -200\r\n");
  EXPECT_EQ(gal[0].file_unit, "cm/s2");
  EXPECT_THAT(gal[0].acceleration, testing::ElementsAre(1.0, -2.0));
  EXPECT_TRUE(gal[0].notes.empty());

  const auto g = read_text("time\tacceleration_g\n 1 1\n 2 0.5\n 4 0\n");
  EXPECT_DOUBLE_EQ(g[0].acceleration[1], 0.5 * standard_gravity);
  EXPECT_DOUBLE_EQ(g[0].dt, 0.0);
  EXPECT_THAT(g[0].times, testing::ElementsAre(1.0, 2.0, 4.0));
  EXPECT_DOUBLE_EQ(g[0].duration(), 3.0);
}

TEST(MotionFile, FilesCutShortNameTheLineAndTheCount) {
  struct Case {
    std::string text;
    int line;
    std::string found;
    std::string expected;
  };
  const std::string smc = content(data / "excerpt.smc"), v2 = content(data / "excerpt.V2");
  const auto until = [](const std::string& text, const std::string& mark) {
    return text.substr(0, text.find(mark));
  };
  const std::vector<Case> cases{
      {until(smc, " 7.9232E+0"), 37, "16 samples", "20 samples"},
      {until(smc, "  0.3772800E+02"), 19, "10 reals of the header", "50 reals"},
      {until(classical_at2, "   .6000000E-02"), 5, "5 samples", "7 samples"},
      {until(classical_at2, "0E-02   .2"), 5, "1 samples", "7 samples"},
      {until(v2, "    -8.412"), 102, "8 samples", "16 samples"},
      {"0,1\n", 1, "0,1", "at least two rows"},
      {"", 1, "the end of the file", "USGS SMC"},
  };
  for (const Case& c : cases) {
    const Diagnostic d = error_of(c.text);
    SCOPED_TRACE(d.to_string());
    EXPECT_EQ(d.where.line, c.line);
    EXPECT_FALSE(d.where.file.empty());
    EXPECT_THAT(d.found, HasSubstr(c.found));
    EXPECT_THAT(d.expected, HasSubstr(c.expected));
  }
}

TEST(MotionFile, DamagedSamplesNameLineAndColumn) {
  const std::string smc = content(data / "excerpt.smc");
  const Diagnostic letter = error_of(replaced(smc, " 1.3291E+0", " 1.32X1E+0"));
  EXPECT_EQ(letter.where.line, 37);
  EXPECT_EQ(letter.where.column, 31);
  EXPECT_EQ(letter.found, "\"1.32X1E+0\"");
  EXPECT_THAT(error_of(replaced(smc, " 1.3291E+0", "          ")).found, HasSubstr("blank"));
  EXPECT_THAT(error_of(replaced(classical_at2, ".4000000E-02", "         NaN")).expected,
              HasSubstr("finite number"));
  EXPECT_THAT(error_of(replaced(classical_at2, ".4000000E-02", ".4000000E999")).expected,
              HasSubstr("finite number"));
  EXPECT_THAT(error_of(classical_at2 + "  0.1\n").expected, HasSubstr("the end of the file after 7 samples"));
  EXPECT_THAT(error_of("0,1\n1,2\n1,3\n").expected, HasSubstr("after 1"));
  EXPECT_THAT(error_of("0,1\n1,2\n2,x\n").expected, HasSubstr("2 finite numbers"));
}

TEST(MotionFile, OtherQuantitiesAndUnitsAreRefused) {
  EXPECT_THAT(error_of(replaced(classical_at2, "ACCELERATION TIME HISTORY IN UNITS OF G",
                                "VELOCITY TIME HISTORY IN UNITS OF CM/S"))
                  .expected,
              HasSubstr("acceleration"));
  EXPECT_THAT(error_of(replaced(classical_at2, "UNITS OF G", "UNITS OF FURLONGS")).expected,
              HasSubstr("g, cm/s2, gal, m/s2 or mm/s2"));
  EXPECT_THAT(error_of(replaced(content(data / "excerpt.smc"), "2 CORRECTED ACCELEROGRAM",
                                "3 VELOCITY              "))
                  .expected,
              HasSubstr("an accelerogram"));
  EXPECT_THAT(error_of("time [s],acceleration [rods/s2]\n0,1\n1,2\n").expected,
              HasSubstr("a unit of acceleration"));
  EXPECT_THAT(error_of("Once upon a time\nthere was a\nfile\n").expected, HasSubstr("PEER AT2"));
  EXPECT_THROW(read_motion_file(data / "no-such-file"), InputError);
}

// A count that the file cannot hold would be cut to a size of its own, and a broken one to the whole number below.
TEST(MotionFile, CountsAreWholeNumbersThatTheFileHolds) {
  const std::string smc = content(data / "excerpt.smc"), v2 = content(data / "excerpt.V2");
  for (const std::string count : {"1e30", "1.5", "0", "-7", "1e9"}) {
    SCOPED_TRACE(count);
    EXPECT_THAT(error_of(replaced(classical_at2, "     7,", " " + count + ",")).expected,
                HasSubstr("number of samples"));
    EXPECT_THAT(error_of(replaced(v2, "16 POINTS OF ACCEL", count + " POINTS OF ACCEL")).expected,
                HasSubstr("number of points"));
    EXPECT_THAT(error_of(replaced(cosmos, "       3 acceleration pts", count + " acceleration pts")).expected,
                HasSubstr("number of values"));
    const std::string field = std::string(10 - count.size(), ' ') + count;
    EXPECT_THAT(error_of(replaced(smc, "        20    -32768", field + "    -32768")).expected,
                HasSubstr("number of points"));
    if (count == "0") continue;  // a record without comments
    EXPECT_THAT(error_of(replaced(smc, "       101         8", "       101" + field)).expected,
                HasSubstr("number of comment lines"));
  }
  // No width of a column: numbers end at blanks.
  EXPECT_EQ(read_text(replaced(cosmos, "(10I8)", "(10I99999999999999999999)")).size(), 2U);
}

TEST(MotionFile, MoreNumbersThanAnnounced) {
  const Diagnostic d = error_of(replaced(classical_at2, "NPTS=     7", "NPTS=     6"));
  EXPECT_EQ(d.where.line, 6);
  EXPECT_EQ(d.found, "\"-.7000000E-02\"");
  EXPECT_THAT(d.expected, HasSubstr("the end of the line after 6 samples"));
}

TEST(MotionFile, TimesAndSamplesStayWithinReason) {
  for (const std::string dt : {"1e308", "1e-300", "0", "-0.01"}) {
    EXPECT_THAT(error_of(replaced(classical_at2, "DT= .00500", "DT= " + dt)).expected,
                HasSubstr("1e-9 to 1e6 s"));
  }
  EXPECT_THAT(error_of(replaced(content(data / "excerpt.smc"), "0.2000000E+03", "0.2000000E+30")).expected,
              HasSubstr("sampling rate"));
  EXPECT_THAT(error_of("1e17,1\n100000000000000016,2\n").expected, HasSubstr("a time within"));
  EXPECT_THAT(error_of("0,1\n1e-300,2\n").expected, HasSubstr("the time step"));
  EXPECT_THAT(error_of(replaced(classical_at2, ".4000000E-02", " .400000E308")).found, HasSubstr("sample 4"));
}

TEST(MotionFile, WordsOfTheTitleAreNoUnit) {
  const auto hospital = read_text(replaced(classical_at2, "IMPERIAL VALLEY 10/15/79 2319, EL CENTRO ARRAY 6",
                                           "NORTHRIDGE, COMMUNITY HOSPITAL"));
  EXPECT_EQ(hospital[0].station, "COMMUNITY HOSPITAL");
  EXPECT_EQ(hospital[0].file_unit, "g");
  EXPECT_TRUE(hospital[0].notes.empty());
  const auto title = read_text(replaced(classical_at2, "EL CENTRO ARRAY 6", "UNIT (1) OF A POWER PLANT"));
  EXPECT_EQ(title[0].file_unit, "g");
  const auto words = read_text(replaced(classical_at2, "UNITS OF G", "UNITS OF CM/S/S, CORRECTED"));
  EXPECT_EQ(words[0].file_unit, "cm/s2");
}

TEST(MotionFile, TimesOfACsvMayBeMilliseconds) {
  for (const std::string header :
       {"time (ms),a (g)", "t_ms;a (m/s2)", "Time [msec] acc [g]", "time ms a_g"}) {
    SCOPED_TRACE(header);
    EXPECT_DOUBLE_EQ(read_text(header + "\n0 1\n100 2\n200 3\n")[0].dt, 0.1);
  }
  for (const std::string header :
       {"time (s),a_g", "t_s;a g", "t [sec] a [m/s2]", "t a_gal", "t (seconds), a (cm/s2)"}) {
    SCOPED_TRACE(header);
    EXPECT_DOUBLE_EQ(read_text(header + "\n0 1\n100 2\n200 3\n")[0].dt, 100.0);
  }
  for (const std::string header : {"time (min),a (g)", "t_us,a (m/s2)", "t [µs] a [g]", "time (UTC),a (g)"}) {
    SCOPED_TRACE(header);
    const Diagnostic d = error_of(header + "\n0 1\n1 2\n");
    EXPECT_EQ(d.where.line, 1);
    EXPECT_THAT(d.expected, HasSubstr("a unit of time in the header: s or ms"));
  }
}

TEST(MotionFile, AUnitInACommentOfACsvIsNotPassedOver) {
  constexpr const char* rows = "0,1\n0.1,2\n0.2,3\n";
  for (const char* comment : {"# PGA 0.3 g", "#mm/s^2", "# a (in/sec/sec)", "# values in %g"}) {
    SCOPED_TRACE(comment);
    const Diagnostic d = error_of(fmt::format("# a comment\n{}\n{}", comment, rows));
    EXPECT_EQ(d.where.line, 2);
    EXPECT_THAT(d.expected, HasSubstr("the unit in a header line, such as"));
    EXPECT_EQ(error_of(fmt::format("time acc\n{}\n{}", comment, rows)).where.line, 2);
    EXPECT_EQ(read_text(fmt::format("{}\nt,a (m/s2)\n{}", comment, rows))[0].acceleration[0], 1.0);
  }
  EXPECT_EQ(read_text(fmt::format("# m/s2\n{}", rows))[0].acceleration[0], 1.0);
  MotionReading stated;
  stated.unit = "m/s2";
  for (const char* comment :
       {"# source: PEER, g=9.81", "# Vs30 760 m/s, 12 km", "# Depth(km): 10", "# Gilroy"}) {
    SCOPED_TRACE(comment);
    EXPECT_EQ(read_text(fmt::format("{}\n{}", comment, rows), stated)[0].acceleration[0], 1.0);
    EXPECT_THAT(error_of(fmt::format("{}\n{}", comment, rows)).hint, HasSubstr("unit ="));
  }
}

TEST(MotionFile, ADamagedFirstRowOfACsvIsNoHeader) {
  for (const std::string row : {"0,nan", "0,5,", "nan,0", "0;", "1e999,2"}) {
    SCOPED_TRACE(row);
    const Diagnostic d = error_of(row + "\n0.01,1\n0.02,2\n");
    EXPECT_EQ(d.where.line, 1);
    EXPECT_THAT(d.expected, HasSubstr("two finite numbers"));
  }
  const auto marked = read_text(
      "\xEF\xBB\xBF"
      "t,a (m/s2)\n0,5\n0.01,1\n");
  EXPECT_THAT(marked[0].acceleration, testing::ElementsAre(5.0, 1.0));
}

TEST(MotionFile, AHeaderThatNamesAnotherUnitIsRefused) {
  for (const std::string header : {"t,a_mm", "t,acc in furlongs", "time (s),acc", "t,a [rod/s2]",
                                   "t,acc (raw)", "t,v_cm/s", "t,acc_counts", "t,a (1e-3 g)",
                                   "t,a (x10 m/s2)", "t,a 0.001 g", "t,a (g/100)", "t,a/g", "t,a (cm/s)"}) {
    EXPECT_THAT(error_of(header + "\n0,1\n1,2\n").expected, HasSubstr("g, cm/s2, gal, m/s2 or mm/s2"))
        << header;
  }
  EXPECT_THAT(error_of("t,velocity (m/s)\n0,1\n1,2\n").expected, HasSubstr("time series of acceleration"));
  const std::pair<std::string, std::string> known[] = {
      {"t,a_g", "g"},           {"t,acc in gal", "cm/s2"},
      {"t,a [cm/s2]", "cm/s2"}, {"time,acc in mm/s2", "mm/s2"},
      {"t,a [ft/s2]", "ft/s2"}, {"time_s,acceleration_cm_s2", "cm/s2"}};
  for (const auto& [header, unit] : known) {
    const auto components = read_text(header + "\n0,1\n1,2\n");
    EXPECT_EQ(components[0].file_unit, unit) << header;
    EXPECT_TRUE(components[0].notes.empty());
  }
  EXPECT_THAT(error_of("time,acceleration\n0,1\n1,2\n").hint, HasSubstr("unit = \"m/s2\""));
}

TEST(MotionFile, AWrongPeakInTheHeaderIsNoted) {
  const auto components = read_text(replaced(content(data / "excerpt.V2"), "PEAK ACCELERATION =    -5.659",
                                             "PEAK ACCELERATION =    -7.659"));
  EXPECT_THAT(components[0].notes, testing::ElementsAre(HasSubstr("-7.659")));
}

// A file that has all its samples is read though it has lost its last line.
TEST(MotionFile, AMissingEndMarkIsNoted) {
  const std::string v2 = content(data / "excerpt.V2");
  const auto last = read_text(v2.substr(0, v2.find("/&  ----------  END OF DATA FOR CHANNEL  2")));
  ASSERT_EQ(last.size(), 2U);
  EXPECT_TRUE(last[0].notes.empty());
  EXPECT_THAT(last[1].notes, testing::ElementsAre(HasSubstr("may have been cut short")));
  const std::string mark = "/&  ----------  END OF DATA FOR CHANNEL  1  ----------";
  const auto first = read_text(replaced(v2, mark, ""));
  ASSERT_EQ(first.size(), 2U);
  EXPECT_THAT(first[0].notes, testing::ElementsAre(HasSubstr("is missing")));
  EXPECT_TRUE(first[1].vertical);
  const auto section = read_text(cosmos.substr(0, cosmos.find("\nEnd-of-data")));
  EXPECT_THAT(section[0].notes, testing::ElementsAre(HasSubstr("may have been cut short")));
}

// The whole records. They are not shipped with the program.
struct Fact {
  std::string file;
  std::size_t component, count, points;
  double dt;
  std::string unit;
  double peak, peak_time;  // peak in the unit of the file
  std::optional<double> first, last;
  std::optional<double> azimuth;
};

TEST(MotionFile, WholeRecords) {
  if (!std::filesystem::exists(records)) GTEST_SKIP() << "the records are not at " << records;
  const std::vector<Fact> facts{
      {"0111a.smc", 0, 1, 6001, 0.005, "cm/s2", 104.41, 10.17, 1.5057, -0.28745, 360.0},
      {"0111b.smc", 0, 1, 6002, 0.005, "cm/s2", 48.347, 10.345, -12.518, -1.6806, {}},
      {"0111c.smc", 0, 1, 6004, 0.005, "cm/s2", 70.437, {}, -5.8486, -1.1594, 270.0},
      {"ELC1940_NS_Peknold.AT2", 0, 1, 1559, 0.02, "g", -0.31882, 2.02, 0.00630, 0.0, {}},
      {"ce36456p_CE36456.V2", 0, 3, 3251, 0.02, "cm/s2", -267.957, 10.94, -3.038, {}, 90.0},
      {"ce36456p_CE36456.V2", 1, 3, 3250, 0.02, "cm/s2", {}, {}, 2.335, {}, {}},
      {"ce36456p_CE36456.V2", 2, 3, 3250, 0.02, "cm/s2", {}, {}, {}, {}, 0.0},
  };
  for (const Fact& fact : facts) {
    SCOPED_TRACE(fact.file);
    const auto components = read_motion_file(records / fact.file);
    ASSERT_EQ(components.size(), fact.count);
    const MotionComponent& c = components[fact.component];
    EXPECT_EQ(c.acceleration.size(), fact.points);
    EXPECT_DOUBLE_EQ(c.dt, fact.dt);
    EXPECT_EQ(c.file_unit, fact.unit);
    EXPECT_EQ(c.azimuth, fact.azimuth);
    EXPECT_EQ(c.vertical, fact.file == "0111b.smc" || fact.component == 1);
    EXPECT_TRUE(c.notes.empty()) << c.notes.front();
    const auto in_file_unit = [&](double a) { return a / c.file_unit_in_si; };
    if (fact.peak != 0.0) {
      EXPECT_NEAR(in_file_unit(c.acceleration[c.peak_index()]), fact.peak, 1e-5 * std::abs(fact.peak));
    }
    if (fact.peak_time != 0.0) {
      EXPECT_NEAR(c.time(c.peak_index()), fact.peak_time, 1e-9);
    }
    if (fact.first) {
      EXPECT_NEAR(in_file_unit(c.acceleration.front()), *fact.first, 1e-9);
    }
    if (fact.last) {
      EXPECT_NEAR(in_file_unit(c.acceleration.back()), *fact.last, 1e-9);
    }
  }
}

}  // namespace
}  // namespace keyblock::loading
