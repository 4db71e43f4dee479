#pragma once
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace keyblock::linalg {

/// Where the blocks of a factor L are, A = L Lᵀ: block columns in an order of elimination by approximate minimum degree on the graph of
/// blocks. Column j has its diagonal block first, then rows[row_start[j] … row_start[j + 1]), ascending. Blocks are stored by columns of
/// padded rows.
struct BlockPattern {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  BlockPattern() = default;
  /// As BlockSolver::analyse.
  BlockPattern(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs);
  [[nodiscard]] std::size_t columns() const { return size.size(); }
  /// Where the values of column j end.
  [[nodiscard]] std::size_t column_end(std::size_t j) const {
    return j + 1 < columns() ? column_value[j + 1] : values;
  }

  std::vector<std::size_t> position;   ///< block → column
  int equal_size = 0;                  ///< of all columns; 0: they differ
  std::vector<int> size, stride;       ///< per column
  std::vector<std::size_t> parent;     ///< per column, in the elimination tree; none: a root
  std::vector<std::size_t> above;      ///< per column: padded unknowns of all columns above it in that tree
  std::vector<std::size_t> row_start;  ///< per column, into rows and row_value
  std::vector<std::size_t> rows;
  std::vector<std::size_t> row_value;     ///< per row entry: the block, into the values
  std::vector<std::size_t> column_value;  ///< per column: the diagonal block, into the values
  std::size_t values = 0;                 ///< numbers of all blocks
  struct Update {
    std::size_t column;  ///< k < j with a block in row j
    std::size_t entry;   ///< that block, into rows
  };
  std::vector<std::size_t> update_start;  ///< per column, into updates
  std::vector<Update> updates;
  std::vector<std::size_t>
      offset;  ///< per column: start of its unknowns in a vector, as the caller orders them
  std::vector<std::size_t> work_start;  ///< per column: start in a vector by columns, padded
  std::size_t work_size = 0;            ///< of such a vector

 private:
  void find_structure(std::span<const std::pair<int, int>> pairs);
  void find_updates();
  void place_values();
};

}  // namespace keyblock::linalg
