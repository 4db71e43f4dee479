#pragma once
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

/// Which thread adds what the rows do to a block. Threads have blocks of their own, and what rows add to a block is added by its owner, in
/// the order of the rows, so that the sums are the same for any number of threads.
class RowOwners {
 public:
  /// Some of the unknown blocks: those of a thread.
  struct Owner {
    int begin = -1, end = std::numeric_limits<int>::max();  ///< all, fixed ones too
    [[nodiscard]] bool has(int unknown) const { return unknown >= begin && unknown < end; }
  };

  /// At the start of a step. One thread needs to know nothing.
  void resize(std::size_t rows, const ThreadTeam& team) {
    rows_ = rows;
    if (team.size() > 1) unknowns_of_row_.resize(rows);
  }
  /// Block::unknown of the two blocks of a row.
  void set(std::size_t row, int a, int b) {
    if (!unknowns_of_row_.empty()) unknowns_of_row_[row] = {a, b};
  }
  /// After all rows are set.
  void find_ranges(ThreadTeam& team);

  /// Calls add(row, owner) for the rows that have a block of the owner, for all owners. Rows come by their smaller block, so that most
  /// pieces of them belong to one owner.
  template <typename Add>
  void for_rows(std::size_t blocks, ThreadTeam& team, const Add& add) const {
    if (team.size() == 1 || rows_ < contacts_worth_threads) {
      for (std::size_t c = 0; c < rows_; ++c) add(c, Owner{});
      return;
    }
    team.for_range(blocks, 1, [&](std::size_t begin, std::size_t end) {
      const Owner owner{static_cast<int>(begin), static_cast<int>(end)};
      for (std::size_t p = 0; p < unknowns_of_piece_.size(); ++p) {
        const auto [least, most] = unknowns_of_piece_[p];
        if (most < owner.begin || least >= owner.end) continue;
        for (std::size_t c = p * piece; c < std::min(rows_, (p + 1) * piece); ++c) {
          const auto [a, b] = unknowns_of_row_[c];
          if (owner.has(a) || owner.has(b)) add(c, owner);
        }
      }
    });
  }

 private:
  static constexpr std::size_t piece = 256;  ///< rows

  std::size_t rows_ = 0;
  std::vector<std::pair<int, int>> unknowns_of_row_;    ///< to look through
  std::vector<std::pair<int, int>> unknowns_of_piece_;  ///< least and largest of so many rows
};

}  // namespace keyblock::dynamics
