#pragma once
#include <span>
#include <string_view>

#include "picture/scale.h"
#include "results/run_data.h"

namespace keyblock::picture {

/// What may be drawn over the blocks, described once: the options of `picture` and `film`, the choice in the report, and the sizes that
/// Python draws with have it from here.
struct Mark {
  const char* name;
  const char* text;     ///< of a choice
  const char* meaning;  ///< of a legend and of --help
  Quantity quantity = Quantity::none;
  /// Of the typical size: width of a line in units of a picture, or a length in sides of a mean block; 0: there is no size.
  double drawn = 0.0;
  const char* color = "";
};
std::span<const Mark> all_marks();
const Mark& mark_of(std::string_view name);

/// Longer arrows are cut to so many typical ones.
inline constexpr double longest_arrow = 3.0;

/// Sizes that are drawn as Mark::drawn says: the 95th percentile at the ends of the stages, of arrows at moments all over the run; 1 where
/// there is nothing. The same for all moments, so that pictures can be compared.
struct Typical {
  double force = 1.0;         ///< N per thickness
  double stress = 1.0;        ///< Pa
  double displacement = 1.0;  ///< m
  double velocity = 1.0;      ///< m/s

  [[nodiscard]] double of(std::string_view mark) const;
};
Typical typical_sizes(const results::RunData& run);

}  // namespace keyblock::picture
