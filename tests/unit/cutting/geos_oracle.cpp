#include "geos_oracle.h"

#include <algorithm>

namespace keyblock::cutting {

GEOSCoordSequence* GeosOracle::coordinates(const Ring& points, bool closed) const {
  const std::size_t n = points.size() + (closed ? 1 : 0);
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(handle_, static_cast<unsigned>(n), 2);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 p = points[k % points.size()];
    GEOSCoordSeq_setXY_r(handle_, sequence, static_cast<unsigned>(k), p.x, p.y);
  }
  return sequence;
}

GEOSGeometry* GeosOracle::polygon(const Polygon& p) const {
  std::vector<GEOSGeometry*> holes;
  for (const Ring& hole : p.holes)
    holes.push_back(GEOSGeom_createLinearRing_r(handle_, coordinates(hole, true)));
  return GEOSGeom_createPolygon_r(handle_, GEOSGeom_createLinearRing_r(handle_, coordinates(p.outer, true)),
                                  holes.data(), static_cast<unsigned>(holes.size()));
}

std::vector<double> GeosOracle::face_areas(const std::vector<rockmass::Trace>& lines, const Box& box) const {
  std::vector<GEOSGeometry*> parts;
  for (const rockmass::Trace& line : lines) {
    parts.push_back(GEOSGeom_createLineString_r(handle_, coordinates({line.a, line.b}, false)));
  }
  const Geometry all = own(GEOSGeom_createCollection_r(handle_, GEOS_MULTILINESTRING, parts.data(),
                                                       static_cast<unsigned>(parts.size())));
  const Geometry noded = own(GEOSUnaryUnion_r(handle_, all.get()));
  const GEOSGeometry* input = noded.get();
  const Geometry faces = own(GEOSPolygonize_r(handle_, &input, 1));
  std::vector<double> areas;
  for (int k = 0; k < GEOSGetNumGeometries_r(handle_, faces.get()); ++k) {
    const GEOSGeometry* face = GEOSGetGeometryN_r(handle_, faces.get(), k);
    const Geometry inside = own(GEOSPointOnSurface_r(handle_, face));
    Vec2 p;
    double value = 0.0;
    GEOSGeomGetX_r(handle_, inside.get(), &p.x);
    GEOSGeomGetY_r(handle_, inside.get(), &p.y);
    GEOSArea_r(handle_, face, &value);
    if (box.contains(p)) areas.push_back(value);
  }
  std::sort(areas.begin(), areas.end());
  return areas;
}

double GeosOracle::union_area(const std::vector<CutBlock>& blocks) const {
  std::vector<GEOSGeometry*> parts;
  for (const CutBlock& block : blocks) parts.push_back(polygon(block.polygon));
  const Geometry all = own(GEOSGeom_createCollection_r(handle_, GEOS_MULTIPOLYGON, parts.data(),
                                                       static_cast<unsigned>(parts.size())));
  const Geometry whole = own(GEOSUnaryUnion_r(handle_, all.get()));
  double value = -1.0;
  if (whole) GEOSArea_r(handle_, whole.get(), &value);
  return value;
}

bool GeosOracle::all_valid(const std::vector<CutBlock>& blocks) const {
  return std::all_of(blocks.begin(), blocks.end(), [&](const CutBlock& block) {
    return GEOSisValid_r(handle_, own(polygon(block.polygon)).get()) == 1;
  });
}

}  // namespace keyblock::cutting
