#include "loading/time_table.h"

#include <algorithm>
#include <cmath>

namespace keyblock::loading {

double TimeTable::operator()(double time) const {
  const auto next = std::upper_bound(rows_.begin(), rows_.end(), time,
                                     [](double t, const auto& row) { return t < row.first; });
  if (next == rows_.begin()) return rows_.front().second;
  if (next == rows_.end()) return rows_.back().second;
  const auto& [t0, f0] = *(next - 1);
  const auto& [t1, f1] = *next;
  return f0 + (f1 - f0) * (time - t0) / (t1 - t0);
}

std::optional<double> TimeTable::last_change() const {
  constexpr double alike = 1e-6;  // of the largest value
  double largest = 0.0;
  for (const auto& [time, value] : rows_) largest = std::max(largest, std::abs(value));
  for (std::size_t k = rows_.size(); k-- > 1;) {
    if (std::abs(rows_[k - 1].second - rows_.back().second) > alike * largest) return rows_[k].first;
  }
  return std::nullopt;
}

}  // namespace keyblock::loading
