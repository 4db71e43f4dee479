#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/error.h"
#include "rockmass/trace_map.h"

namespace keyblock::rockmass {
namespace {

using namespace std::string_literals;
using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path samples = KEYBLOCK_SOURCE_DIR "/tests/data/lines";

/// Two traces that cross, in all formats.
const std::vector<std::pair<Vec2, Vec2>> cross{{{0, 5}, {10, 5}}, {{5, 0}, {6, 10}}};

std::vector<std::pair<Vec2, Vec2>> ends(const std::vector<Trace>& traces) {
  std::vector<std::pair<Vec2, Vec2>> out;
  for (const Trace& trace : traces) out.emplace_back(trace.a, trace.b);
  return out;
}

class TraceMapFormats : public testing::Test {
 protected:
  std::vector<Trace> read(const std::string& content) {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("keyblock_") + info->name() + std::to_string(::getpid()) + ".map");
    std::ofstream(path_, std::ios::binary) << content;
    return read_trace_map(path_, 0);
  }
  void TearDown() override {
    if (!path_.empty()) std::filesystem::remove(path_);
  }
  /// The only mistake.
  Diagnostic mistake(const std::string& content) {
    try {
      read(content);
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().size(), 1U) << error.what();
      return error.diagnostics().front();
    }
    ADD_FAILURE() << "no mistake in " << content;
    return {};
  }

 private:
  std::filesystem::path path_;
};

TEST_F(TraceMapFormats, TablesOfTwoEnds) {
  struct Case {
    const char *header, *before, *after;
    char parting;
  };
  for (const Case& c :
       {Case{"x1,y1,x2,y2", "", "", ','}, Case{"FID,START_X,START_Y,END_X,END_Y", "3,", "", ','},
        Case{"id,x1,y1,x2,y2,set", "3,", ",1", ','}, Case{"X_Start;Y_Start;X_End;Y_End;Len", "", ";7", ';'},
        Case{"set\tFromX\tFromY\tToX\tToY", "J1\t", "", '\t'}, Case{"id,x,y,x,y", "3,", "", ','},
        Case{"no,xa,ya,xb,yb", "3,", "", ','}, Case{"E1,N1,E2,N2", "", "", ','},
        Case{"x0,y0,x1,y1", "", "", ','}, Case{"id;x1 (m);y1 (m);x2 (m);y2 (m)", "a;", "", ';'}}) {
    std::string text = std::string(c.header) + "\n";
    for (const auto& [a, b] : cross) {
      std::string row = fmt::format("{0},{1},{2},{3}", a.x, a.y, b.x, b.y);
      std::replace(row.begin(), row.end(), ',', c.parting);
      text += c.before + row + c.after + "\n";
    }
    EXPECT_EQ(ends(read(text)), cross) << c.header;
  }
  EXPECT_THAT(mistake("id,x1,y1,x2,y2\n1,0,0,5\n").found, HasSubstr("4 cells"));
  EXPECT_THAT(mistake("x1,y1,x2,y2,x1\n0,0,5,1,3\n").found, HasSubstr("the column again"));
  EXPECT_THAT(mistake("id,x1,y1,x2,y2\n1,0,0,five,1\n").found, HasSubstr("five"));
}

TEST_F(TraceMapFormats, RowsThatBeginWithTheirNumberAreRefused) {
  EXPECT_THAT(mistake("1,0,5,10,5,1\n2,3,0,3,10,2\n").expected, HasSubstr("names of the columns"));
  EXPECT_THROW(read("1,0,5,10,5\n2,3,0,3,10\n"), InputError);
  EXPECT_EQ(read("0,5,10,5\n3,0,3,10\n").size(), 2U);
}

TEST_F(TraceMapFormats, TablesOfSpreadsheets) {
  EXPECT_EQ(ends(read_trace_map(samples / "tabs.csv", 0)), cross);
  EXPECT_EQ(ends(read_trace_map(samples / "capitals.csv", 0)), cross);
  EXPECT_EQ(ends(read("trace x  y\n1 0 5\n 1\t10 5\n2 5 0\n2 6 10\n")), cross);
  EXPECT_EQ(ends(read("# of an outcrop\nTRACE;Y;X\ra;5,0;0\ra;5;10,0\rb;0;5\rb;10;6\r")), cross);
}

TEST_F(TraceMapFormats, ATraceInEachLine) {
  for (const char* text :
       {"0 5 10 5\n5 0 6 10\n", "0.0\t5.0\t10.0\t5.0\t\n5.0\t0.0\t6.0\t10.0\n", "0,5,10,5\r\n5,0,6,10\r\n",
        "0,0;5,0;10,0;5,0\n5,0;0,0;6,0;10,0\n", "X1,Y1,X2,Y2\n0,5,10,5\n5,0,6,10\n"})
    EXPECT_EQ(ends(read(text)), cross) << text;
  const auto curved = read("0 0 1 0 2 1\n5 5 6 6\n");
  ASSERT_EQ(curved.size(), 3U);
  EXPECT_EQ(trace_numbers(curved), (std::vector<int>{0, 0, 1}));
}

