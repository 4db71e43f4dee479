#include "loading/time_table.h"

#include <algorithm>

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

}  // namespace keyblock::loading
