#include "geometry/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace keyblock {

namespace {

double distance_to_boundary(const Polygon& polygon, Vec2 p) {
  double nearest = HUGE_VAL;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    const Ring& ring = polygon.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = ring[k], ab = ring[(k + 1) % ring.size()] - a;
      const double s = std::clamp(dot(p - a, ab) / squared_norm(ab), 0.0, 1.0);
      nearest = std::min(nearest, norm(p - a - s * ab));
    }
  }
  return nearest;
}

}  // namespace

double signed_area(std::span<const Vec2> ring) {
  double twice = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    // Relative to the first vertex: rings far from the origin keep their digits.
    twice += cross(ring[k] - ring[0], ring[(k + 1) % ring.size()] - ring[0]);
  }
  return 0.5 * twice;
}

double area(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) sum += signed_area(polygon.ring(r));
  return sum;
}

double perimeter(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    const Ring& ring = polygon.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k) sum += norm(ring[(k + 1) % ring.size()] - ring[k]);
  }
  return sum;
}

Vec2 centroid(const Polygon& polygon) {
  const Vec2 origin = polygon.outer.at(0);
  Vec2 moment;
  double twice_area = 0.0;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    const Ring& ring = polygon.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = ring[k] - origin;
      const Vec2 b = ring[(k + 1) % ring.size()] - origin;
      moment += cross(a, b) * (a + b);
      twice_area += cross(a, b);
    }
  }
  return origin + moment / (3.0 * twice_area);
}

Box bounds(const Polygon& polygon) {
  Box box;
  for (const Vec2 p : polygon.outer) box.add(p);
  return box;
}

bool contains(std::span<const Vec2> ring, Vec2 p) {
  bool inside = false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k];
    const Vec2 b = ring[(k + 1) % ring.size()];
    if ((a.y > p.y) != (b.y > p.y) && (cross(b - a, p - a) > 0.0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

bool contains(const Polygon& polygon, Vec2 p) {
  bool inside = contains(polygon.outer, p);
  for (const Ring& hole : polygon.holes) inside = inside != contains(hole, p);
  return inside;
}

bool lies_on_boundary(const Polygon& polygon, Vec2 p) {
  constexpr double tolerance = 1e-6;  // of the perimeter
  return distance_to_boundary(polygon, p) <= tolerance * perimeter(polygon);
}

bool lies_in(const Polygon& polygon, Vec2 p) {
  return contains(polygon, p) || lies_on_boundary(polygon, p);
}

void orient(Polygon& polygon) {
  if (signed_area(polygon.outer) < 0.0) std::reverse(polygon.outer.begin(), polygon.outer.end());
  for (Ring& hole : polygon.holes) {
    if (signed_area(hole) > 0.0) std::reverse(hole.begin(), hole.end());
  }
}

namespace {

int side(Vec2 a, Vec2 b, Vec2 p) {
  const double c = cross(b - a, p - a);
  return (c > 0.0) - (c < 0.0);
}

bool between(Vec2 a, Vec2 b, Vec2 p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const int c_side = side(a, b, c), d_side = side(a, b, d), a_side = side(c, d, a), b_side = side(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) ||
         (a_side == 0 && between(c, d, a)) || (b_side == 0 && between(c, d, b));
}

struct Edge {
  std::size_t ring, index;
  Vec2 a, b;
};

std::vector<Edge> edges_of(const Polygon& polygon) {
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    const Ring& ring = polygon.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k)
      edges.push_back({r, k, ring[k], ring[(k + 1) % ring.size()]});
  }
  return edges;
}

/// Whether two edges meet where they should not. size: of the ring of the first one.
bool interfere(const Edge& e, const Edge& f, std::size_t size) {
  const bool next = e.ring == f.ring && (e.index + 1) % size == f.index;
  const bool previous = e.ring == f.ring && (f.index + 1) % size == e.index;
  if (!next && !previous) return segments_meet(e.a, e.b, f.a, f.b);
  // Neighbours meet at their common vertex; they must not fold back onto each other.
  const Edge& first = next ? e : f;
  const Edge& second = next ? f : e;
  return side(first.a, first.b, second.b) == 0 && dot(first.b - first.a, second.b - second.a) < 0.0;
}

}  // namespace

