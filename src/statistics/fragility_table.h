#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "statistics/fragility.h"
#include "statistics/split.h"

/// The runs of a fragility curve as its parts see them.
namespace keyblock::statistics {

/// What runs that have something in common add to the stripes.
struct FragilityPart {
  std::size_t stripe;
  double runs, exceeded;
};
using FragilityParts = std::vector<FragilityPart>;

/// The runs as a table: stripes, and what each rock mass, record and pair adds to them. `at_rest`: those without shaking.
struct FragilityTable {
  std::vector<Stripe> stripes;
  std::map<int, FragilityParts> clusters, records;
  std::map<std::pair<int, int>, FragilityParts> pairs;
  Stripe at_rest;
};

FragilityTable tabulate(std::span<const Observation> runs);

/// The pairs of rock mass and record, each by the weakest intensity that exceeds the level.
struct ShakenPairs {
  std::vector<Pair> pairs;
  std::size_t not_monotone = 0;  ///< exceed the level there and not at a stronger one
  bool complete = true;          ///< every pair was run at every intensity
};
ShakenPairs shaken_pairs(const FragilityTable& table);

/// See Split. Of a curve that is fitted, with its refits.
Split split_of(const FragilityTable& table, const FragilityCurve& curve, const ShakenPairs& shaken,
               double confidence);

}  // namespace keyblock::statistics
