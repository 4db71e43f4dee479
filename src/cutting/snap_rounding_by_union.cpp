#include <geos_c.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string>

#include "core/error.h"
#include "cutting/snap_rounding.h"

namespace keyblock::cutting {

namespace {

/// A GEOS context and the last error it reported.
class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {
    GEOSContext_setErrorMessageHandler_r(
        handle_, [](const char* message, void* text) { *static_cast<std::string*>(text) = message; },
        &error_);
  }
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  [[nodiscard]] GEOSContextHandle_t handle() const { return handle_; }

  template <typename T>
  T* checked(T* result) const {
    if (result == nullptr) throw RunError("the lines could not be noded: " + error_);
    return result;
  }

 private:
  GEOSContextHandle_t handle_;
  std::string error_;
};

struct GeometryDeleter {
  GEOSContextHandle_t handle;
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(handle, geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, GeometryDeleter>;

/// In random order, as snap_round() says.
Geometry to_geos(const Geos& geos, const std::vector<SourceLine>& lines) {
  std::vector<GEOSGeometry*> parts;
  for (const SourceLine& line : lines) {
    const Vec2 a = to_vec2(line.a), b = to_vec2(line.b);
    const std::array<double, 4> buffer{a.x, a.y, b.x, b.y};
    GEOSCoordSequence* sequence =
        geos.checked(GEOSCoordSeq_copyFromBuffer_r(geos.handle(), buffer.data(), 2, 0, 0));
    parts.push_back(geos.checked(GEOSGeom_createLineString_r(geos.handle(), sequence)));
  }
  std::shuffle(parts.begin(), parts.end(), std::mt19937());
  return {geos.checked(GEOSGeom_createCollection_r(geos.handle(), GEOS_MULTILINESTRING, parts.data(),
                                                   static_cast<unsigned>(parts.size()))),
          {geos.handle()}};
}

}  // namespace

std::vector<Segment> snap_round_by_union(const std::vector<SourceLine>& lines) {
  const Geos geos;
  const Geometry input = to_geos(geos, lines);
  const Geometry noded(geos.checked(GEOSUnaryUnionPrec_r(geos.handle(), input.get(), 1.0)), {geos.handle()});
  std::vector<Segment> segments;
  const int parts = GEOSGetNumGeometries_r(geos.handle(), noded.get());
  for (int k = 0; k < parts; ++k) {
    const GEOSGeometry* part = geos.checked(GEOSGetGeometryN_r(geos.handle(), noded.get(), k));
    const GEOSCoordSequence* sequence = geos.checked(GEOSGeom_getCoordSeq_r(geos.handle(), part));
    unsigned size = 0;
    GEOSCoordSeq_getSize_r(geos.handle(), sequence, &size);
    std::vector<double> buffer(2 * static_cast<std::size_t>(size));
    GEOSCoordSeq_copyToBuffer_r(geos.handle(), sequence, buffer.data(), 0, 0);
    for (std::size_t i = 0; i + 3 < buffer.size(); i += 2) {
      segments.push_back({nearest_grid_point({buffer[i], buffer[i + 1]}),
                          nearest_grid_point({buffer[i + 2], buffer[i + 3]})});
    }
  }
  tidy(segments);
  return segments;
}

}  // namespace keyblock::cutting
