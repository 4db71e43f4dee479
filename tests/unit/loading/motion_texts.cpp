#include "motion_texts.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "../fresh_folder.h"

namespace keyblock::loading {

std::string file_content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

std::vector<MotionComponent> read_text(const std::string& text, const MotionReading& reading) {
  const FreshFolder folder;
  const auto path = folder / "record";
  std::ofstream(path, std::ios::binary) << text;
  return read_motion_file(path, reading);
}

Diagnostic error_of(const std::string& text, const MotionReading& reading) {
  try {
    read_text(text, reading);
  } catch (const InputError& error) {
    return error.diagnostics().front();
  }
  ADD_FAILURE() << "no error";
  return {};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

std::string at2_text() {
  return "PEER STRONG MOTION DATABASE RECORD\n"
         "IMPERIAL VALLEY 10/15/79 2319, EL CENTRO ARRAY 6, 230\n"
         "ACCELERATION TIME HISTORY IN UNITS OF G\n"
         "NPTS=     7, DT= .00500 SEC\n"
         "  -.1000000E-02   .2000000E-02  -.3000000E-02   .4000000E-02   .5000000E-02\n"
         "   .6000000E-02  -.7000000E-02\n";
}

std::string cosmos_section(const std::string& quantity, int azimuth, const std::string& unit,
                           const std::string& samples) {
  std::string text =
      "Corrected " + quantity + "    (Format v01.20 with 13 text lines)\nSome Earthquake\n3\n4\n";
  text += "Statn No: 02-    0  Code:NP-1743   USGS CA:Petaluma;FS 2\n6\n7\n8\n";
  text += "Sta Chan   1: " + std::to_string(azimuth) + " deg (Rcrdr Chan  1) Location:\n10\n11\n12\n13\n";
  text += " 100  Integer-header values follow on 10 lines, Format= (10I8)\n";
  for (int k = 0; k < 100; ++k) {
    std::string field = std::to_string(k == 53 ? azimuth : -999);
    text += std::string(8 - field.size(), ' ') + field + (k % 10 == 9 ? "\n" : "");
  }
  text += " 100 Real-header values follow on 17 lines, Format= (6F13.6)\n";
  for (int k = 0; k < 100; ++k) {
    const std::string field = k == 61 ? "    10.000000" : k == 33 ? "     0.005000" : "  -999.000000";
    text += field + (k % 6 == 5 || k == 99 ? "\n" : "");
  }
  text += "   1 Comment line(s) follow, each starting with a \"|\":\n|\n";
  text += "       3 " + quantity + " pts, approx    0 secs, units=" + unit + ",Format=(8F8.3)\n" + samples;
  return text + "\nEnd-of-data for Chan  1 " + quantity + "\n";
}

std::string cosmos_text() {
  return cosmos_section("acceleration", 270, "cm/sec2(04)", "1000.500-200.2501000.125") +
         cosmos_section("velocity", 270, "cm/sec(05)", "   1.000   2.000   3.000") +
         cosmos_section("acceleration", 401, "cm/s^2 (4)", "   1.000   2.000   3.000");
}

std::string knet_text(const std::string& direction) {
  return "Origin Time       2020/01/01 00:00:00\nLat.              36.0\nLong.             140.0\n"
         "Depth. (km)       10\nMag.              6.0\nStation Code      XXX001\nStation Lat.      36.1000\n"
         "Station Long.     140.1000\nStation Height(m) 10\nRecord Time       2020/01/01 00:00:15\n"
         "Sampling Freq(Hz) 2Hz\nDuration Time(s)  6\nDir.              " +
         direction +
         "\nScale Factor      2000(gal)/4000\nMax. Acc. (gal)   60.000\nLast Correction   2020/01/01 "
         "00:00:15\n"
         "Memo.             \n"
         "     100      110       90      130       70      160       40      220 \n"
         "     -20      105       95      100 \n";
}

std::string esm_text() {
  std::string text = "EVENT_NAME: SOMEWHERE\nEVENT_ID: XX\nEVENT_DATE_YYYYMMDD: 20200101\nNETWORK: XX\n";
  text += "STATION_CODE: EXA\nSTATION_NAME: Example\nSAMPLING_INTERVAL_S: 0.005000\nNDATA: 4\nSTREAM: HNN\n";
  text +=
      "UNITS: cm/s^2\nPGA_CM/S^2: -30.000000\nHEADER_FORMAT: DYNA 1.2\nDATA_TYPE: ACCELERATION\nUSER5: \n";
  return text + "10.000000\n-30.000000\n20.500000\n0.000000\n";
}

namespace {

// Values in columns of eight, ten to a line.
std::string rows_of_ten(const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t k = 0; k < values.size(); ++k)
    text += fmt::format("{:>8}{}", values[k], k % 10 == 9 || k + 1 == values.size() ? "\n" : "");
  return text;
}

std::string geonet_component(const std::string& direction, int bearing, bool corrected, double factor) {
  constexpr int points = 12;
  std::string text = corrected ? "Corrected accelerogram 20200101_000000_XXXX_20 GNS Science\n"
                               : "Uncorrected accelerogram 20200101_000000_XXXX_20 GNS Science\n";
  text += "Site XXXX      42 37 10S  173 03 13E\nExample School\nInstrument Cusp_1\nResolution: 18-bit\n";
  text += "Accelerogram 20200101_000000_XXXX_20\n5 km south-west of Somewhere\n2020 January 01\nEpicentre\n";
  text += "Number of points  12    Duration 0.24 sec\n";
  text += corrected ? "Instrument corrected data at 0.020 sec intervals\n"
                    : "Raw readings in units of 1.00 mm/s/s  at intervals of 0.020 s\n";
  text += "Data is unfiltered\nComponent " + direction + "  Longitudinal Accelerometer Axis\n";
  text += fmt::format("Acceleration:  Peak {:8.1f} mm/s/s at   0.04 s     RMS     1.0 mm/s/s\n",
                      -12345.6 * factor);
  text += "Velocity:      peak\nDisplacement:  peak\n";
  std::vector<std::string> integers(40, "0");
  integers[27] = std::to_string(bearing);
  integers[30] = "120";
  integers[33] = std::to_string(points);
  integers[34] = integers[35] = corrected ? std::to_string(points) : "0";
  std::vector<std::string> reals(60, "0.00");
  reals[24] = "0.0050";
  reals[25] = "0.0200";
  std::vector<std::string> samples, others;
  for (int k = 0; k < points; ++k) {
    const double value = k == 2 ? -12345.6 : k == 3 ? 12000.5 : k;
    samples.push_back(fmt::format("{:.1f}", value * factor));
    others.push_back("7.25");
  }
  text += rows_of_ten(integers) + rows_of_ten(reals) + rows_of_ten(samples);
  return corrected ? text + rows_of_ten(others) + rows_of_ten(others) : text;
}

std::string columns_of(int count, const char* field, int width, int per_line) {
  std::string text;
  for (int k = 0; k < count; ++k)
    text += fmt::format("{:>{}}{}", field, width, k % per_line == per_line - 1 || k + 1 == count ? "\n" : "");
  return text;
}

}  // namespace

std::string geonet_text(bool corrected) {
  return geonet_component("N28W", 332, corrected, 1.0) + geonet_component("Up", 0, corrected, 0.5) +
         geonet_component("S62W", 242, corrected, 0.25);
}

std::string afad_text() {
  return "STRONG GROUND MOTION RECORDS OF TURKIYE\n"
         "PLACE                   : K\xFCTAHYA\n"
         "EARTHQUAKE DATE         : 2020/01/01 00:00:00 (GMT)\n"
         "EARTHQUAKE MAGNITUDE    : 6.5 Mw\n"
         "STATION ID              : 4304\n"
         "NUMBER OF DATA          : 3\n"
         "SAMPLING INTERVAL (sec) : 0.01\n"
         "RAW PGA VALUES (gal)    : (N-S) 12.5 (E-W) 7.25 (U-D) 3\n"
         "Copyright EARTHQUAKE DEPARTMENT\n"
         "       N-S          E-W          U-D\n"
         "   -1.000000      2.000000     3.000000\n"
         "   12.500000    -7.250000-1.000000\n"
         "    0.500000      1.000000     0.250000\n";
}

std::string csmip_1_text(const std::string& title, const std::string& unit_line, const std::string& samples) {
  std::string text = "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/16/98, CDMG 23583\n";
  text += "SOME EARTHQUAKE\nJUNE 28, 1992 08:05 PDT\n23583-E0245-92183.06   TRIGGER TIME: 06/28/92\n";
  text +=
      "STATION NO. 23583   34.405N, 117.311W     SSA-1  S/N 0245\nHESPERIA - 4TH & PALM\nCHAN  1:  90 DEG\n";
  text += "SOME EARTHQUAKE     JUNE 28, 1992 08:05 PDT\nHYPOCENTER: 34.201N,116.826W, H=7KM.\n";
  text += "INSTR PERIOD =  .0186 SEC,  DAMPING =  .660,  SENSITIVITY = 1.26  V/G.\n";
  text += "NO. OF POINTS =  6  RECORD LENGTH = .025 SEC   AT 200 SAMPLES/SEC\n";
  text += unit_line + "\nRMS ACCEL OF COMPLETE RECORD =  .008 G.\n";
  std::string integers = columns_of(100, "0", 5, 16);
  const std::size_t points = integers.find('\n') + 1 + 11 * 5;  // value 28
  integers.replace(points, 5, "    6");
  return text + integers + columns_of(50, ".000", 10, 8) + title + samples +
         "/&  ----------  END OF DATA FOR CHANNEL  1  ----------\n";
}

std::string csmip_1_pairs() {
  return csmip_1_text(
      "", "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  =  -.200 G, AT  .011 SEC.",
      "   .000  -.006   .005   .007   .011 -2.000   .015   .006   .020   .006\n   .025  -.009\n");
}

std::vector<NamedText> motion_corpus() {
  std::vector<NamedText> corpus{
      {"at2", at2_text()},
      {"cosmos", cosmos_text()},
      {"knet", knet_text("E-W")},
      {"kiknet", knet_text("3")},
      {"esm", esm_text()},
      {"geonet V1A", geonet_text(false)},
      {"geonet V2A", geonet_text(true)},
      {"afad", afad_text()},
      {"cwa", cwa_text()},
      {"usc", usc_text()},
      {"bhrc", bhrc_text()},
      {"unam", unam_text()},
      {"counted", "A record in m/s2\n6 0.01\n0.5\n-1\n0.25\n0\n1\n2\n"},
      {"csmip V1 pairs", csmip_1_pairs()},
      {"csmip V1",
       csmip_1_text(" 6 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)\n",
                    "Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.",
                    "  .000010  .000010 -.079007 -.000002  .000009  .000007\n")},
      {"table", "time (s);N-S (cm/s2);U-D (cm/s2)\n0,00;1,5;2\n0,01;-2,5;3\n0,02;0,5;-1\n"}};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(motion_data)) {
    if (entry.is_regular_file() && entry.path().extension() != ".md") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) corpus.push_back({file.filename().string(), file_content(file)});
  return corpus;
}

}  // namespace keyblock::loading
