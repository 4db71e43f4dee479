#pragma once
#include <geos_c.h>

#include <memory>
#include <vector>

#include "cutting/block_system.h"
#include "rockmass/trace.h"

namespace keyblock::cutting {

/// What a library says about lines and polygons, for comparison.
class GeosOracle {
 public:
  GeosOracle() : handle_(GEOS_init_r()) {}
  ~GeosOracle() { GEOS_finish_r(handle_); }
  GeosOracle(const GeosOracle&) = delete;
  GeosOracle& operator=(const GeosOracle&) = delete;

  /// Areas of the polygons that the lines bound within a box, sorted.
  std::vector<double> face_areas(const std::vector<rockmass::Trace>& lines, const Box& box) const;
  /// Area of the union of the blocks.
  double union_area(const std::vector<CutBlock>& blocks) const;
  /// Whether every block is a valid polygon.
  bool all_valid(const std::vector<CutBlock>& blocks) const;

 private:
  struct Deleter {
    GEOSContextHandle_t handle;
    void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(handle, g); }
  };
  using Geometry = std::unique_ptr<GEOSGeometry, Deleter>;
  Geometry own(GEOSGeometry* g) const { return {g, {handle_}}; }
  GEOSCoordSequence* coordinates(const Ring& points, bool closed) const;
  GEOSGeometry* polygon(const Polygon& p) const;

  GEOSContextHandle_t handle_;
};

}  // namespace keyblock::cutting
