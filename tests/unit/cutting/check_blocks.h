#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>

#include "cutting/block_system.h"

namespace keyblock::cutting {

inline const Ring square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

inline double total_area(const BlockSystem& system) {
  double sum = 0.0;
  for (const CutBlock& block : system.blocks) sum += area(block.polygon);
  return sum;
}

/// Says what is wrong with the edges of blocks that kept all of their vertices; empty if nothing is: every edge
/// inside the domain belongs to exactly two different blocks, once in each sense and with the same label; every edge of
/// the domain to one.
inline std::string mistake_of_shared_edges(const BlockSystem& system) {
  using Key = std::tuple<double, double, double, double>;
  std::map<Key, std::pair<std::size_t, EdgeLabel>> edges;
  for (std::size_t b = 0; b < system.blocks.size(); ++b) {
    const CutBlock& block = system.blocks[b];
    if (block.labels.size() != block.polygon.ring_count()) return "a ring without labels";
    for (std::size_t r = 0; r < block.labels.size(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      if (block.labels[r].size() != ring.size()) return "an edge without a label";
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 p = ring[k], q = ring[(k + 1) % ring.size()];
        if (!edges.try_emplace({p.x, p.y, q.x, q.y}, b, block.labels[r][k]).second)
          return "an edge of two blocks";
      }
    }
  }
  for (const auto& [key, side] : edges) {
    const auto [px, py, qx, qy] = key;
    const auto place = fmt::format(" at ({}, {})-({}, {})", px, py, qx, qy);
    const auto other = edges.find({qx, qy, px, py});
    if (side.second.kind == EdgeKind::domain) {
      if (other != edges.end()) return "an edge of the domain inside of it" + place;
    } else if (other == edges.end()) {
      return "an edge of one block only" + place;
    } else if (other->second.first == side.first) {
      return "an edge with the same block on both sides" + place;
    } else if (!(other->second.second == side.second)) {
      return "an edge with two labels" + place;
    }
  }
  return {};
}

/// What holds for any result: orientation of rings, order of blocks, first vertices.
inline void expect_canonical(const BlockSystem& system) {
  Vec2 last{-HUGE_VAL, -HUGE_VAL};
  const auto below = [](Vec2 p, Vec2 q) { return p.y < q.y || (p.y == q.y && p.x < q.x); };
  for (const CutBlock& block : system.blocks) {
    const Vec2 c = centroid(block.polygon);
    EXPECT_FALSE(below(c, last));
    last = c;
    EXPECT_GT(signed_area(block.polygon.outer), 0.0);
    for (const Ring& hole : block.polygon.holes) EXPECT_LT(signed_area(hole), 0.0);
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 1; k < ring.size(); ++k) EXPECT_TRUE(below(ring[0], ring[k]));
    }
  }
}

}  // namespace keyblock::cutting
