#pragma once
#include <cmath>
#include <type_traits>

#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

#include "core/lanes.h"
#include "linalg/block_solver.h"

/// What kernels on blocks are made of: products fused with sums by name, and registers of the size that the machine has. Lanes are computed each on
/// its own and sums have a fixed order, so that any size gives the same bits.
namespace keyblock::linalg {

static_assert(row_padding == lane_count);

#if defined(__AVX512F__)
inline Lanes widen(NarrowLanes v) {
  // One instruction; compilers make five of the general form.
  return _mm512_maskz_cvtps_pd(0xff, v);
}
inline NarrowLanes narrow(Lanes v) {
  return __builtin_convertvector(v, NarrowLanes);
}
#else
using NarrowHalf = float __attribute__((vector_size(4 * sizeof(float))));
using LooseNarrowHalf __attribute__((aligned(4))) = NarrowHalf;
inline Lanes widen(NarrowLanes v) {
  const NarrowHalf low = __builtin_shufflevector(v, v, 0, 1, 2, 3),
                   high = __builtin_shufflevector(v, v, 4, 5, 6, 7);
  return {__builtin_convertvector(low, HalfLanes), __builtin_convertvector(high, HalfLanes)};
}
inline NarrowLanes narrow(Lanes v) {
  return __builtin_shufflevector(__builtin_convertvector(v.low, NarrowHalf),
                                 __builtin_convertvector(v.high, NarrowHalf), 0, 1, 2, 3, 4, 5, 6, 7);
}
#endif

inline Lanes load_wide(const double* p) {
  return load(p);
}
inline Lanes load_wide(const float* p) {
  return widen(load(p));
}
/// With as many digits as there is room for.
inline void store_rounded(double* p, Lanes v) {
  store(p, v);
}
inline void store_rounded(float* p, Lanes v) {
  store(p, narrow(v));
}

/// c + a b, rounded once.
#if defined(__AVX512F__)
inline Lanes add_product(Lanes a, Lanes b, Lanes c) {
  return _mm512_fmadd_pd(a, b, c);
}
inline SixteenLanes add_product(SixteenLanes a, SixteenLanes b, SixteenLanes c) {
  return _mm512_fmadd_ps(a, b, c);
}
#else
inline HalfLanes add_product(HalfLanes a, HalfLanes b, HalfLanes c) {
#if defined(__FMA__)
  return _mm256_fmadd_pd(a, b, c);
#else
  for (int k = 0; k < 4; ++k) c[k] = std::fma(a[k], b[k], c[k]);
  return c;
#endif
}
inline Lanes add_product(Lanes a, Lanes b, Lanes c) {
  return {add_product(a.low, b.low, c.low), add_product(a.high, b.high, c.high)};
}
#endif
inline NarrowLanes add_product(NarrowLanes a, NarrowLanes b, NarrowLanes c) {
#if defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  for (int k = 0; k < row_padding; ++k) c[k] = std::fma(a[k], b[k], c[k]);
  return c;
#endif
}
/// c − a b, rounded once.
template <typename Register>
Register subtract_product(Register a, Register b, Register c) {
  return add_product(-a, b, c);
}

/// Registers for columns of `stride` numbers: as many floats at once as one has room for.
template <typename Number, int stride>
struct Registers {
  using Register = decltype(load(static_cast<const Number*>(nullptr)));
  /// Of a matrix, whose numbers may have fewer digits.
  template <typename Stored>
  static Register load_from(const Stored* p) {
    if constexpr (std::is_same_v<Number, Stored>) {
      return load(p);
    } else {
      return widen(load(p));
    }
  }
  static void store_to(Number* p, Register v) { store(p, v); }
  static Register all(Number x) { return broadcast(x); }
};
#if defined(__AVX512F__)
template <>
struct Registers<float, 16> {
  using Register = SixteenLanes;
  static Register load_from(const float* p) { return *reinterpret_cast<const LooseSixteenLanes*>(p); }
  static void store_to(float* p, Register v) { *reinterpret_cast<LooseSixteenLanes*>(p) = v; }
  static Register all(float x) { return _mm512_set1_ps(x); }
};
#else
/// Halves one by one: as many as kernels hold fill the registers there are.
template <int stride>
struct Registers<double, stride> {
  using Register = HalfLanes;
  static Register load_from(const double* p) { return load_half(p); }
  static Register load_from(const float* p) {
    return __builtin_convertvector(*reinterpret_cast<const LooseNarrowHalf*>(p), HalfLanes);
  }
  static void store_to(double* p, Register v) { store_half(p, v); }
  static Register all(double x) { return HalfLanes{x, x, x, x}; }
};
#endif

/// The first `count` numbers of v to `out`, where `room` numbers may be overwritten.
template <int count, typename Number, typename Register>
void store_first(Number* out, int room, Register v) {
  if (room >= row_padding) return store(out, v);
  for (int k = 0; k < count; ++k) out[k] = v[k];
}
/// The same, taken away from what is there.
template <int count, typename Number, typename Register>
void subtract_first(Number* out, int room, Register v) {
  if (room >= row_padding) return store(out, load(out) - v);
  for (int k = 0; k < count; ++k) out[k] -= v[k];
}

using keyblock::sum;
using keyblock::sums;
/// t += a ∘ x: products added up lane by lane.
template <typename Stored>
void add_lane_product(const Stored* a, const double* x, Lanes& t) {
  t = add_product(load_wide(a), load(x), t);
}
inline void add_lane_product(const float* a, const float* x, NarrowLanes& t) {
  t = add_product(load(a), load(x), t);
}

}  // namespace keyblock::linalg