TEST_F(TraceMapFormats, LinesThatAreNoPairs) {
  const Diagnostic odd = mistake("0 5 10 5\n5 0 6\n");
  EXPECT_EQ(odd.where.line, 2);
  EXPECT_EQ(odd.found, "3 cells");
  EXPECT_EQ(mistake("0 5 10 5\n5 0 6 north\n").found, "\"north\"");
}

// Rows `number x y z` would be lines from (1, x) to (y, z).
TEST_F(TraceMapFormats, RowsOfNumberedVerticesWithoutAHeader) {
  const std::string rows = "1 0.5 5 0\n1 10 5 0\n2 5 0 0\n2 6 10 0\n";
  const Diagnostic found = mistake(rows);
  EXPECT_THAT(found.found, HasSubstr("number of their trace"));
  EXPECT_THAT(found.hint, HasSubstr("x1 y1 x2 y2"));
  EXPECT_EQ(read("x1 y1 x2 y2\n" + rows).size(), 4U);
  // A grid of lines is none.
  EXPECT_EQ(read("0 0 0 10\n1 0 1 10\n2 0 2 10\n0 0 2 0\n").size(), 4U);
  EXPECT_EQ(read("0 0 10 0\n0 1 10 1\n0 2 10 2\n").size(), 3U);
}

TEST_F(TraceMapFormats, WellKnownText) {
  EXPECT_EQ(ends(read("LINESTRING (0 5, 10 5)\nlinestring z(5 0 7,6 10 7)\n")), cross);
  EXPECT_EQ(
      ends(read("GEOMETRYCOLLECTION(MULTILINESTRING M ((0 5 1, 10 5 1),(5 0 1, 6 10 1)), LINESTRING EMPTY)")),
      cross);
  EXPECT_EQ(ends(read("SRID=25833;LINESTRINGZ(0 5 1,10 5 1);\nLINESTRING(5 0,6 10)")), cross);
  EXPECT_EQ(ends(read("wkt_geom\tid\nLineString (0 5, 10 5)\t1\nLineString (5 0, 6 10)\t2\n")), cross);
  EXPECT_EQ(ends(read("id,WKT\n1,\"MULTILINESTRING ((0 5,10 5),(5 0,6 10))\"\n2,\n")), cross);
}

TEST_F(TraceMapFormats, WellKnownTextSaysWhereItsMistakeIs) {
  const auto place = [](const Diagnostic& d) { return std::pair(d.where.line, d.where.column); };
  const Diagnostic area = mistake("LINESTRING (0 0, 1 1)\n POLYGON ((0 0, 1 0, 0 0))");
  EXPECT_EQ(area.found, "\"POLYGON\"");
  EXPECT_EQ(place(area), std::pair(2, 2));
  EXPECT_EQ(place(mistake("LINESTRING (0 5, 10)")), std::pair(1, 17));
  EXPECT_EQ(mistake("LINESTRING (0 5, 10 nan)").expected, "x y, two finite numbers");
  EXPECT_EQ(mistake("LINESTRING (0 5, 10 5").found, "the end of the text");
  EXPECT_EQ(mistake("LINESTRING (0 5, 0 5)").found, "a trace of 2 equal vertices");
  EXPECT_EQ(mistake("POINT (0 5)").expected, "LINESTRING or MULTILINESTRING");
  const Diagnostic cell = mistake("id,wkt\n7,\"LINESTRING (0 5)\"\n");
  EXPECT_EQ(cell.found, "a trace of one vertex");
  EXPECT_EQ(cell.where.line, 2);
  std::string deep;
  for (int k = 0; k < 100000; ++k) deep += "GEOMETRYCOLLECTION(";
  EXPECT_EQ(mistake(deep).found, "\"GEOMETRYCOLLECTION\"");
}

TEST_F(TraceMapFormats, FilesOfOtherKindsAreNamed) {
  const std::pair<std::string, const char*> files[] = {
      {"SQLite format 3\0"s, "GeoPackage"},
      {"AutoCAD Binary DXF\r\n\x1a\0"s, "binary DXF"},
      {"AC1032\0\0"s, "DWG"},
      {"PK\x03\x04\x14\0"s, "ZIP"},
      {"<?xml version=\"1.0\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\"/>", "KML"},
      {"<gpx version=\"1.1\"/>", "GPX"},
      {"<svg width=\"1\"/>", "SVG"},
      {"<a/>", "XML"},
      {"PROJCS[\"ETRS89 / UTM 33\"]", ".prj"},
      {"\xFF\xFEt\0r\0"s, "UTF-16"},
      {"\x03\x05\0\0\0abc"s, "no text"}};
  for (const auto& [content, name] : files) {
    const Diagnostic found = mistake(content);
    EXPECT_THAT(found.found, HasSubstr(name));
    EXPECT_EQ(
        found.expected,
        "a drawing (ASCII DXF), a shapefile (.shp), GeoJSON, WKT, or a table with the columns trace, x, y");
    EXPECT_FALSE(found.hint.empty()) << name;
  }
}

