#include "overlap/overlap.h"

#define GEOS_USE_ONLY_R_API
#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "overlap/width.h"

namespace keyblock::overlap {
namespace {

// Depths below this many units in the last place of the largest coordinate count as touching.
constexpr double resolution_ulps = 16.0;
// Grid of the second attempt at an intersection, in the same units.
constexpr double grid_ulps = 4096.0;

using Context = std::unique_ptr<GEOSContextHandle_HS, decltype(&GEOS_finish_r)>;

struct GeometryDeleter {
  GEOSContextHandle_t context;
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(context, geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, GeometryDeleter>;

// Whether the points lie on the inner side of every edge of a hole, and so in the hole (in its kernel).
bool lies_in_hole(const Ring& points, const Ring& hole) {
  for (std::size_t k = 0; k < hole.size(); ++k) {
    const Vec2 a = hole[k], edge = hole[(k + 1) % hole.size()] - a;
    for (const Vec2 p : points) {
      if (cross(edge, p - a) > 0.0) return false;
    }
  }
  return true;
}

bool lies_in_a_hole(const Ring& points, const Polygon& polygon) {
  return std::any_of(polygon.holes.begin(), polygon.holes.end(),
                     [&](const Ring& hole) { return lies_in_hole(points, hole); });
}

// The hull of a hole that is convex, except for `rounding` in m; else nothing.
std::optional<Ring> convex_hole(const Ring& hole, double rounding) {
  const Ring hull = convex_hull(hole);
  const auto is_on_hull = [&](Vec2 p) {
    for (std::size_t k = 0; k < hull.size(); ++k) {
      if (cross(normalized(hull[(k + 1) % hull.size()] - hull[k]), p - hull[k]) <= rounding) return true;
    }
    return false;
  };
  if (hull.size() < 3 || !std::all_of(hole.begin(), hole.end(), is_on_hull)) return std::nullopt;
  return hull;
}

// m, by how much points lie beyond the sides of a convex ring, those of all sides together.
double beyond_sides(const Ring& points, const Ring& ring) {
  double together = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 along = normalized(ring[(k + 1) % ring.size()] - ring[k]);
    double beyond = 0.0;
    for (const Vec2 p : points) beyond = std::max(beyond, -cross(along, p - ring[k]));
    together += beyond;
  }
  return together;
}

// Whether no two edges of a ring that do not follow each other meet.
bool is_simple(const Ring& ring) {
  const auto vertex = [&](std::size_t k) { return ring[k % ring.size()]; };
  const auto apart = [&](std::size_t i, std::size_t j) {  // the ends of edge j, on one side of edge i
    const Vec2 a = vertex(i), edge = vertex(i + 1) - a;
    return cross(edge, vertex(j) - a) * cross(edge, vertex(j + 1) - a) > 0.0;
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t last = i == 0 ? ring.size() - 1 : ring.size();
    for (std::size_t j = i + 2; j < last; ++j) {
      if (!apart(i, j) && !apart(j, i)) return false;
    }
  }
  return true;
}

// What GEOS does for polygons, in a context of its own.
class Geos {
 public:
  [[nodiscard]] GEOSContextHandle_t context() const { return context_.get(); }
  [[nodiscard]] Geometry own(GEOSGeometry* geometry) const {
    return {geometry, GeometryDeleter{context_.get()}};
  }
  // Null when GEOS refuses the polygon.
  [[nodiscard]] Geometry polygon(const Polygon& polygon) const;
  [[nodiscard]] Polygon read(const GEOSGeometry* polygon) const;
  // what(polygon) of every polygon of a geometry that is not empty.
  template <typename What>
  void for_polygons(const GEOSGeometry* geometry, const What& what) const {
    const int type = GEOSGeomTypeId_r(context(), geometry);
    if (type == GEOS_POLYGON && GEOSisEmpty_r(context(), geometry) == 0) {
      what(geometry);
    } else if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
      const int count = GEOSGetNumGeometries_r(context(), geometry);
      for (int k = 0; k < count; ++k) for_polygons(GEOSGetGeometryN_r(context(), geometry, k), what);
    }
  }

 private:
  [[nodiscard]] GEOSGeometry* ring(const Ring& ring) const;
  [[nodiscard]] Ring read_ring(const GEOSGeometry* ring) const;

