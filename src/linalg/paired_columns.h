#pragma once
#include <cmath>

#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

#include "core/lanes.h"

namespace keyblock::linalg {

/// Blocks of 6 × 6 numbers in single precision, column by column without padding, two columns to a register: as few bytes and as few
/// instructions as they take. Vectors of 6 have a register of eight, the last two zero. A block is read 4 numbers beyond its end, which have
/// to be there and finite. As with the other kernels, each lane is computed on its own and sums have a fixed order.
namespace paired_columns {

inline constexpr int rows = 6, block_size = rows * rows, read_beyond = 4;
using PairLanes = float __attribute__((vector_size(16 * sizeof(float)), aligned(4)));

inline PairLanes load_pair(const float* p) {
  return *reinterpret_cast<const PairLanes*>(p);
}

/// c + a b, rounded once.
inline PairLanes add_product(PairLanes a, PairLanes b, PairLanes c) {
#if defined(__AVX512F__)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(__FMA__)
  const auto low = [](PairLanes v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7); };
  const auto high = [](PairLanes v) { return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15); };
  const NarrowLanes x = _mm256_fmadd_ps(low(a), low(b), low(c)),
                    y = _mm256_fmadd_ps(high(a), high(b), high(c));
  return __builtin_shufflevector(x, y, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
  for (int k = 0; k < 16; ++k) c[k] = std::fma(a[k], b[k], c[k]);
  return c;
#endif
}

/// x for either column.
inline PairLanes for_both(NarrowLanes x) {
  return __builtin_shufflevector(x, NarrowLanes{}, 0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5, 8, 8, 8, 8);
}

/// Products of the numbers of a block with those of x by rows, added to t; x from for_both().
inline void add_row_products(const float* block, PairLanes x, PairLanes (&t)[3]) {
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) t[k] = add_product(load_pair(block + 2 * k * rows), x, t[k]);
}

/// Sums of the six columns of t: (t₀ + t₃) + (t₁ + t₄) + (t₂ + t₅).
inline NarrowLanes column_sums(const PairLanes (&t)[3]) {
  PairLanes half[3];  // of either column, three sums of two
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k)
    half[k] = t[k] +
              __builtin_shufflevector(t[k], t[k], 3, 4, 5, 15, 15, 15, 9, 10, 11, 15, 15, 15, 15, 15, 15, 15);
  const PairLanes four =
      __builtin_shufflevector(half[0], half[1], 0, 1, 2, 6, 7, 8, 16, 17, 18, 22, 23, 24, 15, 15, 15, 15);
  const auto of = [&]<int r>() {
    return __builtin_shufflevector(four, half[2], r, r + 3, r + 6, r + 9, r + 16, r + 22, 15, 15);
  };
  return (of.operator()<0>() + of.operator()<1>()) + of.operator()<2>();
}

/// The numbers of x, each for all rows of its column.
struct Factors {
  PairLanes of_pair[3];
  explicit Factors(NarrowLanes x) : of_pair{pair<0>(x), pair<2>(x), pair<4>(x)} {}

 private:
  template <int c>
  static PairLanes pair(NarrowLanes x) {
    return __builtin_shufflevector(x, NarrowLanes{}, c, c, c, c, c, c, c + 1, c + 1, c + 1, c + 1, c + 1,
                                   c + 1, 8, 8, 8, 8);
  }
};

/// block · x
inline NarrowLanes product(const float* block, const Factors& x) {
  PairLanes t = load_pair(block) * x.of_pair[0];
#pragma GCC unroll 2
  for (int k = 1; k < 3; ++k) t = add_product(load_pair(block + 2 * k * rows), x.of_pair[k], t);
  return __builtin_shufflevector(t, t, 0, 1, 2, 3, 4, 5, 15, 15) +
         __builtin_shufflevector(t, t, 6, 7, 8, 9, 10, 11, 15, 15);
}

}  // namespace paired_columns

}  // namespace keyblock::linalg
