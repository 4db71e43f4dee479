#include "cutting/noding.h"

#include <fmt/format.h>
#include <geos_c.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "core/error.h"
#include "cutting/segment_index.h"

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

/// In random order: the library enters ends and crossings into a k-d tree that it does not balance, in the order of the
/// lines, and parallel lines side by side would make chains of it. What is noded does not depend on the order.
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

using Segment = std::array<GridPoint, 2>;

/// The noded segments, the lower point first, sorted.
std::vector<Segment> noded_segments(const std::vector<SourceLine>& lines) {
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
      const GridPoint a = nearest_grid_point({buffer[i], buffer[i + 1]});
      const GridPoint b = nearest_grid_point({buffer[i + 2], buffer[i + 3]});
      if (!(a == b)) segments.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  return segments;
}

/// Finds the source lines along which a noded segment runs.
class SourceFinder {
 public:
  /// About as many cells as there are segments to find sources for.
  SourceFinder(const std::vector<SourceLine>& lines, const Box& bounds, std::size_t segments)
      : lines_(lines),
        index_(bounds, std::clamp(static_cast<int>(std::sqrt(static_cast<double>(segments))), 8, 4096)) {
    for (std::size_t k = 0; k < lines.size(); ++k) {
      index_.add(static_cast<int>(k), to_vec2(lines[k].a), to_vec2(lines[k].b));
    }
  }

  /// Snap rounding keeps a piece within half a diagonal of a cell of its line.
  [[nodiscard]] std::vector<int> find(const Segment& segment) const {
    constexpr double reach = 1.5;
    const Vec2 a = to_vec2(segment[0]), b = to_vec2(segment[1]);
    const Vec2 middle = 0.5 * (a + b);
    std::vector<int> found;
    index_.near({{middle.x - reach, middle.y - reach}, {middle.x + reach, middle.y + reach}}, [&](int id) {
      if (distance(id, a) <= reach && distance(id, b) <= reach) found.push_back(id);
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  [[nodiscard]] double distance(int id, Vec2 p) const {
    const SourceLine& line = lines_[static_cast<std::size_t>(id)];
    const Vec2 a = to_vec2(line.a), d = to_vec2(line.b) - a;
    const double s = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
    return norm(p - a - s * d);
  }

  const std::vector<SourceLine>& lines_;
  SegmentIndex index_;
};

}  // namespace

std::pair<int, int> rank(EdgeLabel label) {
  constexpr std::array<int, 5> by_kind{4, 3, 2, 1, 0};  // free, joint set, trace map, excavation, domain
  return {by_kind[static_cast<std::size_t>(label.kind)], label.index};
}

NodedLinework node(const Linework& work) {
  const std::vector<SourceLine> lines = split_at_nodes(work.lines);
  const std::vector<Segment> segments = noded_segments(lines);

  NodedLinework result;
  PlanarGraph& graph = result.graph;
  graph.grid = work.grid;
  for (const Segment& segment : segments)
    graph.points.insert(graph.points.end(), segment.begin(), segment.end());
  std::sort(graph.points.begin(), graph.points.end());
  graph.points.erase(std::unique(graph.points.begin(), graph.points.end()), graph.points.end());
  const auto vertex = [&](GridPoint p) {
    return static_cast<int>(std::lower_bound(graph.points.begin(), graph.points.end(), p) -
                            graph.points.begin());
  };

  const SourceFinder finder(lines, bounds({work.domain, {}}), segments.size());
  for (const Segment& segment : segments) {
    const std::vector<int> sources = finder.find(segment);
    if (sources.empty()) {
      const Vec2 place = work.shift + work.grid * to_vec2(segment[0]);
      throw RunError(
          fmt::format("a noded line at ({}, {}) belongs to no joint or outline", place.x, place.y));
    }
    GraphEdge edge{vertex(segment[0]), vertex(segment[1]), lines[static_cast<std::size_t>(sources[0])].label};
    std::vector<int> traces;
    for (const int id : sources) {
      const SourceLine& line = lines[static_cast<std::size_t>(id)];
      if (rank(line.label) < rank(edge.label)) edge.label = line.label;
      if (line.trace >= 0) traces.push_back(line.trace);
    }
    const Vec2 middle = 0.5 * (to_vec2(segment[0]) + to_vec2(segment[1]));
    if (edge.label.kind != EdgeKind::domain && !contains(work.domain, middle)) continue;
    traces.erase(std::unique(traces.begin(), traces.end()), traces.end());
    graph.edges.push_back(edge);
    result.traces.push_back(std::move(traces));
  }
  return result;
}

}  // namespace keyblock::cutting
