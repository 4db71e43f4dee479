#pragma once
#include <cstdint>
#include <vector>

#include "geometry/polygon.h"

namespace keyblock::rockmass {

/// Joints that divide a region into blocks by a rule.
struct Tessellation {
  enum class Pattern {
    brick,   ///< courses, every second one shifted
    voronoi  ///< around random points: all that is nearer to one than to others
  } pattern = Pattern::brick;
  Ring region;                 ///< m; its outline is a joint, too
  double size = 0.0;           ///< m: length of a brick; of a Voronoi block the root of the mean area
  double course_height = 0.0;  ///< m, of bricks
  double bond = 0.5;           ///< share of a brick by which every second course is shifted
  double angle = 0.0;          ///< degrees, by which the courses rise to the right
  int rounds =
      5;  ///< of Lloyd's algorithm (1982), in each of which every point goes to the centroid of its cell: the more, the rounder
};

/// How many blocks there will be, about.
double expected_count(const Tessellation& tessellation);

/// The joints, within the region. Of bricks the courses lie on multiples of their height above the lowest corner of the region's box. Voronoi cells are
/// those of N points, N the area of the region's box over size², that are uniform in the box and a function of seed, realization and map alone.
/// Precondition: expected_count is at most most_of_tessellation.
std::vector<std::vector<Vec2>> tessellation_lines(const Tessellation& tessellation, std::uint64_t seed,
                                                  int realization, int map_index);

inline constexpr double most_of_tessellation = 10000.0;

}  // namespace keyblock::rockmass
