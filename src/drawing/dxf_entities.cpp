#include "drawing/dxf_entities.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drawing/curves.h"

namespace keyblock::drawing {
namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr double one_degree = std::numbers::pi / 180.0;

struct BulgedVertex {
  Vec2 p;
  double bulge = 0.0;  ///< of the way to the next vertex
};

EntityShape joined(const std::vector<BulgedVertex>& vertices, bool closed) {
  EntityShape shape{{}, closed};
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    shape.vertices.push_back(vertices[k].p);
    if (vertices[k].bulge != 0.0 && (closed || k + 1 < vertices.size()))
      append_bulge(vertices[k].p, vertices[(k + 1) % vertices.size()].p, vertices[k].bulge, shape.vertices);
  }
  return shape;
}

// What of a shape lies in a plane that is seen from below has x to the other side.
EntityShape seen(EntityShape shape, Plane plane) {
  if (plane == Plane::from_below) {
    for (Vec2& p : shape.vertices) p.x = -p.x;
  }
  return shape;
}

// To the angle after `from`, at most a full turn on.
double after(double from, double to) {
  while (to <= from) to += full_turn;
  return to;
}

// A radius of a length that is no finite number of turns away.
double in_turn(double angle) {
  return std::fmod(angle, full_turn);
}

EntityShape lightweight(const Record& record, const Numbers& numbers) {
  std::vector<BulgedVertex> vertices;
  for (const Pair& pair : record.pairs) {
    if (pair.code == 10) vertices.push_back({{numbers.number(pair), 0.0}, 0.0});
    if (pair.code == 20 && !vertices.empty()) vertices.back().p.y = numbers.number(pair);
    if (pair.code == 42 && !vertices.empty()) vertices.back().bulge = numbers.number(pair);
  }
  return joined(vertices, (numbers.integer(record, 70, 0) & 1) != 0);
}

EntityShape circle(const Record& record, const Numbers& numbers, bool whole) {
  const double r = numbers.number(record, 40, 0.0);
  const double from = whole ? 0.0 : in_turn(one_degree * numbers.number(record, 50, 0.0));
  const double to = whole ? full_turn : after(from, in_turn(one_degree * numbers.number(record, 51, 360.0)));
  EntityShape shape{ellipse_arc(numbers.point(record, 10), {r, 0.0}, {0.0, r}, from, to), whole};
  if (whole) shape.vertices.pop_back();
  return shape;
}

// In coordinates of the world, whatever its plane.
EntityShape ellipse(const Record& record, const Numbers& numbers, Plane plane) {
  const Vec2 major = numbers.point(record, 11);
  const double ratio = numbers.number(record, 40, 1.0);
  const Vec2 minor = (plane == Plane::from_below ? -ratio : ratio) * perpendicular(major);
  const double from = in_turn(numbers.number(record, 41, 0.0));
  const double to = after(from, in_turn(numbers.number(record, 42, full_turn)));
  constexpr double rounding = 1e-6;
  const bool whole = to - from > full_turn - rounding;
  EntityShape shape{ellipse_arc(numbers.point(record, 10), major, minor, from, to), whole};
  if (whole) shape.vertices.pop_back();
  return shape;
}

std::optional<EntityShape> spline_shape(const Record& record, const Numbers& numbers, std::string& reason) {
  constexpr int closed_flag = 1;
  const Spline spline{numbers.integer(record, 71, 3), numbers.all(record, 40), numbers.points(record, 10),
                      numbers.all(record, 41)};
  if (!spline.is_sound()) {
    reason = spline.points.empty() && record.find(11) != nullptr ? "by fit points alone" : "of unsound knots";
    return std::nullopt;
  }
  return EntityShape{spline_vertices(spline), (numbers.integer(record, 70, 0) & closed_flag) != 0};
}

}  // namespace

Plane plane_of(const Record& record, const Numbers& numbers) {
  constexpr double level_enough = 1e-6;
  const double x = numbers.number(record, 210, 0.0), y = numbers.number(record, 220, 0.0),
               z = numbers.number(record, 230, 1.0);
  if (std::hypot(x, y) > level_enough * std::abs(z)) return Plane::tilted;
  return z < 0.0 ? Plane::from_below : Plane::level;
}

std::optional<EntityShape> shape_of(const Record& record, const Numbers& numbers, std::string& reason) {
  if (record.type == "LINE")
    return EntityShape{{numbers.point(record, 10), numbers.point(record, 11)}, false};
  if (record.type == "SPLINE") return spline_shape(record, numbers, reason);
  const bool is_circle = record.type == "CIRCLE";
  if (!is_circle && record.type != "ARC" && record.type != "ELLIPSE" && record.type != "LWPOLYLINE")
    return std::nullopt;
  const Plane plane = plane_of(record, numbers);
  if (plane == Plane::tilted) {
    reason = "in a tilted plane";
    return std::nullopt;
  }
  if (record.type == "ELLIPSE") return ellipse(record, numbers, plane);
  return seen(record.type == "LWPOLYLINE" ? lightweight(record, numbers) : circle(record, numbers, is_circle),
              plane);
}

std::optional<EntityShape> shape_of_polyline(const Record& polyline, std::span<const Record> vertices,
                                             const Numbers& numbers, std::string& reason) {
  constexpr int closed = 1, in_space = 8, mesh = 16 | 64, frame_of_spline = 16;
  const int flags = numbers.integer(polyline, 70, 0);
  const Plane plane = (flags & in_space) != 0 ? Plane::level : plane_of(polyline, numbers);
  if ((flags & mesh) != 0 || plane == Plane::tilted) {
    reason = plane == Plane::tilted ? "in a tilted plane" : "of a mesh";
    return std::nullopt;
  }
  std::vector<BulgedVertex> path;
  for (const Record& vertex : vertices) {
    if ((numbers.integer(vertex, 70, 0) & frame_of_spline) != 0) continue;
    path.push_back({numbers.point(vertex, 10), numbers.number(vertex, 42, 0.0)});
  }
  return seen(joined(path, (flags & closed) != 0), plane);
}

}  // namespace keyblock::drawing
