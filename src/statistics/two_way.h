#pragma once
#include <vector>

#include "statistics/interval.h"

/// Intervals over rock masses and records: what is estimated hangs on both, and runs that share one of them are not independent.
///
/// Two-way jackknife. g is what is estimated from all runs, g₍₋ᵢ₎ the same without one rock mass, without one record, and
/// without one pair of both. With c such numbers of a kind
///
///   V_kind = (c − 1)/c Σ (g₍₋ᵢ₎ − g)²,     V = max(V_rock + V_record − V_pair, V_rock, V_record)
///
/// and the interval g ± t √V, t of Student's distribution with min(rock masses, records) − 1 degrees of freedom (MacKinnon,
/// Nielsen & Webb 2024, "Jackknife inference with two-way clustering"; the linear form is that of Cameron, Gelbach & Miller 2011).
/// Where there is one record, V = V_rock, and the interval is for this record alone; one rock mass likewise.
namespace keyblock::statistics {

/// Estimates without a rock mass, a record, a pair. No pairs: V_pair is taken for 0, which is on the safe side.
struct LeftOut {
  std::vector<double> rocks, records, pairs;
};

/// Parts of the variance of an estimate, those above.
struct TwoWayVariance {
  double rock = not_a_number, record = not_a_number, pair = not_a_number;
  double total = not_a_number;
};
TwoWayVariance two_way_variance(double whole, const LeftOut& without);

/// Of Student's distribution; 0 where nothing can be said.
int two_way_degrees(const LeftOut& without);

/// g ± t √V. Without an interval where an estimate without something is no number.
Estimate two_way_interval(double whole, const LeftOut& without, double confidence);

}  // namespace keyblock::statistics
