#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace keyblock::linalg {

/// The blocks of a system in the order of its partition, and where each has its numbers in vectors. Everything is by position in that order.
/// Vectors of an iteration are padded as blocks are.
class BlockOrder {
 public:
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs);
  [[nodiscard]] std::size_t blocks() const { return size.size(); }
  /// Positions [0, between()) lie between the parts.
  [[nodiscard]] std::size_t between() const { return begin[1]; }

  std::vector<std::size_t> position;  ///< block → position
  std::vector<int> block_at;          ///< position → block
  std::vector<std::size_t> begin;     ///< Partition::begin
  std::vector<int> size, stride;      ///< unknowns, and padded
  std::vector<std::size_t> offset;    ///< start of its unknowns in a vector of the caller
  std::vector<std::size_t> start;     ///< into padded vectors
  std::size_t padded = 0;             ///< numbers of a padded vector
  int largest = 0;                    ///< stride of a block
  bool all_of_six = false;            ///< all blocks have 6 unknowns

 private:
  void place_vectors(std::span<const int> sizes);
};

}  // namespace keyblock::linalg
