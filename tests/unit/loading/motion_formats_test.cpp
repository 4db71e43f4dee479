#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "../fresh_folder.h"
#include "motion_texts.h"

namespace keyblock::loading {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(KnetFormat, CountsTimesTheScaleWithoutTheirMean) {
  const auto components = read_text(knet_text("E-W"));
  ASSERT_EQ(components.size(), 1U);
  const MotionComponent& c = components[0];
  EXPECT_EQ(c.format, "K-NET");
  EXPECT_EQ(c.azimuth, 90.0);
  EXPECT_EQ(c.dt, 0.5);
  ASSERT_EQ(c.acceleration.size(), 12U);
  EXPECT_DOUBLE_EQ(c.acceleration[7], 0.6);  // 120 counts above the mean, of 0.5 gal
  EXPECT_EQ(c.peak_index(), 7U);
  EXPECT_THAT(c.notes, IsEmpty());
  EXPECT_THAT(c.processing, HasSubstr("50 cm/s2, is taken off"));
}

TEST(KnetFormat, NumbersAreDirectionsOfABorehole) {
  const std::pair<const char*, const char*> known[] = {
      {"1", "N-S, at depth"},       {"2", "E-W, at depth"},       {"3", "U-D, at depth"},
      {"4", "N-S, at the surface"}, {"5", "E-W, at the surface"}, {"6", "U-D, at the surface"}};
  for (const auto& [number, label] : known) {
    const auto c = read_text(knet_text(number)).front();
    EXPECT_EQ(c.format, "KiK-net");
    EXPECT_EQ(c.label, label);
    EXPECT_EQ(c.vertical, *number == '3' || *number == '6');
    EXPECT_EQ(c.azimuth.has_value(), !c.vertical);
  }
  EXPECT_THAT(error_of(knet_text("7")).expected, HasSubstr("N-S, E-W, U-D or 1 to 6"));
}

TEST(KnetFormat, DamageIsTold) {
  const std::string text = knet_text("N-S");
  EXPECT_THAT(error_of(replaced(text, "2000(gal)/4000", "2000(kine)/4000")).expected, HasSubstr("3920(gal)"));
  EXPECT_THAT(error_of(replaced(text, "2000(gal)/4000", "2000(gal)/0")).expected, HasSubstr("3920(gal)"));
  EXPECT_EQ(error_of(replaced(text, "2000(gal)/4000", "2000/4000")).where.line, 14);
  EXPECT_THAT(error_of(replaced(text, "(s)  6", "(s)  7")).expected, HasSubstr("14 samples"));
  EXPECT_THAT(error_of(replaced(text, "(s)  6", "(s)  5")).found, HasSubstr("95"));
  EXPECT_THAT(read_text(replaced(text, "60.000", "70.000"))[0].notes,
              ElementsAre(HasSubstr("a peak of 70 cm/s2")));
}

TEST(EsmFormat, ReadsKeysAndSamples) {
  const auto c = read_text(esm_text()).front();
  EXPECT_EQ(c.azimuth, 0.0);
  EXPECT_EQ(c.dt, 0.005);
  EXPECT_EQ(c.station, "XX EXA Example");
  EXPECT_THAT(c.acceleration, ElementsAre(0.1, -0.3, DoubleEq(0.205), 0.0));
  EXPECT_THAT(c.notes, IsEmpty());
  EXPECT_EQ(read_text(replaced(esm_text(), "HNN", "HGE"))[0].azimuth, 90.0);
  EXPECT_TRUE(read_text(replaced(esm_text(), "HNN", "HLZ"))[0].vertical);
  EXPECT_EQ(read_text(replaced(esm_text(), "STREAM: HNN", "COMPONENT: WEC"))[0].azimuth, 90.0);
}

TEST(EsmFormat, OtherQuantitiesAndCountsAreRefused) {
  EXPECT_THAT(error_of(replaced(esm_text(), "ACCELERATION", "VELOCITY")).expected, HasSubstr("ACCELERATION"));
  EXPECT_THAT(error_of(replaced(esm_text(), "cm/s^2", "cm/s")).found, HasSubstr("cm/s"));
  EXPECT_THAT(error_of(replaced(esm_text(), "UNITS: cm/s^2", "UNITS: ")).expected,
              HasSubstr("a unit of acceleration"));
  EXPECT_THAT(error_of(replaced(esm_text(), "NDATA: 4", "NDATA: 5")).found, HasSubstr("after 4 samples"));
  EXPECT_THAT(error_of(replaced(esm_text(), "NDATA: 4", "NDATA: 3")).expected, HasSubstr("after 3 samples"));
}

TEST(GeonetFormat, ThreeComponentsInFixedColumns) {
  for (const bool corrected : {false, true}) {
    SCOPED_TRACE(corrected);
    const auto components = read_text(geonet_text(corrected));
    ASSERT_EQ(components.size(), 3U);
    EXPECT_EQ(components[0].format, corrected ? "GeoNet V2A" : "GeoNet V1A");
    EXPECT_EQ(components[0].azimuth, 332.0);
    EXPECT_TRUE(components[1].vertical);
    EXPECT_EQ(components[2].azimuth, 242.0);
    for (const MotionComponent& c : components) {
      EXPECT_EQ(c.dt, 0.02);
      EXPECT_EQ(c.acceleration.size(), 12U);
      EXPECT_EQ(c.station, "Example School");
      EXPECT_THAT(c.notes, IsEmpty());
    }
    EXPECT_DOUBLE_EQ(components[0].acceleration[2], -12.3456);  // mm/s/s, without a blank before it
    EXPECT_DOUBLE_EQ(components[0].acceleration[3], 12.0005);
    EXPECT_DOUBLE_EQ(components[1].acceleration[2], -6.1728);
  }
}

TEST(GeonetFormat, DamageIsTold) {
  const std::string text = geonet_text(true);
  EXPECT_THAT(error_of(replaced(text, "mm/s/s", "mm/s")).found, HasSubstr("mm/s"));
  EXPECT_THAT(error_of(text.substr(0, text.size() - 10)).expected,
              HasSubstr("12 values of velocity or displacement"));
  EXPECT_DOUBLE_EQ(
      read_text(replaced(geonet_text(false), "units of 1.00", "units of 2.00"))[0].acceleration[3], 24.001);
}

TEST(AfadFormat, ThreeColumnsWithDirections) {
  const auto components = read_text(afad_text());
  ASSERT_EQ(components.size(), 3U);
  EXPECT_EQ(components[0].azimuth, 0.0);
  EXPECT_EQ(components[1].azimuth, 90.0);
  EXPECT_TRUE(components[2].vertical);
  EXPECT_THAT(components[0].acceleration, ElementsAre(DoubleEq(-0.01), 0.125, DoubleEq(0.005)));
  EXPECT_THAT(components[2].acceleration, ElementsAre(DoubleEq(0.03), DoubleEq(-0.01), DoubleEq(0.0025)));
  EXPECT_EQ(components[0].station, "4304 KüTAHYA");  // Latin-1 in the file
  EXPECT_THAT(components[0].notes, IsEmpty());
  EXPECT_THAT(error_of(replaced(afad_text(), "(gal)", "(counts)")).expected, HasSubstr("unit"));
  EXPECT_THAT(error_of(replaced(afad_text(), "DATA          : 3", "DATA          : 4")).found,
              HasSubstr("9 values"));
  EXPECT_THAT(error_of(replaced(afad_text(), "DATA          : 3", "DATA          : 2")).expected,
              HasSubstr("the end of the file"));
}

TEST(CsmipFormat, Volume1OfAllDecades) {
  const auto film = read_text(csmip_1_pairs()).front();
  EXPECT_EQ(film.format, "CSMIP V1");
  EXPECT_EQ(film.azimuth, 90.0);
  EXPECT_EQ(film.station, "HESPERIA - 4TH & PALM");
  EXPECT_THAT(film.times, ElementsAre(0.0, 0.005, 0.011, 0.015, 0.02, 0.025));
  EXPECT_DOUBLE_EQ(film.acceleration[2], -0.2 * standard_gravity);
  EXPECT_THAT(film.notes, ElementsAre(HasSubstr("not evenly spaced")));
  const std::string samples = "  .000010  .000010 -.079007 -.000002  .000009  .000007\n";
  const std::string unit = "Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.";
  for (const char* title : {" 6 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)\n",
                            "6 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)\n"}) {
    SCOPED_TRACE(title);
    const auto c = read_text(csmip_1_text(title, unit, samples)).front();
    EXPECT_EQ(c.format, "CSMIP V1");
    EXPECT_DOUBLE_EQ(c.dt, 0.005);
    ASSERT_EQ(c.acceleration.size(), 6U);
    EXPECT_DOUBLE_EQ(c.acceleration[2], -0.079007 * standard_gravity);
    EXPECT_THAT(c.notes, IsEmpty());
  }
}

TEST(CsmipFormat, SpectraAndStrangeUnitsAreRefused) {
  EXPECT_THAT(error_of("RESPONSE AND FOURIER AMPLITUDE SPECTRA\nCORRECTED ACCELEROGRAM\n1 2 3\n").expected,
              HasSubstr("spectra (V3)"));
  const std::string pairs = csmip_1_pairs();
  EXPECT_THAT(error_of(replaced(pairs, "G/10.", "G*10.")).expected, HasSubstr("a unit of acceleration"));
  const std::string v2 = file_content(motion_data / "excerpt.V2");
  EXPECT_THAT(error_of(replaced(v2, "CM/SEC/SEC)", "CM/SEC)")).found, HasSubstr("cm/sec"));
  EXPECT_THAT(error_of(replaced(v2, "CM/SEC/SEC)", "CM)")).found, HasSubstr("cm"));
}

// Columns that are full on both sides, which only the stated format parts.
TEST(CsmipFormat, TheStatedColumnsAreTaken) {
  const std::string v2 = file_content(motion_data / "public/csmip-lower-case.V2");
  const std::size_t title = v2.find("points of accel data"), line = v2.find('\n', title) + 1;
  std::string glued = v2;
  glued.replace(line, 20, "1234.567890123.56789");
  const auto c = read_text(glued).front();
  EXPECT_DOUBLE_EQ(c.acceleration[0], 12.3456789);
  EXPECT_DOUBLE_EQ(c.acceleration[1], 0.0123 * 100.0 + 0.0056789);
}

TEST(CosmosFormat, VariantsOfUnitsAndEndMarks) {
  const std::string samples = "   1.000   2.000   3.000";
  const std::pair<const char*, double> units[] = {{"cm/sec2(04)", 0.01},
                                                  {"cm/sec^2 (04)", 0.01},
                                                  {"g (02)", standard_gravity},
                                                  {"gal(10)", 0.01},
                                                  {"mg (11)", 0.00980665}};
  for (const auto& [unit, in_si] : units) {
    SCOPED_TRACE(unit);
    EXPECT_DOUBLE_EQ(read_text(cosmos_section("acceleration", 90, unit, samples))[0].acceleration[0], in_si);
  }
  for (const char* unit : {"counts(50)", "cm/sec(05)", "furlongs/sec2(04)"}) {
    EXPECT_THAT(error_of(cosmos_section("acceleration", 90, unit, samples)).expected,
                HasSubstr("a unit of acceleration"))
        << unit;
  }
  const std::string one = cosmos_section("acceleration", 90, "g(02)", samples);
  for (const char* mark : {"/&  ----------  End of data for channel  1  ----------", "END-OF-DATA"}) {
    const auto marked = read_text(replaced(one + one, "End-of-data for Chan  1 acceleration", mark));
    EXPECT_EQ(marked.size(), 2U);
    EXPECT_THAT(marked[0].notes, IsEmpty());
  }
}

TEST(CosmosFormat, TheUnitOfTheIntegersMustAgree) {
  std::string text = cosmos_section("acceleration", 90, "cm/sec2(04)", "   1.000   2.000   3.000");
  const std::size_t integers = text.find("(10I8)\n") + 7 + 2 * 8;
  EXPECT_EQ(read_text(std::string(text).replace(integers, 8, "       4"))[0].file_unit, "cm/s2");
  EXPECT_THAT(error_of(std::string(text).replace(integers, 8, "       2")).expected,
              HasSubstr("g, as the integer header"));
}

TEST(CosmosFormat, WithoutAnAzimuthTheCodeOfTheChannelTellsTheDirection) {
  const std::string none = cosmos_section("acceleration", 0, "cm/sec2(04)", "   1.000   2.000   3.000");
  EXPECT_FALSE(read_text(none)[0].azimuth);
  const auto coded = read_text(replaced(none, "\n|\n", "\n|<SCNL>BMR.BNZ.AK.--    <AUTH> 2019\n"));
  EXPECT_TRUE(coded[0].vertical);
}

std::string refusal_of(const std::filesystem::path& path) {
  try {
    read_motion_file(path);
  } catch (const InputError& error) {
    return error.diagnostics().front().to_string();
  }
  return "read";
}

TEST(MotionFile, WhatIsNoTextIsNamed) {
  const FreshFolder folder;
  const auto write = [&](const std::string& content) {
    std::ofstream(folder / "file", std::ios::binary) << content;
    return refusal_of(folder / "file");
  };
  EXPECT_THAT(write("PK\x03\x04" + std::string(100, 'x')), HasSubstr("save the sheet as CSV"));
  EXPECT_THAT(write(std::string("\x1F\x8B", 2) + "xx"), HasSubstr("gzip"));
  EXPECT_THAT(write("\xFF\xFE" + std::string("1\0,\0", 4)), HasSubstr("UTF-16"));
  EXPECT_THAT(write("000001D AB  C" + std::string(20, '\0')), HasSubstr("miniSEED"));
  EXPECT_THAT(write(std::string("0 1\n1 \0 2\n", 10)), HasSubstr("a binary file"));
  EXPECT_THAT(write("0 1\n" + std::string(2'000'000, '1')), HasSubstr("a line of 2000000 characters"));
  EXPECT_THAT(refusal_of(folder), HasSubstr("a folder"));
  EXPECT_THAT(refusal_of("/dev/zero"), HasSubstr("a device or pipe"));
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal_of(folder / "pipe"), HasSubstr("a device or pipe"));
  std::filesystem::resize_file(folder / "file", std::uintmax_t{1} << 40U);
  EXPECT_THAT(refusal_of(folder / "file"), HasSubstr("at most 200 MB"));
}

TEST(MotionFile, LineEndsTabsAndExponentsOfFortran) {
  const auto plain = read_text(at2_text())[0].acceleration;
  std::string crlf = at2_text(), cr = at2_text();
  for (std::size_t at = crlf.find('\n'); at != std::string::npos; at = crlf.find('\n', at + 2))
    crlf.insert(at, "\r");
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  EXPECT_EQ(read_text(crlf)[0].acceleration, plain);
  EXPECT_EQ(read_text(cr)[0].acceleration, plain);
  EXPECT_EQ(read_text(replaced(at2_text(), ".4000000E-02", ".4000000D-02"))[0].acceleration, plain);
  EXPECT_EQ(
      read_text(replaced(at2_text(), "   .2000000E-02  -.3000000E-02", "\t.2000000E-02-.3000000E-02"))[0]
          .acceleration,
      plain);
  EXPECT_EQ(
      read_text(replaced(cosmos_text(), "   1.000   2.000   3.000", "1.000\t2.000\t3.000"))[1].acceleration,
      read_text(cosmos_text())[1].acceleration);
}

}  // namespace
}  // namespace keyblock::loading
