#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "rockmass/trace_map.h"
#include "scenario/mistakes.h"

/// Outlines of a scenario that are drawn.
namespace keyblock::scenario {

struct DrawnRing {
  Ring ring;  ///< counter-clockwise, checked; in the section
  std::string layer;
  SourcePosition where;  ///< of its entity
  std::string entity;    ///< in words: `LWPOLYLINE on layer STONES`
};

/// The closed lines of a drawing. Mistakes, with line and layer: lines that are open, that cross themselves or have no area, and whatever
/// drawing/drawing.h refuses. `skipped` receives what is no line, in words.
std::vector<DrawnRing> read_rings(const std::filesystem::path& file, const rockmass::MapChoice& choice,
                                  Mistakes& mistakes, std::string& skipped);

/// Rings that lie over each other by more than a thousandth of the smaller one are mistakes.
void check_overlaps(const std::vector<DrawnRing>& rings, Mistakes& mistakes);

}  // namespace keyblock::scenario