bool self_intersects(const Polygon& polygon) {
  const std::vector<Edge> edges = edges_of(polygon);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].a == edges[i].b) return true;
    const std::size_t size = polygon.ring(edges[i].ring).size();
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      if (interfere(edges[i], edges[j], size)) return true;
    }
  }
  return false;
}

namespace {

bool in_triangle(Vec2 a, Vec2 b, Vec2 c, Vec2 p) {
  return cross(b - a, p - a) >= 0.0 && cross(c - b, p - b) >= 0.0 && cross(a - c, p - c) >= 0.0;
}

/// Whether the way from vertex k to p begins inside the ring. Copies of a vertex, where bridges end and where rings
/// touch, differ in this.
bool starts_inside(const Ring& ring, std::size_t k, Vec2 p) {
  const std::size_t n = ring.size();
  const Vec2 v = ring[k], before = ring[(k + n - 1) % n], after = ring[(k + 1) % n];
  const bool left_of_next = cross(after - v, p - v) > 0.0, left_of_last = cross(v - before, p - v) > 0.0;
  return cross(v - before, after - v) > 0.0 ? left_of_next && left_of_last : left_of_next || left_of_last;
}

/// Whether the edge a b stands in the way from p to q. An edge that begins at p or q does if it runs along the way.
bool blocks_way(Vec2 a, Vec2 b, Vec2 p, Vec2 q) {
  const auto along = [](Vec2 shared, Vec2 end, Vec2 way_end) {
    return side(shared, end, way_end) == 0 && dot(end - shared, way_end - shared) > 0.0;
  };
  if (a == p || a == q) return along(a, b, a == p ? q : p);
  if (b == p || b == q) return along(b, a, b == p ? q : p);
  return segments_meet(a, b, p, q);
}

bool ring_blocks_way(const Ring& ring, Vec2 p, Vec2 q) {
  for (std::size_t e = 0; e < ring.size(); ++e) {
    if (blocks_way(ring[e], ring[(e + 1) % ring.size()], p, q)) return true;
  }
  return false;
}

/// Goes around the hole from its vertex `start` when the ring has come to its vertex `at`, and then back to `at` if that
/// is another point.
void insert_hole(Ring& ring, std::size_t at, const Ring& hole, std::size_t start) {
  Ring joined(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(at) + 1);
  const bool touch = ring[at] == hole[start];
  for (std::size_t k = touch ? 1 : 0; k <= hole.size(); ++k)
    joined.push_back(hole[(start + k) % hole.size()]);
  joined.insert(joined.end(), ring.begin() + static_cast<std::ptrdiff_t>(touch ? at + 1 : at), ring.end());
  ring = std::move(joined);
}

/// Joins a hole to the ring at a vertex that both have; false where there is none.
bool join_at_touch(Ring& ring, const Ring& hole) {
  for (std::size_t h = 0; h < hole.size(); ++h) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      if (!(ring[k] == hole[h]) || !starts_inside(ring, k, hole[(h + 1) % hole.size()])) continue;
      insert_hole(ring, k, hole, h);
      return true;
    }
  }
  return false;
}

std::size_t rightmost(const Ring& ring) {
  const auto most = std::max_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; });
  return static_cast<std::size_t>(most - ring.begin());
}

/// Joins a hole to the ring by a double edge from the hole's rightmost vertex to the nearest ring vertex that it sees
/// to its right. No hole of `others` may reach further to the right.
void bridge_hole(Ring& ring, const Ring& hole, std::span<const Ring> others) {
  const std::size_t start = rightmost(hole);
  const Vec2 p = hole[start];
  std::size_t best = ring.size();
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const double distance = squared_norm(ring[k] - p);
    if (distance >= best_distance || ring[k].x < p.x || !starts_inside(ring, k, p)) continue;
    if (ring_blocks_way(ring, p, ring[k]) || ring_blocks_way(hole, p, ring[k])) continue;
    if (std::any_of(others.begin(), others.end(),
                    [&](const Ring& o) { return ring_blocks_way(o, p, ring[k]); }))
      continue;
    best = k;
    best_distance = distance;
  }
  if (best == ring.size()) throw std::invalid_argument("triangulate: a hole lies outside its outer ring");
  insert_hole(ring, best, hole, start);
}

