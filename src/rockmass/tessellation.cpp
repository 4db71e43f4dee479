#include "rockmass/tessellation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace keyblock::rockmass {
namespace {

using Lines = std::vector<std::vector<Vec2>>;

// Apart from the joint sets, whose streams are numbered by their place.
constexpr std::uint32_t streams_of_tessellations = 0x40000000U;

// The parts of a segment inside a ring.
void add_inside(const Ring& ring, Vec2 a, Vec2 b, Lines& lines) {
  std::vector<double> cuts{0.0, 1.0};
  const Vec2 along = b - a;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 p = ring[k], edge = ring[(k + 1) % ring.size()] - p;
    const double det = cross(along, edge);
    if (det == 0.0) continue;
    const double t = cross(p - a, edge) / det, s = cross(p - a, along) / det;
    if (t > 0.0 && t < 1.0 && s >= 0.0 && s <= 1.0) cuts.push_back(t);
  }
  std::ranges::sort(cuts);
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (cuts[k] < cuts[k + 1] && contains(ring, lerp(a, b, 0.5 * (cuts[k] + cuts[k + 1]))))
      lines.push_back({lerp(a, b, cuts[k]), lerp(a, b, cuts[k + 1])});
  }
}

void add_bricks(const Tessellation& t, Lines& lines) {
  const double angle = t.angle * std::numbers::pi / 180.0;
  const Vec2 along{std::cos(angle), std::sin(angle)}, up = perpendicular(along);
  const Box box = bounds(Polygon{t.region, {}});
  Box turned;  // coordinates along the courses and across them, from the lowest corner of the box
  for (const Vec2 p : t.region) turned.add(Vec2{dot(p - box.min, along), dot(p - box.min, up)});
  const auto at = [&](double x, double y) { return box.min + x * along + y * up; };
  const auto first_of = [](double low, double step) { return std::floor(low / step); };
  const double last = std::ceil(turned.max.y / t.course_height);
  for (double course = first_of(turned.min.y, t.course_height); course < last; ++course) {
    const double y = course * t.course_height;
    if (y > turned.min.y) add_inside(t.region, at(turned.min.x, y), at(turned.max.x, y), lines);
    const double shift = std::fmod(std::abs(course), 2.0) == 1.0 ? t.bond * t.size : 0.0;
    for (double k = first_of(turned.min.x - shift, t.size); k * t.size + shift <= turned.max.x; ++k) {
      const double x = k * t.size + shift;
      add_inside(t.region, at(x, y), at(x, y + t.course_height), lines);
    }
  }
}

// A cell of a Voronoi diagram: edge k from vertex k to the next, behind which is point `beyond`, −1 for the side of the box.
struct VoronoiCell {
  std::vector<Vec2> vertices;
  std::vector<int> beyond;
};

// Leaves of a convex cell what is nearer to `own` than to `other`.
void clip(VoronoiCell& cell, Vec2 own, Vec2 other, int number) {
  const Vec2 middle = 0.5 * (own + other), away = other - own;
  const std::size_t n = cell.vertices.size();
  VoronoiCell left;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 p = cell.vertices[k], q = cell.vertices[(k + 1) % n];
    const double at_p = dot(p - middle, away), at_q = dot(q - middle, away);
    if (at_p <= 0.0) {
      left.vertices.push_back(p);
      left.beyond.push_back(cell.beyond[k]);
    }
    if ((at_p <= 0.0) == (at_q <= 0.0)) continue;
    left.vertices.push_back(lerp(p, q, at_p / (at_p - at_q)));
    left.beyond.push_back(at_p <= 0.0 ? number : cell.beyond[k]);
  }
  cell = std::move(left);
}

VoronoiCell cell_of(const std::vector<Vec2>& points, std::size_t own, const Box& box) {
  VoronoiCell cell{{box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}}, {-1, -1, -1, -1}};
  const auto reach = [&] {
    double largest = 0.0;
    for (const Vec2 p : cell.vertices) largest = std::max(largest, squared_norm(p - points[own]));
    return 4.0 * largest;
  };
  double farthest = reach();  // of a point that can cut the cell, squared
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (j == own || squared_norm(points[j] - points[own]) >= farthest) continue;
    clip(cell, points[own], points[j], static_cast<int>(j));
    farthest = reach();
  }
  return cell;
}

void add_voronoi(const Tessellation& t, const RandomStream& random, Lines& lines) {
  const Box box = bounds(Polygon{t.region, {}});
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(expected_count(t))));
  std::vector<Vec2> points;
  for (std::uint32_t k = 0; k < count; ++k)
    points.push_back(box.min +
                     Vec2{random.uniform(2 * k) * box.size().x, random.uniform(2 * k + 1) * box.size().y});
  for (int round = 0; round < t.rounds; ++round) {
    std::vector<Vec2> moved;
    for (std::size_t k = 0; k < count; ++k) moved.push_back(centroid({cell_of(points, k, box).vertices, {}}));
    points = std::move(moved);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const VoronoiCell cell = cell_of(points, k, box);
    for (std::size_t e = 0; e < cell.vertices.size(); ++e) {
      if (cell.beyond[e] > static_cast<int>(k))
        add_inside(t.region, cell.vertices[e], cell.vertices[(e + 1) % cell.vertices.size()], lines);
    }
  }
}

}  // namespace

double expected_count(const Tessellation& tessellation) {
  const Vec2 size = bounds(Polygon{tessellation.region, {}}).size();
  const double across =
      tessellation.pattern == Tessellation::Pattern::brick ? tessellation.course_height : tessellation.size;
  return size.x / tessellation.size * (size.y / across);
}

std::vector<std::vector<Vec2>> tessellation_lines(const Tessellation& tessellation, std::uint64_t seed,
                                                  int realization, int map_index) {
  Lines lines;
  if (tessellation.pattern == Tessellation::Pattern::brick) {
    add_bricks(tessellation, lines);
  } else {
    add_voronoi(tessellation,
                RandomStream(seed, static_cast<std::uint32_t>(realization),
                             streams_of_tessellations + static_cast<std::uint32_t>(map_index), 0),
                lines);
  }
  std::vector<Vec2> outline = tessellation.region;
  outline.push_back(outline.front());
  lines.push_back(std::move(outline));
  return lines;
}

}  // namespace keyblock::rockmass
