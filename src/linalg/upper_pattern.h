#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "linalg/block_order.h"

namespace keyblock::linalg {

/// Where the blocks of a ScaledMatrix are: on the diagonal, and above it column by column, in the order of a BlockOrder.
///
/// Of a column, the blocks in rows between the parts come first. Parts may be worked on at the same time, and would all write to these rows;
/// so the rows between the parts gather, by row_entries, what columns in parts give them.
class UpperPattern {
 public:
  void analyse(const BlockOrder& order, std::span<const std::pair<int, int>> pairs);
  /// Positions that a position is coupled with.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::size_t j) const {
    return std::span(neighbour).subspan(neighbour_start[j], neighbour_start[j + 1] - neighbour_start[j]);
  }
  /// Numbers of block (i, j) of U.
  [[nodiscard]] static std::size_t scaled_count(const BlockOrder& order, std::size_t i, std::size_t j);

  std::vector<std::uint32_t> neighbour;      ///< positions, by position
  std::vector<std::size_t> neighbour_start;  ///< per position
  std::vector<std::uint32_t> row;            ///< of each block above the diagonal, < column
  std::vector<std::uint32_t> column_start;   ///< per column, into row
  std::vector<std::uint32_t> own_start;      ///< per column: the first whose row lies in the same part
  std::vector<std::size_t>
      diagonal;  ///< per column, into the values of A: A_jj, followed by what is above it
  std::vector<std::size_t> above_start;    ///< per column, into U
  std::vector<std::size_t> inverse_start;  ///< per column, into what the diagonal blocks are scaled by
  /// A block of a row between the parts whose column lies in one of them.
  struct RowEntry {
    std::size_t column;
    std::size_t values, above;  ///< into A and U
    std::size_t copy;           ///< into the copy of U by rows
  };
  std::vector<std::size_t> row_start;   ///< per position between the parts, into row_entries
  std::vector<RowEntry> row_entries;    ///< of a row, by columns
  std::vector<std::size_t> pair_value;  ///< per pair: its block, into A
  std::size_t values = 0, inverses = 0, scaled = 0,
              copied = 0;  ///< numbers of A, its diagonal, U, and the copy

 private:
  void find_neighbours(const BlockOrder& order, std::span<const std::pair<int, int>> pairs);
  void place_blocks(const BlockOrder& order, std::span<const std::pair<int, int>> pairs);
};

}  // namespace keyblock::linalg
