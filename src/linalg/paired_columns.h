#pragma once
#include "core/lanes.h"
#include "linalg/registers.h"

namespace keyblock::linalg {

/// Blocks of 6 × 6 numbers in single precision, column by column without padding: as few bytes as they take, and two columns at once where
/// registers have room for them. Vectors of 6 have a register of eight, the last two zero. A block is read 4 numbers beyond its end, which
/// have to be there and finite. As with the other kernels, each lane is computed on its own and sums have a fixed order.
namespace paired_columns {

inline constexpr int rows = 6, block_size = rows * rows, read_beyond = 4;

#if defined(__AVX512F__)

using PairLanes = SixteenLanes;

inline PairLanes load_pair(const float* p) {
  return *reinterpret_cast<const LooseSixteenLanes*>(p);
}

/// x by rows, for either column.
class Rows {
 public:
  explicit Rows(NarrowLanes x)
      : of_pair_(__builtin_shufflevector(x, NarrowLanes{}, 0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5, 8, 8, 8, 8)) {}
  [[nodiscard]] PairLanes of_pair() const { return of_pair_; }

 private:
  PairLanes of_pair_;
};

/// Products of the numbers of blocks with those of vectors by rows, added up, and the sums of their columns: what transposed blocks make
/// of the vectors.
class RowProducts {
 public:
  void add(const float* block, Rows x) {
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k)
      pair_[k] = _mm512_fmadd_ps(load_pair(block + 2 * k * rows), x.of_pair(), pair_[k]);
  }
  /// (t₀ + t₃) + (t₁ + t₄) + (t₂ + t₅) of each column t.
  [[nodiscard]] NarrowLanes sums() const {
    PairLanes half[3];  // of either column, three sums of two
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k)
      half[k] = pair_[k] + __builtin_shufflevector(pair_[k], pair_[k], 3, 4, 5, 15, 15, 15, 9, 10, 11, 15, 15,
                                                   15, 15, 15, 15, 15);
    const PairLanes four =
        __builtin_shufflevector(half[0], half[1], 0, 1, 2, 6, 7, 8, 16, 17, 18, 22, 23, 24, 15, 15, 15, 15);
    const auto of = [&]<int r>() {
      return __builtin_shufflevector(four, half[2], r, r + 3, r + 6, r + 9, r + 16, r + 22, 15, 15);
    };
    return (of.operator()<0>() + of.operator()<1>()) + of.operator()<2>();
  }

 private:
  PairLanes pair_[3]{};
};

/// The numbers of a vector x, each for all rows of its column.
class Factors {
 public:
  explicit Factors(NarrowLanes x) : of_pair_{pair<0>(x), pair<2>(x), pair<4>(x)} {}
  /// block · x
  [[nodiscard]] NarrowLanes product(const float* block) const {
    PairLanes t = load_pair(block) * of_pair_[0];
#pragma GCC unroll 2
    for (int k = 1; k < 3; ++k) t = _mm512_fmadd_ps(load_pair(block + 2 * k * rows), of_pair_[k], t);
    return __builtin_shufflevector(t, t, 0, 1, 2, 3, 4, 5, 15, 15) +
           __builtin_shufflevector(t, t, 6, 7, 8, 9, 10, 11, 15, 15);
  }

 private:
  template <int c>
  static PairLanes pair(NarrowLanes x) {
    return __builtin_shufflevector(x, NarrowLanes{}, c, c, c, c, c, c, c + 1, c + 1, c + 1, c + 1, c + 1,
                                   c + 1, 8, 8, 8, 8);
  }
  PairLanes of_pair_[3];
};

#else

// The same, to the bit, a column at a time.

using Rows = NarrowLanes;

class RowProducts {
 public:
  void add(const float* block, Rows x) {
#pragma GCC unroll 6
    for (int c = 0; c < rows; ++c) column_[c] = add_product(load(block + c * rows), x, column_[c]);
  }
  [[nodiscard]] NarrowLanes sums() const {
    NarrowLanes half[rows];
#pragma GCC unroll 6
    for (int c = 0; c < rows; ++c)
      half[c] = column_[c] + __builtin_shufflevector(column_[c], column_[c], 3, 4, 5, 3, 3, 3, 3, 3);
    // Columns 0 and 4 in the two halves of a register, 1 and 5, 2, 3; pairs of their numbers; then rows.
    const auto halves = [](NarrowLanes low, NarrowLanes high) {
      return __builtin_shufflevector(low, high, 0, 1, 2, 3, 8, 9, 10, 11);
    };
    const auto first_pairs = [](NarrowLanes x, NarrowLanes y) {
      return __builtin_shufflevector(x, y, 0, 8, 1, 9, 4, 12, 5, 13);
    };
    const auto last_pairs = [](NarrowLanes x, NarrowLanes y) {
      return __builtin_shufflevector(x, y, 2, 10, 3, 11, 6, 14, 7, 15);
    };
    const auto first_twos = [](NarrowLanes x, NarrowLanes y) {
      return __builtin_shufflevector(x, y, 0, 1, 8, 9, 4, 5, 12, 13);
    };
    const auto last_twos = [](NarrowLanes x, NarrowLanes y) {
      return __builtin_shufflevector(x, y, 2, 3, 10, 11, 6, 7, 14, 15);
    };
    const NarrowLanes zero{}, c04 = halves(half[0], half[4]), c15 = halves(half[1], half[5]),
                              c2 = halves(half[2], zero), c3 = halves(half[3], zero);
    const NarrowLanes c0145 = first_pairs(c04, c15), c23 = first_pairs(c2, c3);
    const NarrowLanes row_0 = first_twos(c0145, c23), row_1 = last_twos(c0145, c23),
                      row_2 = first_twos(last_pairs(c04, c15), last_pairs(c2, c3));
    return (row_0 + row_1) + row_2;
  }

 private:
  NarrowLanes column_[rows]{};
};

class Factors {
 public:
  explicit Factors(NarrowLanes x)
      : column_{broadcast(x[0]), broadcast(x[1]), broadcast(x[2]),
                broadcast(x[3]), broadcast(x[4]), broadcast(x[5])} {}
  [[nodiscard]] NarrowLanes product(const float* block) const {
    NarrowLanes even = load(block) * column_[0], odd = load(block + rows) * column_[1];
#pragma GCC unroll 2
    for (int c = 2; c < rows; c += 2) {
      even = add_product(load(block + c * rows), column_[c], even);
      odd = add_product(load(block + (c + 1) * rows), column_[c + 1], odd);
    }
    return __builtin_shufflevector(even + odd, NarrowLanes{}, 0, 1, 2, 3, 4, 5, 8, 8);
  }

 private:
  NarrowLanes column_[rows];
};

#endif

}  // namespace paired_columns

}  // namespace keyblock::linalg
