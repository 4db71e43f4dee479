#pragma once
#include <cmath>
#include <cstddef>
#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace keyblock {

/// Numbers that are computed at once: each lane on its own, so that any instruction set gives the same bits.
inline constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double)), aligned(8)));
/// The same where it is stored by itself: compilers take no type of another alignment than its own for an argument of a template.
using AlignedLanes = double __attribute__((vector_size(lane_count * sizeof(double))));
using NarrowLanes = float __attribute__((vector_size(lane_count * sizeof(float)), aligned(4)));
#if defined(__AVX512F__)
/// As many as a register has room for; where it has less, the same is done in two.
using SixteenLanes = float __attribute__((vector_size(16 * sizeof(float)), aligned(4)));
#endif

inline Lanes load(const double* p) {
  return *reinterpret_cast<const Lanes*>(p);
}
inline NarrowLanes load(const float* p) {
  return *reinterpret_cast<const NarrowLanes*>(p);
}
inline void store(double* p, Lanes v) {
  *reinterpret_cast<Lanes*>(p) = v;
}
inline void store(float* p, NarrowLanes v) {
  *reinterpret_cast<NarrowLanes*>(p) = v;
}
/// Some of them, in the first lanes; the others are zero. Not by way of the stack, which would have a load wait for several stores.
inline Lanes load_first(const double* p, int count) {
#if defined(__AVX512F__)
  return _mm512_maskz_loadu_pd(static_cast<__mmask8>((1U << count) - 1U), p);
#else
  Lanes v{};
  for (int i = 0; i < count; ++i) v[i] = p[i];
  return v;
#endif
}
inline void store_first(double* p, Lanes v, int count) {
#if defined(__AVX512F__)
  _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1U << count) - 1U), v);
#else
  for (int i = 0; i < count; ++i) p[i] = v[i];
#endif
}
/// Calls what(first, count) for `n` numbers, as many at once as there are lanes.
template <typename Do>
void in_lanes(int n, const Do& what) {
  for (int k = 0; k < n; k += lane_count) what(k, n - k < lane_count ? n - k : lane_count);
}
inline Lanes broadcast(double x) {
  return Lanes{x, x, x, x, x, x, x, x};
}
inline NarrowLanes broadcast(float x) {
  return NarrowLanes{x, x, x, x, x, x, x, x};
}

inline Lanes square_root(Lanes v) {
#if defined(__AVX__)
  const __m256d low = _mm256_sqrt_pd(__builtin_shufflevector(v, v, 0, 1, 2, 3)),
                high = _mm256_sqrt_pd(__builtin_shufflevector(v, v, 4, 5, 6, 7));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
  for (int i = 0; i < lane_count; ++i) v[i] = std::sqrt(v[i]);
  return v;
#endif
}

/// Of each lane.
inline Lanes least(Lanes a, Lanes b) {
  return b < a ? b : a;
}
inline Lanes largest(Lanes a, Lanes b) {
  return a < b ? b : a;
}

/// Whether a lane is one of the first `count`.
inline auto first_lanes(std::size_t count) {
  return Lanes{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0} < broadcast(static_cast<double>(count));
}

/// Whether any lane of the outcome of a comparison is true.
template <typename Condition>
bool any(Condition condition) {
#if defined(__AVX512F__)
  static_assert(sizeof(condition) == sizeof(__m512i));
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(condition), reinterpret_cast<__m512i>(condition)) !=
         0;
#else
  auto one = condition[0];
  for (int i = 1; i < lane_count; ++i) one |= condition[i];
  return one != 0;
#endif
}

/// One or the other, of a number or of each lane.
inline double where(bool condition, double yes, double no) {
  return condition ? yes : no;
}
template <typename Condition>
AlignedLanes where(Condition condition, AlignedLanes yes, AlignedLanes no) {
  return condition ? yes : no;
}

/// The largest of all lanes.
inline double largest(Lanes v) {
  double x = v[0];
  for (int i = 1; i < lane_count; ++i) x = x < v[i] ? v[i] : x;
  return x;
}

/// Of all lanes, always in this order.
template <typename Register>
auto sum(Register v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

/// The sum of each of up to eight vectors, as sum() forms it.
template <typename Register, int count>
Register sums(const Register (&t)[count]) {
  static_assert(count <= lane_count);
  const auto at = [&](int k) { return k < count ? t[k] : Register{}; };
  const auto pairs = [](Register a, Register b) {
    return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14) +
           __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  };
  const auto fours = [](Register a, Register b) {
    return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13) +
           __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
  };
  const Register low = fours(pairs(at(0), at(1)), pairs(at(2), at(3))),
                 high = fours(pairs(at(4), at(5)), pairs(at(6), at(7)));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 8, 9, 10, 11) +
         __builtin_shufflevector(low, high, 4, 5, 6, 7, 12, 13, 14, 15);
}

/// Rows become columns.
inline void transpose(Lanes (&m)[lane_count]) {
  Lanes pairs[lane_count], fours[lane_count];
#pragma GCC unroll 4
  for (int r = 0; r < 8; r += 2) {  // [r]: columns 0 2 4 6 of rows r and r + 1, [r + 1]: columns 1 3 5 7
    pairs[r] = __builtin_shufflevector(m[r], m[r + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pairs[r + 1] = __builtin_shufflevector(m[r], m[r + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
#pragma GCC unroll 2
  for (int r = 0; r < 8; r += 4) {  // [r + c]: columns c and c + 4 of rows r … r + 3
#pragma GCC unroll 2
    for (int c = 0; c < 2; ++c) {
      fours[r + c] = __builtin_shufflevector(pairs[r + c], pairs[r + c + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      fours[r + c + 2] = __builtin_shufflevector(pairs[r + c], pairs[r + c + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) {
    m[c] = __builtin_shufflevector(fours[c], fours[c + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    m[c + 4] = __builtin_shufflevector(fours[c], fours[c + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace keyblock
