#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.h"
#include "core/read_file.h"
#include "drawing/curves.h"
#include "drawing/drawing.h"
#include "geometry/polygon.h"

namespace keyblock::drawing {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path drawings = KEYBLOCK_TEST_DATA "/drawings";

Drawing read(const char* name) {
  return read_drawing(read_file(drawings / name), name);
}

double distance(Vec2 p, Vec2 a, Vec2 b) {
  const double length = squared_norm(b - a);
  const double share = length > 0.0 ? std::clamp(dot(p - a, b - a) / length, 0.0, 1.0) : 0.0;
  return norm(p - lerp(a, b, share));
}

/// Largest distance of a vertex of the one from the other.
double deviation(const std::vector<Vec2>& of, const std::vector<Vec2>& from) {
  double largest = 0.0;
  for (const Vec2 p : of) {
    double nearest = HUGE_VAL;
    for (std::size_t k = 0; k + 1 < from.size(); ++k)
      nearest = std::min(nearest, distance(p, from[k], from[k + 1]));
    largest = std::max(largest, nearest);
  }
  return largest;
}

std::vector<Vec2> course(const DrawnLine& line) {
  std::vector<Vec2> vertices = line.vertices;
  if (line.closed) vertices.push_back(vertices.front());
  return vertices;
}

/// A drawing of these entities: pairs `code value`, one a line.
std::string with_entities(const std::string& pairs, const std::string& header = "") {
  std::string text = "0\nSECTION\n2\nHEADER\n" + header + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  for (const char c : pairs) text += c == ' ' ? '\n' : c;
  return text + "0\nENDSEC\n0\nEOF\n";
}

Diagnostic mistake(const std::string& text) {
  try {
    read_drawing(text, "a.dxf");
  } catch (const InputError& error) {
    return error.diagnostics().front();
  }
  ADD_FAILURE() << "no mistake";
  return {};
}

// The oracle is ezdxf, which wrote the drawing: its own flattening to 0.05 mm of what it reads (data/drawings/make.py).
TEST(Dxf, EveryKindOfLineLiesWhereEzdxfHasIt) {
  const Drawing drawing = read("entities.dxf");
  EXPECT_EQ(drawing.unit, 0.001);
  const auto right = nlohmann::json::parse(read_file(drawings / "entities.json")).at("lines");
  ASSERT_EQ(drawing.lines.size(), right.size());
  for (std::size_t k = 0; k < right.size(); ++k) {
    const DrawnLine& line = drawing.lines[k];
    SCOPED_TRACE(fmt::format("{} of line {}", line.entity, line.line));
    std::vector<Vec2> vertices;
    Box box;
    for (const auto& p : right[k].at("vertices")) {
      vertices.push_back({p[0].get<double>(), p[1].get<double>()});
      box.add(vertices.back());
    }
    if (const auto layer = right[k].at("layer").get<std::string>(); layer != "0") {
      EXPECT_EQ(line.layer, layer);
    }
    // Bezier curves, which ezdxf makes of bulges, are off by 3e-4 of the radius.
    const double flattening = 0.06 + (line.entity.ends_with("POLYLINE") ? 1.5e-4 * norm(box.size()) : 0.0);
    const double chords = 0.5 * (1.0 - std::cos(chord_angle * std::numbers::pi / 360.0));
    EXPECT_LT(deviation(course(line), vertices), flattening);
    EXPECT_LT(deviation(vertices, course(line)), flattening + 2.0 * chords * norm(box.size()));
  }
}

TEST(Dxf, WhatIsOnLayerNoughtOfABlockTakesTheLayerOfItsReference) {
  const Drawing drawing = read("entities.dxf");
  EXPECT_THAT(drawing.layers, ElementsAre("FACE", "Arcs", "SPLINES", "STONES"));
  EXPECT_EQ(lines_on(drawing, {"stones"}).size(), 16U);
  EXPECT_EQ(lines_on(drawing, {"FACE", "arcs"}).size(), 4U + 5U + 2U);
}

TEST(Dxf, WhatIsSkippedIsNamed) {
  const Drawing drawing = read("entities.dxf");
  EXPECT_EQ(skipped_words(drawing, {}).find("1 SPLINE by fit points alone on layer SPLINES (line "), 0U);
  EXPECT_THAT(skipped_words(drawing, {}), HasSubstr("3 TEXT on layer NOTES (line "));
  EXPECT_THAT(skipped_words(drawing, {"face"}), HasSubstr("1 POINT on layer FACE"));
  EXPECT_EQ(skipped_words(drawing, {"Arcs"}), "");
}

TEST(Dxf, AreasOfBulgesAndCircles) {
  // A lens of two arcs of radius 1 over a chord of √2: each a quarter of a circle, its segment π/4 − 1/2.
  const double bulge = std::tan(std::numbers::pi / 8.0);
  const Drawing lens =
      read_drawing(with_entities(fmt::format("0 LWPOLYLINE 8 A 70 1 10 0 20 0 42 {0} 10 {1} 20 0 42 {0} ",
                                             bulge, std::sqrt(2.0))),
                   "lens.dxf");
  ASSERT_EQ(lens.lines.size(), 1U);
  EXPECT_EQ(lens.lines[0].vertices.size(), 48U);
  // Of a sector with chords of φ the area is (sin φ)/φ of the true one.
  const double chord = chord_angle * std::numbers::pi / 180.0;
  const double segment = std::numbers::pi / 4.0 * std::sin(chord) / chord - 0.5;
  EXPECT_NEAR(signed_area(lens.lines[0].vertices), 2.0 * segment, 1e-12);
  const Drawing circle = read_drawing(with_entities("0 CIRCLE 8 A 10 5 20 6 40 2 "), "circle.dxf");
  EXPECT_EQ(circle.lines[0].vertices.size(), 96U);
  EXPECT_TRUE(circle.lines[0].closed);
  EXPECT_NEAR(signed_area(circle.lines[0].vertices), 4.0 * 48.0 * std::sin(chord), 1e-12);
}

TEST(Dxf, ARationalSplineIsACircle) {
  const double w = std::sqrt(0.5);
  const Spline quarter{2, {0, 0, 0, 1, 1, 1}, {{1, 0}, {1, 1}, {0, 1}}, {1.0, w, 1.0}};
  ASSERT_TRUE(quarter.is_sound());
  const std::vector<Vec2> vertices = spline_vertices(quarter);
  EXPECT_GE(vertices.size(), 9U);
  for (const Vec2 p : vertices) EXPECT_NEAR(norm(p), 1.0, 1e-14);
}

TEST(Dxf, UnitsOfTheHeader) {
  const std::string line = "0 LINE 8 A 10 0 20 0 11 12 21 0 ",
                    long_line = "0 LINE 8 A 10 0 20 0 11 12000 21 0 ";
  const auto scale = [](const std::string& text, const Placement& placement) {
    const Drawing drawing = read_drawing(text, "a.dxf");
    return scale_of(drawing, drawing.lines, placement);
  };
  EXPECT_EQ(scale(with_entities(line, "9\n$INSUNITS\n70\n2\n"), {}), 12 * 0.0254);
  EXPECT_EQ(scale(with_entities(line, "9\n$INSUNITS\n70\n2\n"), {.scale = 0.5}), 0.5);
  EXPECT_EQ(scale(with_entities(line, "9\n$INSUNITS\n70\n0\n"), {}), 1.0);
  EXPECT_EQ(scale(with_entities(long_line), {.scale = 1.0}), 1.0);
  try {
    scale(with_entities(long_line), {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("12000 by 0 units, and no unit in the drawing"));
    EXPECT_THAT(error.what(), HasSubstr("scale = 0.001 if it is in millimetres"));
  }
}

TEST(Dxf, PlacementTurnsAboutTheOrigin) {
  const Placement placement{0.001, {1000.0, 2000.0}, 90.0};
  const Vec2 p = placement({3000.0, 2000.0});
  EXPECT_NEAR(p.x, 0.0, 1e-15);
  EXPECT_NEAR(p.y, 2.0, 1e-15);
}

TEST(Dxf, MistakesHaveTheirLine) {
  const std::string good = with_entities("0 LINE 8 A 10 0 20 0 11 12 21 0 ");
  EXPECT_NO_THROW(read_drawing(good, "a.dxf"));
  EXPECT_EQ(mistake(good.substr(0, good.size() - 8)).expected, "the record EOF, with which a drawing ends");
  std::string word = good;
  word.replace(word.find("12"), 2, "1x");
  EXPECT_EQ(mistake(word).found, "\"1x\"");
  EXPECT_EQ(mistake(word).where.line, 20);
  std::string code = good;
  code.replace(code.find("\n11\n"), 4, "\nzz\n");
  EXPECT_EQ(mistake(code).expected, "a group code of DXF, a whole number");
  EXPECT_EQ(mistake(code).where.line, 19);
  EXPECT_EQ(mistake("AutoCAD Binary DXF\r\n").hint, "save it as DXF, as text (ASCII)");
  EXPECT_EQ(mistake("{}").found, "a file of another kind");
  const Drawing drawing = read_drawing(good, "a.dxf");
  try {
    lines_on(drawing, {"a", "J3"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"J3\", on which there is no line; expected layers with lines: A"));
  }
}

// A block turned by 20° within one that is stretched by 2 and −1.5 and turned by 30°: ezdxf has no sheared references.
TEST(Dxf, BlocksWithinStretchedBlocksAreSheared) {
  const std::string text =
      "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nA\n10\n10\n20\n20\n0\nLINE\n10\n10\n20\n20\n11\n210\n21\n20\n0\nEN"
      "DBLK\n0\nBLOCK\n2\nB\n"
      "0\nINSERT\n2\nA\n10\n300\n20\n0\n50\n20\n0\nENDBLK\n0\nENDSEC\n" +
      with_entities("0 INSERT 2 B 10 1000 20 8000 41 2 42 -1.5 50 30 ");
  const Drawing drawing = read_drawing(text, "a.dxf");
  ASSERT_EQ(drawing.lines.size(), 1U);
  const double c = std::cos(std::numbers::pi / 9.0), s = std::sin(std::numbers::pi / 9.0),
               root = std::sqrt(0.75);
  const double x = 2.0 * (300.0 + 200.0 * c), y = -1.5 * 200.0 * s;
  EXPECT_LT(norm(drawing.lines[0].vertices[0] - Vec2{1000.0 + root * 600.0, 8300.0}), 1e-9);
  EXPECT_LT(
      norm(drawing.lines[0].vertices[1] - Vec2{1000.0 + root * x - 0.5 * y, 8000.0 + 0.5 * x + root * y}),
      1e-9);
}

TEST(Dxf, ABlockThatHoldsItselfEnds) {
  const std::string text = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nB\n0\nINSERT\n2\nb\n0\nENDBLK\n0\nENDSEC\n" +
                           with_entities("0 INSERT 2 B ");
  EXPECT_THAT(mistake(text).found, HasSubstr("16 levels deep"));
}

// Written by Python's struct after the description of ESRI (1998): two lines, and a square clockwise.
TEST(Shapefile, LinesAndPolygons) {
  const Drawing lines = read("lines.shp");
  EXPECT_EQ(lines.unit, 1.0);
  ASSERT_EQ(lines.lines.size(), 2U);
  EXPECT_THAT(lines.lines[1].vertices, ElementsAre(Vec2{5, 0}, Vec2{5, 5}, Vec2{6, 10}));
  EXPECT_FALSE(lines.lines[1].closed);
  const Drawing square = read("polygon.shp");
  ASSERT_EQ(square.lines.size(), 1U);
  EXPECT_TRUE(square.lines[0].closed);
  EXPECT_EQ(signed_area(square.lines[0].vertices), -1.0);
  EXPECT_THROW(lines_on(square, {"A"}), InputError);
}

TEST(Shapefile, MistakesHaveTheirRecord) {
  const std::string whole = read_file(drawings / "lines.shp");
  EXPECT_EQ(mistake(whole.substr(0, 50)).found, "50 bytes");
  const Diagnostic short_record = mistake(whole.substr(0, whole.size() - 8));
  EXPECT_EQ(short_record.key, "record 1");
  EXPECT_THAT(short_record.found, HasSubstr("a record of"));
  std::string parts = whole;
  parts[100 + 8 + 36] = 100;
  EXPECT_EQ(mistake(parts).found, "100 parts of 5 points");
  std::string points = whole;
  points[100 + 8 + 4 + 0] = 1;
  EXPECT_NO_THROW(read_drawing(points, "a.shp"));  // the box is not read
  std::string kind = whole;
  kind[100 + 8] = 1;
  EXPECT_EQ(skipped_words(read_drawing(kind, "a.shp"), {}), "1 shapes that are no lines (record 1)");
}

}  // namespace
}  // namespace keyblock::drawing