  Context context_{GEOS_init_r(), GEOS_finish_r};
};

GEOSGeometry* Geos::ring(const Ring& ring) const {
  std::vector<double> xy;
  for (std::size_t k = 0; k <= ring.size(); ++k) {
    xy.push_back(ring[k % ring.size()].x);
    xy.push_back(ring[k % ring.size()].y);
  }
  GEOSCoordSequence* sequence =
      GEOSCoordSeq_copyFromBuffer_r(context(), xy.data(), static_cast<unsigned>(ring.size() + 1), 0, 0);
  return sequence == nullptr ? nullptr : GEOSGeom_createLinearRing_r(context(), sequence);
}

Geometry Geos::polygon(const Polygon& polygon) const {
  GEOSGeometry* outer = ring(polygon.outer);
  if (outer == nullptr) return own(nullptr);
  std::vector<GEOSGeometry*> holes;
  for (const Ring& hole : polygon.holes) {
    if (GEOSGeometry* made = ring(hole)) holes.push_back(made);
  }
  Geometry made =
      own(GEOSGeom_createPolygon_r(context(), outer, holes.data(), static_cast<unsigned>(holes.size())));
  if (made && GEOSisValid_r(context(), made.get()) != 1) made = own(GEOSMakeValid_r(context(), made.get()));
  return made;
}

Ring Geos::read_ring(const GEOSGeometry* ring) const {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(context(), ring);
  unsigned size = 0;
  GEOSCoordSeq_getSize_r(context(), sequence, &size);
  Ring points(size);
  for (unsigned k = 0; k < size; ++k)
    GEOSCoordSeq_getXY_r(context(), sequence, k, &points[k].x, &points[k].y);
  if (!points.empty()) points.pop_back();
  return points;
}

Polygon Geos::read(const GEOSGeometry* polygon) const {
  Polygon piece{read_ring(GEOSGetExteriorRing_r(context(), polygon)), {}};
  const int holes = GEOSGetNumInteriorRings_r(context(), polygon);
  for (int k = 0; k < holes; ++k)
    piece.holes.push_back(read_ring(GEOSGetInteriorRingN_r(context(), polygon, k)));
  orient(piece);
  return piece;
}

struct Pair {
  double bound = 0.0;  // of the depth, from above
  int a = 0, b = 0;
};

class Finder {
 public:
  explicit Finder(std::span<const Polygon> blocks)
      : blocks_(blocks), geometries_(blocks.size()), parts_(blocks.size()), convex_holes_(blocks.size()) {
    for (const Polygon& block : blocks) {
      boxes_.push_back(bounds(block));
      hulls_.push_back(convex_hull(block.outer));
      for (const Vec2 p : block.outer) largest_ = std::max({largest_, std::abs(p.x), std::abs(p.y)});
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      for (const Ring& hole : blocks[k].holes) {
        if (std::optional<Ring> convex = convex_hole(hole, resolution()))
          convex_holes_[k].push_back(std::move(*convex));
      }
    }
  }

  // Pairs that may overlap by more than `least`, widest bound first.
  [[nodiscard]] std::vector<Pair> candidates(double least);
  // Connected regions that a pair shares.
  // Depths up to `least` need not be exact, as long as they are not more.
  std::vector<Overlap> regions(const Pair& pair, double least);
  [[nodiscard]] double resolution() const { return unit() * resolution_ulps; }

 private:
  [[nodiscard]] double unit() const { return std::numeric_limits<double>::epsilon() * largest_; }
  [[nodiscard]] double upper_bound(std::size_t a, std::size_t b, double least);
  const std::vector<Ring>& parts(std::size_t block);
  const GEOSGeometry* geometry(int block);
  [[nodiscard]] double inscribed_width(const GEOSGeometry* polygon, double least) const;
  [[nodiscard]] Overlap region(const GEOSGeometry* polygon, const Pair& pair, double blur,
                               double least) const;

