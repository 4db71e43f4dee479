#include "coupling/row_owners.h"

#include <algorithm>

namespace keyblock::dynamics {

void RowOwners::find_ranges(ThreadTeam& team) {
  if (team.size() == 1) return;
  unknowns_of_piece_.resize((rows_ + piece - 1) / piece);
  team.for_range(unknowns_of_piece_.size(), contacts_worth_threads / piece,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t p = begin; p < end; ++p) {
                     std::pair<int, int> range{std::numeric_limits<int>::max(), -1};
                     for (std::size_t c = p * piece; c < std::min(rows_, (p + 1) * piece); ++c) {
                       for (const int unknown : {unknowns_of_row_[c].first, unknowns_of_row_[c].second}) {
                         if (unknown < 0) continue;  // fixed
                         range = {std::min(range.first, unknown), std::max(range.second, unknown)};
                       }
                     }
                     unknowns_of_piece_[p] = range;
                   }
                 });
}

}  // namespace keyblock::dynamics
