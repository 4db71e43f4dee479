#include "record/break_records.h"

#include <algorithm>
#include <tuple>

namespace keyblock::record {

void count_break(const BreakRecord& row, std::vector<BreakCount>& counts) {
  const auto key = [](const auto& r) { return std::tuple(r.kind, r.index, r.element, r.mode); };
  auto count = std::ranges::find(counts, key(row), key);
  if (count == counts.end()) {
    count = counts.insert(count, {.kind = row.kind,
                                  .mode = row.mode,
                                  .index = row.index,
                                  .element = row.element,
                                  .first = row.time,
                                  .first_stage = row.stage});
  }
  ++count->events;
  count->length += row.length;
  count->last = row.time;
  count->last_stage = row.stage;
}

}  // namespace keyblock::record
