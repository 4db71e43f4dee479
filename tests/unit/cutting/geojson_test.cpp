#include "cutting/geojson.h"

#include <gtest/gtest.h>

#include "core/checked_json.h"
#include "cutting/cut.h"
#include "cutting/picture.h"
#include "tunnel.h"

namespace keyblock::cutting {
namespace {

TEST(GeoJson, HoldsEveryBlockInRealCoordinates) {
  CutInput input = paper_tunnel(0);
  const Vec2 far{466016.0, 6691584.0};
  for (rockmass::Trace& t : input.traces) {
    t.a += far;
    t.b += far;
  }
  for (Vec2& p : input.domain) p += far;
  for (Vec2& p : input.excavations[0]) p += far;
  const BlockSystem system = cut(input);
  const auto json = nlohmann::json::parse(to_geojson(system));
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), system.blocks.size());
  for (std::size_t k = 0; k < system.blocks.size(); ++k) {
    const CutBlock& block = system.blocks[k];
    const auto& feature = json["features"][k];
    EXPECT_EQ(feature["properties"]["id"], k);
    EXPECT_EQ(feature["properties"]["area"].get<double>(), area(block.polygon));
    EXPECT_EQ(feature["properties"]["excavations"].size(), block.excavations.size());
    const auto& rings = feature["geometry"]["coordinates"];
    ASSERT_EQ(rings.size(), block.polygon.ring_count());
    for (std::size_t r = 0; r < rings.size(); ++r) {
      EXPECT_EQ(rings[r].front(), rings[r].back());
      ASSERT_EQ(rings[r].size(), block.polygon.ring(r).size() + 1);
      ASSERT_EQ(feature["properties"]["edges"][r].size(), block.polygon.ring(r).size());
      const Vec2 p = block.polygon.ring(r)[1] + system.origin;
      EXPECT_EQ(rings[r][1][0].get<double>(), p.x);
      EXPECT_EQ(rings[r][1][1].get<double>(), p.y);
      EXPECT_EQ(feature["properties"]["edges"][r][0][0], name_of(block.labels[r][0].kind));
      EXPECT_EQ(feature["properties"]["edges"][r][0][1], block.labels[r][0].index);
    }
  }
}

TEST(Picture, NamesWhatItShows) {
  const CutInput input = paper_tunnel(0);
  const std::string svg =
      draw_svg(cut(input), input.traces, input.excavations, {{"J1 <steep>"}, {}, {"tunnel"}});
  EXPECT_EQ(svg.rfind("<svg ", 0), 0u);
  EXPECT_NE(svg.find("J1 &lt;steep&gt;"), std::string::npos);
  EXPECT_NE(svg.find("joint set 3"), std::string::npos);
  EXPECT_NE(svg.find("tunnel"), std::string::npos);
  EXPECT_NE(svg.find("2 m"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST(Picture, AnEmptySystemIsDrawnToo) {
  EXPECT_NE(draw_svg({}, {}, {}).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace keyblock::cutting
