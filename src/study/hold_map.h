#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/polygon.h"
#include "study/limit.h"
#include "study/run_result.h"

namespace keyblock::study {

/// Up to which value of the key the rock of every cell of the grid is still in place, of the trials of one realization: of those between `from` and
/// the first trial that loosens or brings down the rock there, the last. With the factor of safety as the key it is the factor that each block
/// holds, to the width between trials.
struct HoldMap {
  MapGrid grid;
  std::vector<Ring> outlines;  ///< of the openings
  std::vector<std::optional<double>>
      holds;               ///< per cell; none: its rock holds in all trials, or there is none
  std::vector<bool> lost;  ///< per cell: its rock goes at `from` already
  [[nodiscard]] bool empty() const;
};

/// trials: values of the key and the map of each run (RunResult::map).
HoldMap hold_map(const MapGrid& grid, const std::vector<Ring>& outlines, double from,
                 std::vector<std::pair<double, const std::vector<record::BlockStatus>*>> trials);

/// A line for every cell whose rock does not hold in all trials: x and y of its middle, m, and the value; empty where it goes at `from` already.
std::string hold_map_csv(const HoldMap& map);

/// A picture with a legend, and nothing where all rock holds.
std::string hold_map_svg(const HoldMap& map, const LimitResult& result);

}  // namespace keyblock::study