  std::span<const Polygon> blocks_;
  Geos geos_;
  std::vector<std::optional<Geometry>> geometries_;
  std::vector<Box> boxes_;
  std::vector<Ring> hulls_;
  std::vector<std::optional<std::vector<Ring>>> parts_;
  std::vector<std::vector<Ring>> convex_holes_;
  double largest_ = 0.0;
};

// Convex parts of a block; none where it is not worth it, or cannot be had.
const std::vector<Ring>& Finder::parts(std::size_t block) {
  constexpr std::size_t most_vertices = 64;
  std::optional<std::vector<Ring>>& known = parts_[block];
  if (known) return *known;
  known.emplace();
  const Polygon& polygon = blocks_[block];
  if (hulls_[block].size() == polygon.outer.size()) {
    known->push_back(hulls_[block]);
  } else if (polygon.holes.empty() && polygon.outer.size() <= most_vertices && is_simple(polygon.outer)) {
    try {
      *known = convex_parts(polygon);
    } catch (const std::invalid_argument&) {
      // Too thin to be cut up.
    }
  }
  return *known;
}

// Where hulls overlap by more than `least`, convex parts know more: what blocks share is covered by what pairs of parts share, and a
// convex body that planks cover is no wider than they are together (Bang 1951). Likewise with what lies in a convex hole, as in the frame:
// what it shares with the block around lies beyond the sides of the hole.
double Finder::upper_bound(std::size_t a, std::size_t b, double least) {
  if (lies_in_a_hole(hulls_[a], blocks_[b]) || lies_in_a_hole(hulls_[b], blocks_[a])) return 0.0;
  double of_hulls = hull_penetration(hulls_[a], hulls_[b]);
  for (const Ring& hole : convex_holes_[a])
    of_hulls = std::min(of_hulls, resolution() + beyond_sides(hulls_[b], hole));
  for (const Ring& hole : convex_holes_[b])
    of_hulls = std::min(of_hulls, resolution() + beyond_sides(hulls_[a], hole));
  if (of_hulls <= least) return of_hulls;
  const std::vector<Ring>&of_a = parts(a), &of_b = parts(b);
  if (of_a.empty() || of_b.empty() || of_a.size() * of_b.size() == 1) return of_hulls;
  double together = resolution();
  for (const Ring& part : of_a) {
    for (const Ring& other : of_b) together += std::max(0.0, hull_penetration(part, other));
  }
  return std::min(of_hulls, together);
}

std::vector<Pair> Finder::candidates(double least) {
  std::vector<int> order(blocks_.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
  const auto box = [this](int k) -> const Box& { return boxes_[static_cast<std::size_t>(k)]; };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return box(a).min.x < box(b).min.x || (box(a).min.x == box(b).min.x && a < b);
  });
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int a = order[i];
    for (std::size_t j = i + 1; j < order.size() && box(order[j]).min.x < box(a).max.x; ++j) {
      const int b = order[j];
      if (!box(a).overlaps(box(b))) continue;
      const double bound = upper_bound(static_cast<std::size_t>(a), static_cast<std::size_t>(b), least);
      if (bound > least) pairs.push_back({bound, std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
    if (p.bound != q.bound) return p.bound > q.bound;
    return p.a != q.a ? p.a < q.a : p.b < q.b;
  });
  return pairs;
}

// Null when GEOS refuses the block.
const GEOSGeometry* Finder::geometry(int block) {
  std::optional<Geometry>& known = geometries_[static_cast<std::size_t>(block)];
  if (!known) known = geos_.polygon(blocks_[static_cast<std::size_t>(block)]);
  return known->get();
}

/// Diameter of the largest disc in a region that cannot be cut into convex parts (a ring of a few ulps around an island),
/// from above: to within 4e-5 of its extent, or `least` where it is not more.
double Finder::inscribed_width(const GEOSGeometry* polygon, double least) const {
  constexpr int quadrant_segments = 8;
  const Geometry eroded = geos_.own(GEOSBuffer_r(geos_.context(), polygon, -0.5 * least, quadrant_segments));
  if (eroded && GEOSisEmpty_r(geos_.context(), eroded.get()) == 1) return least;
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  GEOSGeom_getXMin_r(geos_.context(), polygon, &x0);
  GEOSGeom_getYMin_r(geos_.context(), polygon, &y0);
  GEOSGeom_getXMax_r(geos_.context(), polygon, &x1);
  GEOSGeom_getYMax_r(geos_.context(), polygon, &y1);
  const double tolerance = 1e-5 * std::hypot(x1 - x0, y1 - y0);
  const Geometry radius = geos_.own(GEOSMaximumInscribedCircle_r(geos_.context(), polygon, tolerance));
  double length = 0.0;
  if (!radius || GEOSLength_r(geos_.context(), radius.get(), &length) != 1) return HUGE_VAL;
  return 2.0 * (length + tolerance);
}

Overlap Finder::region(const GEOSGeometry* polygon, const Pair& pair, double blur, double least) const {
  const Polygon piece = geos_.read(polygon);
  const Ring hull = convex_hull(piece.outer);
  Overlap found{convex_width(hull), pair.a, pair.b, centroid(piece), area(piece)};
  std::vector<Ring> parts;
  double covered = 0.0;
  try {
    parts = convex_parts(piece);
    for (const Ring& part : parts) covered += signed_area(part);
  } catch (const std::invalid_argument&) {
    // Too thin to be cut up.
  }
  if (std::abs(covered - found.area) > 0.01 * found.area) {
    // No disc is larger than the region.
    found.depth = std::min(found.depth, 2.0 * std::sqrt(found.area / std::numbers::pi));
    if (found.depth > least) found.depth = std::min(found.depth, inscribed_width(polygon, least));
  } else if (parts.size() > 1) {
    double widest = 0.0;
    for (const Ring& part : parts) {
      const double width = convex_width(part);
      if (width <= widest) continue;
      widest = width;
      found.where = centroid({part, {}});
    }
    found.depth = std::min(found.depth, widest);
  }
  found.depth = std::min(found.depth + blur, pair.bound);
  return found;
}

std::vector<Overlap> Finder::regions(const Pair& pair, double least) {
  const GEOSGeometry* a = geometry(pair.a);
  const GEOSGeometry* b = geometry(pair.b);
  double blur = 0.0;
  Geometry shared = geos_.own(nullptr);
  if (a != nullptr && b != nullptr) {
    shared = geos_.own(GEOSIntersection_r(geos_.context(), a, b));
    if (!shared) {
      blur = grid_ulps * unit();
      shared = geos_.own(GEOSIntersectionPrec_r(geos_.context(), a, b, blur));
    }
  }
  std::vector<Overlap> found;
  if (shared) {
    geos_.for_polygons(shared.get(), [&](const GEOSGeometry* polygon) {
      found.push_back(region(polygon, pair, blur, least));
    });
    if (!found.empty() || blur == 0.0) return found;
  }
  Box both = boxes_[static_cast<std::size_t>(pair.a)];
  const Box& other = boxes_[static_cast<std::size_t>(pair.b)];
  both.min = {std::max(both.min.x, other.min.x), std::max(both.min.y, other.min.y)};
  both.max = {std::min(both.max.x, other.max.x), std::min(both.max.y, other.max.y)};
  const double depth = shared ? std::min(blur, pair.bound) : pair.bound;
  found.push_back({depth, pair.a, pair.b, lerp(both.min, both.max, 0.5), 0.0});
  return found;
}

}  // namespace

Overlap largest_overlap(std::span<const Polygon> blocks, double least_depth) {
  Finder finder(blocks);
  const double least = std::max(least_depth, finder.resolution());
  Overlap largest;
  for (const Pair& pair : finder.candidates(least)) {
    const double exceeded = std::max(least, largest.depth);
    if (pair.bound <= exceeded) break;
    for (const Overlap& found : finder.regions(pair, exceeded)) {
      if (found.depth > std::max(least, largest.depth)) largest = found;
    }
  }
  return largest;
}

std::vector<Overlap> all_overlaps(std::span<const Polygon> blocks, double least_depth) {
  Finder finder(blocks);
  const double least = std::max(least_depth, finder.resolution());
  std::vector<Overlap> all;
  for (const Pair& pair : finder.candidates(least)) {
    for (const Overlap& found : finder.regions(pair, least)) {
      if (found.depth > least) all.push_back(found);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
  return all;
}

std::vector<Polygon> union_of(std::span<const Polygon> polygons) {
  const Geos geos;
  Geometry all = geos.own(nullptr);
  for (const Polygon& polygon : polygons) {
    Geometry one = geos.polygon(polygon);
    all = all && one ? geos.own(GEOSUnion_r(geos.context(), all.get(), one.get())) : std::move(one);
    if (!all) throw std::invalid_argument("union_of: GEOS has no union of these polygons");
  }
  std::vector<Polygon> parts;
  if (all)
    geos.for_polygons(all.get(), [&](const GEOSGeometry* polygon) { parts.push_back(geos.read(polygon)); });
  return parts;
}

}  // namespace keyblock::overlap