/// One ring around the region: it passes more than once through vertices where rings touch and where bridges end, and
/// goes both ways along bridges.
Ring single_ring(const Polygon& polygon) {
  Ring ring = polygon.outer;
  std::vector<Ring> holes = polygon.holes;  // those still to be joined, the rightmost last
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Ring& a, const Ring& b) { return a[rightmost(a)].x < b[rightmost(b)].x; });
  while (!holes.empty()) {
    // A bridge to a hole that touches would enclose a part of the region.
    const auto touching =
        std::find_if(holes.begin(), holes.end(), [&](const Ring& hole) { return join_at_touch(ring, hole); });
    if (touching != holes.end()) {
      holes.erase(touching);
      continue;
    }
    const Ring hole = std::move(holes.back());
    holes.pop_back();
    bridge_hole(ring, hole, holes);
  }
  return ring;
}

/// Whether the triangle at vertex k can be cut off: nothing of the ring lies in it.
bool is_ear(const Ring& ring, std::size_t k) {
  const std::size_t n = ring.size();
  const Vec2 a = ring[(k + n - 1) % n], b = ring[k], c = ring[(k + 1) % n];
  if (cross(b - a, c - b) <= 0.0) return false;
  const auto leads_in = [&](Vec2 q) { return cross(c - b, q - b) > 0.0 && cross(q - b, a - b) > 0.0; };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 p = ring[i];
    if (i == k || p == a || p == c) continue;
    // Where the ring passes b again, an edge may cross the triangle and leave it opposite of b.
    if (p == b ? leads_in(ring[(i + n - 1) % n]) || leads_in(ring[(i + 1) % n]) : in_triangle(a, b, c, p))
      return false;
  }
  return true;
}

/// The vertex where the ring turns least.
std::size_t flattest_vertex(const Ring& ring) {
  const std::size_t n = ring.size();
  std::size_t flattest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    const double c = std::abs(cross(ring[k] - ring[(k + n - 1) % n], ring[(k + 1) % n] - ring[k]));
    if (c < least) {
      least = c;
      flattest = k;
    }
  }
  return flattest;
}

}  // namespace

// GEOS could do this (GEOSConstrainedDelaunayTriangulation), but GEOS 3.11 finds no triangles for about one in ten
// thousand polygons whose holes touch.
std::vector<std::array<Vec2, 3>> triangulate(const Polygon& polygon) {
  if (polygon.outer.size() < 3 || !(area(polygon) > 0.0)) {
    throw std::invalid_argument("triangulate: a polygon needs three vertices and an area");
  }
  Ring ring = single_ring(polygon);
  std::vector<std::array<Vec2, 3>> triangles;
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    std::size_t cut = 0;
    while (cut < n && !is_ear(ring, cut)) ++cut;
    // Where no ear is left, a flat vertex (collinear neighbours) is cut off without a triangle.
    if (cut == n)
      cut = flattest_vertex(ring);
    else
      triangles.push_back({ring[(cut + n - 1) % n], ring[cut], ring[(cut + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(cut));
  }
  if (cross(ring[1] - ring[0], ring[2] - ring[1]) > 0.0) triangles.push_back({ring[0], ring[1], ring[2]});
  double covered = 0.0;
  for (const auto& triangle : triangles) covered += signed_area(triangle);
  constexpr double rounding = 1e-9;
  const Vec2 size = bounds(polygon).size();
  if (std::abs(covered - area(polygon)) > rounding * squared_norm(size)) {
    throw std::invalid_argument(
        fmt::format("triangulate: triangles of {} m² in a polygon of {} m²", covered, area(polygon)));
  }
  return triangles;
}

}  // namespace keyblock
