#include "rockmass/trace_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "core/error.h"

namespace keyblock::rockmass {
namespace {

class TraceMap : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& content) {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("keyblock_") + info->name() + std::to_string(::getpid()) + ".map");
    std::ofstream(path_) << content;
    return path_;
  }
  void TearDown() override {
    if (!path_.empty()) std::filesystem::remove(path_);
  }
  std::vector<Diagnostic> mistakes(const std::string& content) {
    try {
      read_trace_map(file(content), 0);
    } catch (const InputError& error) {
      return error.diagnostics();
    }
    return {};
  }

 private:
  std::filesystem::path path_;
};

TEST_F(TraceMap, PublishedMapKeepsItsDigits) {
  const auto traces = read_trace_map(KEYBLOCK_SOURCE_DIR "/examples/traces/KB11_traces_100.geojson", 4);
  ASSERT_GT(traces.size(), 900u);
  EXPECT_EQ(traces[0].a.x, 466000.282228614203632);
  EXPECT_EQ(traces[0].a.y, 6691582.099214151501656);
  EXPECT_EQ(traces[0].b, traces[1].a);
  EXPECT_EQ(traces[0].source, (TraceSource{TraceSource::Kind::trace_map, 4}));
}

TEST_F(TraceMap, CsvInAnyColumnOrder) {
  const auto traces = read_trace_map(
      file("y, note "
           ",x,trace\r\n1,a,0,\"t,1\"\r\n1,,2.5e0,\"t,1\"\r\n\r\n3,c,+2.5,\"t,1\"\n5,b,5,t2\n6,d,5,t2\n"),
      1);
  ASSERT_EQ(traces.size(), 3u);
  EXPECT_EQ(traces[0].a, (Vec2{0, 1}));
  EXPECT_EQ(traces[0].b, (Vec2{2.5, 1}));
  EXPECT_EQ(traces[1].b, (Vec2{2.5, 3}));
  EXPECT_EQ(traces[2].a, (Vec2{5, 5}));
}

TEST_F(TraceMap, CsvSaysWhereEveryMistakeIs) {
  const auto found = mistakes("trace,x,y\n2,3,4\n1,nan,1\n1, 1,1.0.0\n1,0,0\n1,5\n1,inf,0\n1,1e999,0\n");
  ASSERT_EQ(found.size(), 6u);
  const auto place = [&](std::size_t k) { return std::pair(found[k].where.line, found[k].where.column); };
  EXPECT_EQ(place(0), std::pair(3, 3));
  EXPECT_EQ(found[0].key, "x");
  EXPECT_EQ(found[0].found, "\"nan\"");
  EXPECT_EQ(place(1), std::pair(4, 6));
  EXPECT_EQ(found[1].key, "y");
  EXPECT_EQ(place(2), std::pair(6, 1));
  EXPECT_EQ(place(3), std::pair(7, 3));
  EXPECT_EQ(place(4), std::pair(8, 3));
  EXPECT_EQ(place(5), std::pair(2, 1));
  EXPECT_EQ(found[5].found, "a trace of one vertex");
}

TEST_F(TraceMap, CsvTracesStandTogether) {
  const auto found = mistakes("trace,x,y\na,0,0\na,1,0\n\nb,5,5\n a,2,0\na,3,0\nb,6,6\nc,7,7\nc,8,8\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].where.line, 6);
  EXPECT_EQ(found[0].where.column, 2);
  EXPECT_EQ(found[0].key, "trace");
  EXPECT_EQ(found[0].found, "\"a\" again, after rows of \"b\"");
  EXPECT_EQ(found[0].expected, "rows of a trace that follow each other; the one before is in line 3");
  EXPECT_EQ(found[1].where.line, 8);
  EXPECT_THAT(found[1].expected, testing::HasSubstr("line 5"));
}

TEST_F(TraceMap, CsvWithoutItsColumns) {
  const auto found = mistakes("id,x,z\n1,2,3\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].key, "trace");
  EXPECT_EQ(found[1].key, "y");
  EXPECT_EQ(mistakes("").size(), 1u);
  EXPECT_EQ(mistakes("trace,x,y\n").at(0).found, "no trace");
  EXPECT_EQ(mistakes("trace,x,y\na,1,1\na,1,1\n").at(0).found, "a trace of 2 equal vertices");
}

TEST_F(TraceMap, CsvWithMoreThanItsHeaderSays) {
  const auto found = mistakes("trace,x,y\n1,0,0\n1,1,1,junk\n1,2,2,\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].where.line, 3);
  EXPECT_EQ(found[0].where.column, 7);
  EXPECT_EQ(found[0].found, "4 cells");
  const auto twice = mistakes("trace,x,y,x\n1,0,0,1\n");
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0].key, "x");
  EXPECT_EQ(twice[0].where.column, 11);
}

// A trace of a map is one joint, of however many pieces; a generated one is a joint of its own.
TEST_F(TraceMap, PiecesOfAPolylineAreOneTrace) {
  const auto traces = read_trace_map(file("trace,x,y\na,0,0\na,1,0\na,2,1\nb,5,5\nb,6,6\nb,7,6\n"), 1);
  ASSERT_EQ(traces.size(), 4u);
  EXPECT_EQ(trace_numbers(traces), (std::vector<int>{0, 0, 1, 1}));
  const auto many = read_trace_map(KEYBLOCK_SOURCE_DIR "/examples/traces/KB11_traces_100.geojson", 0);
  EXPECT_EQ(trace_numbers(many).back(), 99);
  std::vector<Trace> several{{{0, 0}, {1, 0}, {}}, {{1, 0}, {2, 0}, {}}};
  several.insert(several.end(), traces.begin(), traces.end());
  several.push_back({{0, 0}, {1, 0}, {TraceSource::Kind::trace_map, 2}, 1});
  EXPECT_EQ(trace_numbers(several), (std::vector<int>{0, 1, 2, 2, 3, 3, 4}));
  EXPECT_EQ(trace_numbers({}), std::vector<int>{});
}

TEST_F(TraceMap, GeoJsonGeometries) {
  const auto traces = read_trace_map(file(R"( {"type": "FeatureCollection", "features": [
    {"type": "Feature", "geometry": null, "properties": {}},
    {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[0, 0, 9], [1, 0, 9], [1, 0], [1, 2]]}},
    {"type": "GeometryCollection", "geometries": [
      {"type": "MultiLineString", "coordinates": [[[5, 5], [6, 6]], [[7, 7], [8, 7]]]}]}]})"),
                                     0);
  ASSERT_EQ(traces.size(), 4u);
  EXPECT_EQ(traces[1].a, (Vec2{1, 0}));
  EXPECT_EQ(traces[1].b, (Vec2{1, 2}));
  EXPECT_EQ(traces[3].b, (Vec2{8, 7}));
  EXPECT_EQ(read_trace_map(file(R"({"type":"LineString","coordinates":[[0,0],[1,1]]})"), 0).size(), 1u);
}