TEST_F(TraceMapFormats, DrawingsAreReadAndPlaced) {
  const std::vector<std::pair<Vec2, Vec2>> pieces{{{0, 5}, {10, 5}}, {{5, 0}, {5, 5}}, {{5, 5}, {6, 10}}};
  EXPECT_EQ(ends(read_trace_map(samples / "lines.dxf", 0)), pieces);
  const MapChoice turned{{"joints"}, {2.0, {10.0, 5.0}, 90.0}};
  const std::vector<Trace> traces = read_trace_map(samples / "lines.dxf", 0, nullptr, turned);
  ASSERT_EQ(traces.size(), 3U);
  EXPECT_LT(norm(traces[0].a - Vec2{0.0, -20.0}), 1e-12);
  EXPECT_LT(norm(traces[2].b - Vec2{-10.0, -8.0}), 1e-12);
  EXPECT_THROW(read_trace_map(samples / "tabs.csv", 0, nullptr, {{"joints"}, {}}), InputError);
}

TEST_F(TraceMapFormats, ADegenerateEntityHasItsLineAndLayer) {
  const Diagnostic found =
      mistake("0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nJ 1\n10\n5\n20\n5\n11\n5\n21\n5\n0\nENDSEC\n0\nEOF\n");
  EXPECT_EQ(found.where.line, 6);
  EXPECT_EQ(found.key, "LINE on layer J 1");
  EXPECT_EQ(found.found, "a trace of one vertex");
}

TEST_F(TraceMapFormats, DegreesAreRefused) {
  try {
    read_trace_map(samples / "degrees.geojson", 0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("crs.properties.name"), HasSubstr("CRS84), in degrees"),
                                    HasSubstr("-t_srs EPSG:32633")));
  }
  const std::string line = R"("coordinates":[[26.3,60.3],[27.3,61.3]]})";
  for (const char* name :
       {"EPSG:4326", "urn:ogc:def:crs:EPSG::4258", "EPSG:6668", "WGS 84", "urn:ogc:def:crs:OGC::CRS83"}) {
    const std::string crs =
        R"({"type":"LineString","crs":{"properties":{"name":")" + std::string(name) + "\"}},";
    EXPECT_THAT(mistake(crs + line).found, HasSubstr(name));
  }
  EXPECT_THAT(mistake(R"({"type":"LineString","crs":{"properties":{"code":4326}},)" + line).found,
              HasSubstr("EPSG:4326"));
  EXPECT_THAT(mistake("SRID=4326;LINESTRING (26 60, 27 61)").found, HasSubstr("degrees"));
  EXPECT_THAT(mistake("trace,Lon,Lat\n1,26,60\n1,27,61\n").found, HasSubstr("degrees"));
  // By their place alone: some hundred metres at 26° E, 60° N.
  EXPECT_THAT(mistake("trace,x,y\n1,26.39,60.355\n1,26.391,60.3555\n").found,
              HasSubstr("seem to be degrees"));
}

TEST_F(TraceMapFormats, MetresAreNotTakenForDegrees) {
  const std::string line = R"("coordinates":[[466000,6691600],[466001,6691602]]})";
  for (const char* name : {"urn:ogc:def:crs:EPSG::3067", "EPSG:4326", "EPSG:4839", "LOCAL_CS 4326"}) {
    const std::string crs =
        R"({"type":"LineString","crs":{"properties":{"name":")" + std::string(name) + "\"}},";
    EXPECT_EQ(read(crs + line).size(), 1U) << name;
  }
  EXPECT_EQ(read("trace,x,y\n1,0,0\n1,0.02,0.01\n").size(), 1U);        // a specimen
  EXPECT_EQ(read("trace,x,y\n1,40,-20\n1,44,-21\n").size(), 1U);        // a section
  EXPECT_EQ(read("trace,x,y\n1,900,60\n1,900.01,60.01\n").size(), 1U);  // far beyond any degrees
}

TEST_F(TraceMapFormats, PointsAreOneTrace) {
  const auto traces = traces_of({{{0, 0}, {1, 0}, {1, 0}, {2, 1}}}, 3);
  ASSERT_EQ(traces.size(), 2U);
  EXPECT_EQ(traces[1].b, (Vec2{2, 1}));
  EXPECT_EQ(traces[0].source, (TraceSource{TraceSource::Kind::trace_map, 3}));
  EXPECT_EQ(trace_numbers(traces), (std::vector<int>{0, 0}));
}

}  // namespace
}  // namespace keyblock::rockmass
