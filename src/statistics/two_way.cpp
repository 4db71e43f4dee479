#include "statistics/two_way.h"

#include <algorithm>
#include <cmath>

#include "statistics/distributions.h"

namespace keyblock::statistics {

namespace {

double part_of(double whole, const std::vector<double>& without) {
  const auto c = static_cast<double>(without.size());
  double squares = 0.0;
  for (const double g : without) squares += (g - whole) * (g - whole);
  return (c - 1.0) / c * squares;
}

}  // namespace

TwoWayVariance two_way_variance(double whole, const LeftOut& without) {
  TwoWayVariance v;
  if (without.rocks.size() > 1) v.total = v.rock = part_of(whole, without.rocks);
  if (without.records.size() > 1) v.total = v.record = part_of(whole, without.records);
  if (std::isnan(v.rock) || std::isnan(v.record)) return v;
  v.pair = without.pairs.empty() ? 0.0 : part_of(whole, without.pairs);
  v.total = std::max({v.rock + v.record - v.pair, v.rock, v.record});
  return v;
}

int two_way_degrees(const LeftOut& without) {
  const auto rocks = static_cast<int>(without.rocks.size()),
             records = static_cast<int>(without.records.size());
  if (rocks < 2 || records < 2) return std::max({rocks, records, 1}) - 1;
  return std::min(rocks, records) - 1;
}

Estimate two_way_interval(double whole, const LeftOut& without, double confidence) {
  const int degrees = two_way_degrees(without);
  const double variance = two_way_variance(whole, without).total;
  if (degrees < 1 || !std::isfinite(variance)) return {whole, not_a_number, not_a_number};
  const double half = student_t(confidence, degrees) * std::sqrt(variance);
  return {whole, whole - half, whole + half};
}

}  // namespace keyblock::statistics
