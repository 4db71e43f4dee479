#pragma once
#include <immintrin.h>

#include <cstddef>
#include <cstdint>

/// Lanes of machines whose registers have room for eight numbers (AVX-512).
namespace keyblock {

using Lanes = double __attribute__((vector_size(8 * sizeof(double))));
/// The same among other numbers in memory, at any place.
using LooseLanes __attribute__((aligned(8))) = Lanes;
/// What comparisons give: in each lane all bits or none.
using LaneCondition = decltype(Lanes{} < Lanes{});
/// As many as a register has room for.
using SixteenLanes = float __attribute__((vector_size(16 * sizeof(float))));
using LooseSixteenLanes __attribute__((aligned(4))) = SixteenLanes;

inline Lanes load(const double* p) {
  return *reinterpret_cast<const LooseLanes*>(p);
}
inline void store(double* p, Lanes v) {
  *reinterpret_cast<LooseLanes*>(p) = v;
}
inline Lanes lanes_from(double a, double b, double c, double d, double e, double f, double g, double h) {
  return Lanes{a, b, c, d, e, f, g, h};
}
inline Lanes where(LaneCondition condition, Lanes yes, Lanes no) {
  return condition ? yes : no;
}
/// Whether a lane is one of the first `count`.
inline LaneCondition first_lanes(std::size_t count) {
  const auto n = static_cast<double>(count);
  return Lanes{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0} < Lanes{n, n, n, n, n, n, n, n};
}
inline Lanes load_first(const double* p, int count) {
  return _mm512_maskz_loadu_pd(static_cast<__mmask8>((1U << count) - 1U), p);
}
inline void store_first(double* p, Lanes v, int count) {
  _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1U << count) - 1U), v);
}
/// In halves, which take no longer.
inline Lanes square_root(Lanes v) {
  const __m256d low = _mm256_sqrt_pd(__builtin_shufflevector(v, v, 0, 1, 2, 3)),
                high = _mm256_sqrt_pd(__builtin_shufflevector(v, v, 4, 5, 6, 7));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline bool any(LaneCondition condition) {
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(condition), reinterpret_cast<__m512i>(condition)) !=
         0;
}

/// As many codes, one in each lane.
inline LaneCondition lane_codes(const std::uint16_t* codes) {
  return reinterpret_cast<LaneCondition>(
      _mm512_maskz_cvtepu16_epi64(0xff, _mm_loadu_si128(reinterpret_cast<const __m128i*>(codes))));
}

/// Likewise, back.
inline void store_codes(std::uint16_t* codes, LaneCondition c) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(codes),
                   _mm512_maskz_cvtepi64_epi16(0xff, reinterpret_cast<__m512i>(c)));
}

/// Each number in the place of its neighbour: 1 0 3 2 …
inline Lanes swap_neighbours(Lanes v) {
  return __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6);
}
/// Every second number of both, a's first.
inline Lanes even_lanes(Lanes a, Lanes b) {
  return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
}
inline Lanes odd_lanes(Lanes a, Lanes b) {
  return __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
}

/// Rows become columns.
inline void transpose(Lanes (&m)[8]) {
  Lanes pairs[8], fours[8];
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
