#include "cutting/topology.h"

#include <gtest/gtest.h>

#include <fstream>

#include "check_blocks.h"
#include "core/checked_json.h"
#include "rockmass/trace_map.h"

namespace keyblock::cutting {
namespace {

TEST(Topology, PublishedCountsOfKb11) {
  const std::string folder = KEYBLOCK_SOURCE_DIR "/examples/traces/";
  std::ifstream file(folder + "KB11_area.geojson");
  const auto area_map = nlohmann::json::parse(file);
  Ring outline;
  for (const auto& p : area_map["features"][0]["geometry"]["coordinates"][0]) outline.push_back({p[0], p[1]});
  const NodeCounts counts =
      count_nodes(rockmass::read_trace_map(folder + "KB11_traces_100.geojson", 0), outline, 0.001);
  EXPECT_EQ(counts.isolated, 64);
  EXPECT_EQ(counts.crossing, 37);
  EXPECT_EQ(counts.abutting, 108);
  EXPECT_EQ(counts.boundary, 28);
  EXPECT_EQ(counts.branches, 268);
  EXPECT_NEAR(counts.length / 1237.9, 0.23, 0.005);
}

TEST(Topology, NodesOfEveryKind) {
  // A crossing (X), an abutment a little short of the line (Y), two cut off by the edge (E), the rest ends (I).
  const NodeCounts counts = count_nodes(
      {{{-1, 5}, {8, 5}, {}}, {{4, 2}, {4, 8}, {}}, {{6, 9}, {6, 5.0005}, {}}, {{2, 1}, {2, 0}, {}}}, square,
      0.001);
  EXPECT_EQ(counts.isolated, 5);
  EXPECT_EQ(counts.crossing, 1);
  EXPECT_EQ(counts.abutting, 1);
  EXPECT_EQ(counts.boundary, 2);
  EXPECT_EQ(counts.branches, 6);
  EXPECT_NEAR(counts.length, 8.0 + 6.0 + 4.0 + 1.0, 1e-9);
}

TEST(Topology, PiecesOfOneTraceMeetInNoNode) {
  const NodeCounts counts = count_nodes({{{1, 1}, {2, 2}, {}}, {{2, 2}, {3, 1}, {}}}, square, 0.001);
  EXPECT_EQ(counts.isolated, 2);
  EXPECT_EQ(counts.crossing + counts.abutting + counts.boundary, 0);
  EXPECT_EQ(counts.branches, 1);
}

}  // namespace
}  // namespace keyblock::cutting
