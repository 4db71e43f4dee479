#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "geometry/polygon.h"
#include "shapes.h"

namespace keyblock {
namespace {

// Triangles of positive area whose sum is that of the polygon, none with its middle outside.
void expect_covered(const Polygon& polygon, double tolerance) {
  double sum = 0.0;
  for (const auto& t : triangulate(polygon)) {
    const double a = signed_area(t);
    EXPECT_GT(a, 0.0);
    EXPECT_TRUE(contains(polygon, (t[0] + t[1] + t[2]) / 3.0));
    sum += a;
  }
  EXPECT_NEAR(sum, area(polygon), tolerance);
}

TEST(Triangulate, CoversExactly) {
  for (const Polygon& polygon : {frame, l_shape}) expect_covered(polygon, 1e-14);
  EXPECT_THROW(triangulate({{{0, 0}, {1, 1}}, {}}), std::invalid_argument);
}

// Both holes are joined to the vertex on the right, of which there are then two copies: one above, one below the bridge.
TEST(Triangulate, TwoHolesSeeTheSameVertex) {
  for (const double y : {-0.6, 0.6}) {
    Polygon polygon{{{-3, -1.2}, {0, -1.2}, {2, 0}, {0, 1.2}, {-3, 1.2}},
                    {{{-1, -0.1}, {1, 0}, {-1, 0.1}}, {{-1.2, y - 0.1}, {0.2, y}, {-1.2, y + 0.1}}}};
    orient(polygon);
    ASSERT_FALSE(self_intersects(polygon));
    expect_covered(polygon, 1e-14);
  }
}

TEST(Triangulate, HoleThatTouchesTheOuterRing) {
  // With its rightmost vertex, and with another one.
  expect_covered({{{0, 0}, {4, 0}, {4, 1}, {4, 3}, {0, 3}}, {{{4, 1}, {2, 1}, {2, 2}}}}, 1e-14);
  expect_covered({{{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 1}}, {{{0, 1}, {2, 2}, {2, 1}}}}, 1e-14);
}

TEST(Triangulate, HolesThatTouchEachOther) {
  expect_covered({{{0, 0}, {6, 0}, {6, 4}, {0, 4}},
                  {{{1, 1}, {1, 2}, {3, 2}}, {{3, 2}, {5, 3}, {5, 2}}, {{3, 2}, {3, 1}, {2, 0.5}}}},
                 1e-14);
}

TEST(Triangulate, HoleThatCrossesItsOuterRing) {
  EXPECT_THROW(triangulate({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{{1, 1}, {1, 3}, {1.5, 1}}}}),
               std::invalid_argument);
}

using Node = std::array<int, 2>;

// Cells of a square grid, each but the first beside one before it.
std::set<Node> grown_cells(int width, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::vector<Node> cells{{width / 2, width / 2}};
  std::set<Node> known(cells.begin(), cells.end());
  const std::size_t wanted = 4 + below(static_cast<std::size_t>(width * width * 3 / 4));
  for (int attempt = 0; attempt < 2000 && cells.size() < wanted; ++attempt) {
    constexpr std::array<Node, 4> ways{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    const Node from = cells[below(cells.size())], way = ways[below(4)];
    const Node cell{from[0] + way[0], from[1] + way[1]};
    if (std::min(cell[0], cell[1]) < 0 || std::max(cell[0], cell[1]) >= width) continue;
    if (known.insert(cell).second) cells.push_back(cell);
  }
  return known;
}

// Rings around the cells, which are on the left. A ring ends where it comes to a node for the second time.
std::vector<std::vector<Node>> rings_around(const std::set<Node>& cells, std::mt19937& random) {
  std::map<Node, std::vector<Node>> edges;
  for (const auto& [i, j] : cells) {
    const std::array<Node, 4> corners{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
    const std::array<Node, 4> beside{{{i, j - 1}, {i + 1, j}, {i, j + 1}, {i - 1, j}}};
    for (std::size_t k = 0; k < 4; ++k)
      if (cells.count(beside[k]) == 0) edges[corners[k]].push_back(corners[(k + 1) % 4]);
  }
  std::vector<std::vector<Node>> rings;
  for (auto& [start, ends] : edges) {
    std::vector<Node> path;
    while (!path.empty() || !ends.empty()) {
      if (path.empty()) path.push_back(start);
      std::vector<Node>& next = edges[path.back()];
      const auto chosen = next.begin() + static_cast<std::ptrdiff_t>(random() % next.size());
      const Node node = *chosen;
      next.erase(chosen);
      const auto before = std::find(path.begin(), path.end(), node);
      if (before == path.end()) {
        path.push_back(node);
        continue;
      }
      rings.emplace_back(before, path.end());
      path.erase(before == path.begin() ? before : before + 1, path.end());
    }
  }
  return rings;
}

// Grids that are not bent have many collinear vertices.
TEST(Triangulate, RandomPolygonsWhoseHolesTouch) {
  std::mt19937 random(7);
  const auto shift = [&] { return 0.6 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  int polygons = 0, touching = 0;
  while (polygons < 500) {
    const std::set<Node> cells = grown_cells(3 + static_cast<int>(random() % 6), random);
    const bool bent = random() % 4 != 0;
    std::map<Node, Vec2> points;
    Polygon polygon;
    std::size_t outer_rings = 0, vertices = 0;
    for (const std::vector<Node>& nodes : rings_around(cells, random)) {
      Ring ring;
      for (const Node& node : nodes) {
        const Vec2 moved =
            bent ? Vec2{node[0] + shift(), node[1] + shift()} : Vec2{1.0 * node[0], 1.0 * node[1]};
        ring.push_back(points.emplace(node, moved).first->second);
      }
      vertices += ring.size();
      if (signed_area(ring) > 0.0) {
        polygon.outer = ring;
        ++outer_rings;
      } else {
        polygon.holes.push_back(ring);
      }
    }
    if (outer_rings != 1 || polygon.holes.empty()) continue;
    ++polygons;
    touching += points.size() < vertices ? 1 : 0;
    expect_covered(polygon, 1e-12);
    ASSERT_FALSE(HasFailure()) << polygons;
  }
  EXPECT_GT(touching, 250);
}

}  // namespace
}  // namespace keyblock
