#pragma once
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "model/model.h"
#include "simulation/setup.h"

/// Liners of shotcrete as bodies of their own (docs/decisions/0042).
namespace keyblock::simulation {

/// A stretch of the wall that a liner lies on, with a station in its middle.
struct LinerCell {
  double from = 0.0, to = 0.0;                         ///< m, along the wall
  std::vector<std::pair<std::size_t, double>> blocks;  ///< that it lies on, with m of it

  [[nodiscard]] double length() const { return to - from; }
};

/// Where liner k is divided: at blocks, which end no nearer to each other than half of the spacing, and evenly between. Parts without rock have stations, too.
std::vector<LinerCell> liner_cells(const RunSetup& setup, std::size_t k);

/// m of a wall that have rock on the right.
double rock_beside(const RunSetup& setup, const loading::Liner& liner);

/// The bodies of all liners, after those of bolts. Stations beside each other are of different bodies.
void add_liner_lines(const RunSetup& setup, std::vector<dynamics::LineBody>& lines);

/// Nothing where there is none.
std::shared_ptr<const dynamics::Coupling> liner_coupling(const RunSetup& setup, const dynamics::Model& model);

}  // namespace keyblock::simulation
