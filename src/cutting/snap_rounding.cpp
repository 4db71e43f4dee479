#include "cutting/snap_rounding.h"

#include <algorithm>

#if KEYBLOCK_GEOS_NODER
#include <geos/geom/CoordinateArraySequence.h>
#include <geos/geom/PrecisionModel.h>
#include <geos/noding/NodedSegmentString.h>
#include <geos/noding/snapround/SnapRoundingNoder.h>
#include <geos/util/GEOSException.h>

#include <memory>
#include <random>
#include <string>

#include "core/error.h"
#endif

namespace keyblock::cutting {

void tidy(std::vector<Segment>& segments) {
  std::erase_if(segments, [](const Segment& s) { return s[0] == s[1]; });
  for (Segment& s : segments) s = {std::min(s[0], s[1]), std::max(s[0], s[1])};
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
}

#if KEYBLOCK_GEOS_NODER

namespace {

using geos::geom::Coordinate;
using Strings = std::vector<geos::noding::SegmentString*>;

/// Strings of segments that are the library's to use and ours to delete.
class OwnStrings {
 public:
  OwnStrings() : strings_(std::make_unique<Strings>()) {}
  explicit OwnStrings(Strings* strings) : strings_(strings) {}
  ~OwnStrings() {
    for (const geos::noding::SegmentString* string : *strings_) delete string;
  }
  OwnStrings(const OwnStrings&) = delete;
  OwnStrings& operator=(const OwnStrings&) = delete;

  Strings& operator*() const { return *strings_; }
  Strings* get() const { return strings_.get(); }

 private:
  std::unique_ptr<Strings> strings_;
};

std::unique_ptr<geos::noding::SegmentString> to_segment_string(const SourceLine& line) {
  const Vec2 a = to_vec2(line.a), b = to_vec2(line.b);
  auto points =
      std::make_unique<geos::geom::CoordinateArraySequence>(std::vector<Coordinate>{{a.x, a.y}, {b.x, b.y}});
  return std::make_unique<geos::noding::NodedSegmentString>(points.release(), nullptr);
}

GridPoint to_grid_point(const Coordinate& c) {
  return nearest_grid_point({c.x, c.y});
}

}  // namespace

/// The lines go in random order: the library enters ends and crossings into a k-d tree that it does not balance, in the order of
/// the lines, and parallel lines side by side would make chains of it. What is noded does not depend on the order.
std::vector<Segment> snap_round(const std::vector<SourceLine>& lines) try {
  const OwnStrings input;
  (*input).reserve(lines.size());
  for (const SourceLine& line : lines) (*input).push_back(to_segment_string(line).release());
  std::shuffle((*input).begin(), (*input).end(), std::mt19937());

  const geos::geom::PrecisionModel whole_numbers(1.0);
  geos::noding::snapround::SnapRoundingNoder noder(&whole_numbers);
  noder.computeNodes(input.get());
  const OwnStrings noded(noder.getNodedSubstrings());

  std::vector<Segment> segments;
  for (const geos::noding::SegmentString* string : *noded) {
    for (std::size_t k = 0; k + 1 < string->size(); ++k)
      segments.push_back(
          {to_grid_point(string->getCoordinate(k)), to_grid_point(string->getCoordinate(k + 1))});
  }
  tidy(segments);
  return segments;
} catch (const geos::util::GEOSException& e) {
  throw RunError(std::string("the lines could not be noded: ") + e.what());
}

#else

std::vector<Segment> snap_round(const std::vector<SourceLine>& lines) {
  return snap_round_by_union(lines);
}

#endif

}  // namespace keyblock::cutting
