#include "report/thinning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace keyblock::report {

std::vector<std::size_t> thin_by_stage(std::span<const int> stage_of, std::size_t limit) {
  const std::size_t n = stage_of.size();
  std::set<std::size_t> kept;
  for (std::size_t i = 0; i < n; ++i)
    if (i == 0 || i + 1 == n || stage_of[i] != stage_of[i - 1] || stage_of[i] != stage_of[i + 1])
      kept.insert(i);
  const std::size_t others = n <= limit ? n : limit - std::min(limit, kept.size());
  for (std::size_t k = 0; k < others; ++k) kept.insert(k * n / others);
  return {kept.begin(), kept.end()};
}

namespace {

// The smallest and the largest number in the order in which they occur; NaN where there is none.
std::pair<double, double> extremes(std::span<const double> values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double* low = nullptr;
  const double* high = nullptr;
  for (const double& v : values) {
    if (std::isnan(v)) continue;
    if (low == nullptr || v < *low) low = &v;
    if (high == nullptr || v >= *high) high = &v;
  }
  if (low == nullptr) return {none, none};
  return low <= high ? std::pair(*low, *high) : std::pair(*high, *low);
}

}  // namespace

Curves thin_curves(const Curves& curves, std::size_t limit) {
  const std::size_t n = curves.x.size();
  if (n <= limit || limit < 4) return curves;
  Curves thin;
  thin.columns.resize(curves.columns.size());
  const auto copy_row = [&](std::size_t i) {
    thin.x.push_back(curves.x[i]);
    for (std::size_t c = 0; c < curves.columns.size(); ++c) thin.columns[c].push_back(curves.columns[c][i]);
  };
  copy_row(0);
  const std::size_t buckets = (limit - 2) / 2;
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t begin = 1 + b * (n - 2) / buckets;
    const std::size_t end = 1 + (b + 1) * (n - 2) / buckets;
    thin.x.push_back(curves.x[begin]);
    thin.x.push_back(curves.x[end - 1]);
    for (std::size_t c = 0; c < curves.columns.size(); ++c) {
      const auto& column = curves.columns[c];
      const std::span<const double> bucket(column.data() + begin, end - begin);
      const auto [first, second] = extremes(bucket);
      thin.columns[c].push_back(first);
      thin.columns[c].push_back(second);
    }
  }
  copy_row(n - 1);
  return thin;
}

}  // namespace keyblock::report