TEST_F(TraceMap, GeoJsonMistakes) {
  const auto syntax = mistakes("{\"type\": \"LineString\",\n \"coordinates\": [[0, 0], [1, NaN]]}");
  ASSERT_EQ(syntax.size(), 1u);
  EXPECT_EQ(syntax[0].where.line, 2);
  EXPECT_EQ(syntax[0].where.column, 30);
  const auto several = mistakes(R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 0]}},
    {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[0, 0]]}},
    {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, null]]}},
    {"type": "Feature", "geometry": {"type": "LineString"}}, 7]})");
  ASSERT_EQ(several.size(), 5u);
  EXPECT_EQ(several[0].key, "features[0].geometry.type");
  EXPECT_EQ(several[0].found, "\"Point\"");
  EXPECT_EQ(several[1].key, "features[1].geometry.coordinates");
  EXPECT_EQ(several[2].key, "features[2].geometry.coordinates[1]");
  EXPECT_EQ(several[3].found, "null");
  EXPECT_EQ(several[4].found, "7");
  const auto place = [&](std::size_t k) { return std::pair(several[k].where.line, several[k].where.column); };
  EXPECT_EQ(place(0), std::pair(2, 46));
  EXPECT_EQ(place(1), std::pair(3, 75));
  EXPECT_EQ(place(2), std::pair(4, 84));
  EXPECT_EQ(place(3), std::pair(5, 37));  // of the geometry that lacks its coordinates
  EXPECT_EQ(place(4), std::pair(5, 62));
  EXPECT_EQ(mistakes(R"({"type":"FeatureCollection"})").at(0).found, "nothing");
  EXPECT_EQ(mistakes(R"({"type":"FeatureCollection","features":[]})").at(0).found, "no trace");
}

TEST_F(TraceMap, GeoJsonNumbersThatADoubleCannotHold) {
  const auto found = mistakes(
      "{\"type\": \"LineString\", \"note\": \"7e999 \\\" 8e999\",\n \"coordinates\": [[1e-999, 0], [-1e999, "
      "1e999]]}");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].where.line, 2);
  EXPECT_EQ(found[0].where.column, 32);
  EXPECT_EQ(found[0].found, "-1e999");
  EXPECT_EQ(found[0].expected, "a finite number");
  EXPECT_EQ(mistakes("{\"type\": " + std::string(400, '9') + "}").at(0).found, std::string(37, '9') + "...");
}

TEST_F(TraceMap, GeoJsonOfAnyDepth) {
  std::string collections, lists(1000000, '[');
  for (int k = 0; k < 200000; ++k) collections += R"({"type":"GeometryCollection","geometries":[)";
  for (const std::string& text : {collections, R"({"type":"LineString","coordinates":)" + lists}) {
    const auto found = mistakes(text);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].where.line, 1);
    EXPECT_EQ(found[0].found, "more than 32 levels of lists and objects");
  }
}

TEST_F(TraceMap, AMissingFileIsTheUsersMistake) {
  EXPECT_THROW(read_trace_map("/nowhere/map.csv", 0), InputError);
}

}  // namespace
}  // namespace keyblock::rockmass
