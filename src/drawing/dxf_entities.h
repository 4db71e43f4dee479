#pragma once
#include <optional>
#include <string>
#include <vector>

#include "drawing/dxf_records.h"

/// Entities of DXF as polylines, each in the coordinates of its block.
namespace keyblock::drawing {

struct EntityShape {
  std::vector<Vec2> vertices;
  bool closed = false;
};

/// How its plane lies: DXF gives planar entities in coordinates of their own (arbitrary axis algorithm).
enum class Plane { level, from_below, tilted };
Plane plane_of(const Record& record, const Numbers& numbers);

/// The shape of LINE, LWPOLYLINE, ARC, CIRCLE, ELLIPSE or SPLINE. Nothing: it is none that is read; `reason` says why where its name does not. Throws
/// InputError for numbers that are none.
std::optional<EntityShape> shape_of(const Record& record, const Numbers& numbers, std::string& reason);

/// The same for a POLYLINE, whose vertices are records of their own.
std::optional<EntityShape> shape_of_polyline(const Record& polyline, std::span<const Record> vertices,
                                             const Numbers& numbers, std::string& reason);

}  // namespace keyblock::drawing
