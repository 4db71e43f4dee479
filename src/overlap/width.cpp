#include "overlap/width.h"

#include <algorithm>
#include <cmath>

namespace keyblock::overlap {
namespace {

bool lexicographic(Vec2 a, Vec2 b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

bool is_convex(std::span<const Vec2> ring) {
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()], c = ring[(k + 2) % ring.size()];
    if (cross(b - a, c - b) < 0.0) return false;
  }
  return true;
}

// Joins two rings along the edge from a[i] to a[i + 1], which b runs through the other way. Empty when they share no
// edge.
Ring joined(const Ring& a, const Ring& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2 from = a[i], to = a[(i + 1) % a.size()];
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (b[j] != to || b[(j + 1) % b.size()] != from) continue;
      Ring ring;
      for (std::size_t k = 1; k <= a.size(); ++k) ring.push_back(a[(i + k) % a.size()]);
      for (std::size_t k = 2; k < b.size(); ++k) ring.push_back(b[(j + k) % b.size()]);
      return ring;
    }
  }
  return {};
}

struct Shadow {
  double min = HUGE_VAL, max = -HUGE_VAL;
};

Shadow shadow(std::span<const Vec2> ring, Vec2 normal, Vec2 origin) {
  Shadow s;
  for (const Vec2 p : ring) {
    const double along = dot(normal, p - origin);
    s.min = std::min(s.min, along);
    s.max = std::max(s.max, along);
  }
  return s;
}

}  // namespace

Ring convex_hull(std::span<const Vec2> points) {
  Ring sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), lexicographic);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (sorted.size() < 3) return sorted;
  Ring hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();  // the last point begins the other chain
  };
  add_chain(sorted.begin(), sorted.end());
  add_chain(sorted.rbegin(), sorted.rend());
  return hull;
}

double convex_width(std::span<const Vec2> ring) {
  if (ring.size() < 3) return 0.0;
  double width = HUGE_VAL;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 edge = ring[(k + 1) % ring.size()] - ring[k];
    if (edge == Vec2{}) continue;
    const Vec2 normal = perpendicular(normalized(edge));
    const Shadow s = shadow(ring, normal, ring[k]);
    width = std::min(width, s.max - s.min);
  }
  return std::isfinite(width) ? width : 0.0;
}

std::vector<Ring> convex_parts(const Polygon& polygon) {
  std::vector<Ring> parts;
  for (const auto& triangle : triangulate(polygon)) parts.emplace_back(triangle.begin(), triangle.end());
  for (std::size_t a = 0; a < parts.size(); ++a) {
    for (std::size_t b = a + 1; b < parts.size();) {
      Ring both = joined(parts[a], parts[b]);
      if (both.empty() || !is_convex(both)) {
        ++b;
        continue;
      }
      parts[a] = std::move(both);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(b));
      b = a + 1;  // the larger part may have come to touch one passed over before
    }
  }
  return parts;
}

double hull_penetration(std::span<const Vec2> a, std::span<const Vec2> b) {
  double least = HUGE_VAL;
  for (int turn = 0; turn < 2; ++turn) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Vec2 edge = a[(k + 1) % a.size()] - a[k];
      if (edge == Vec2{}) continue;
      const Vec2 normal = perpendicular(normalized(edge));
      const Shadow s = shadow(a, normal, a[k]), t = shadow(b, normal, a[k]);
      least = std::min(least, std::min(s.max, t.max) - std::max(s.min, t.min));
      if (least <= 0.0) return least;
    }
    std::swap(a, b);
  }
  return least;
}

}  // namespace keyblock::overlap
