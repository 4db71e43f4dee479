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

inline Lanes widen(NarrowLanes v) {
#if defined(__AVX512F__)
  // One instruction; compilers make five of the general form.
  return _mm512_maskz_cvtps_pd(0xff, v);
#else
  return __builtin_convertvector(v, Lanes);
#endif
}
inline NarrowLanes narrow(Lanes v) {
  return __builtin_convertvector(v, NarrowLanes);
}

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
inline Lanes add_product(Lanes a, Lanes b, Lanes c) {
#if defined(__AVX512F__)
  return _mm512_fmadd_pd(a, b, c);
#elif defined(__FMA__)
  using Half = double __attribute__((vector_size(row_padding / 2 * sizeof(double))));
  const auto low = [](Lanes v) { return Half{v[0], v[1], v[2], v[3]}; };
  const auto high = [](Lanes v) { return Half{v[4], v[5], v[6], v[7]}; };
  const Half x = _mm256_fmadd_pd(low(a), low(b), low(c)), y = _mm256_fmadd_pd(high(a), high(b), high(c));
  return Lanes{x[0], x[1], x[2], x[3], y[0], y[1], y[2], y[3]};
#else
  for (int k = 0; k < row_padding; ++k) c[k] = std::fma(a[k], b[k], c[k]);
  return c;
#endif
}
inline NarrowLanes add_product(NarrowLanes a, NarrowLanes b, NarrowLanes c) {
#if defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  for (int k = 0; k < row_padding; ++k) c[k] = std::fma(a[k], b[k], c[k]);
  return c;
#endif
}
#if defined(__AVX512F__)
inline SixteenLanes add_product(SixteenLanes a, SixteenLanes b, SixteenLanes c) {
  return _mm512_fmadd_ps(a, b, c);
}
#endif
#if defined(__FMA__) && !defined(__AVX512F__)
#define KEYBLOCK_HALF_LANES
/// Where a register has room for four numbers, kernels work on halves of lanes, which compilers take apart number by number otherwise.
using HalfLanes = double __attribute__((vector_size(4 * sizeof(double)), aligned(8)));
inline HalfLanes add_product(HalfLanes a, HalfLanes b, HalfLanes c) {
  return _mm256_fmadd_pd(a, b, c);
}
inline HalfLanes load_half(const double* p) {
  return *reinterpret_cast<const HalfLanes*>(p);
}
inline HalfLanes load_half(const float* p) {
  return _mm256_cvtps_pd(_mm_loadu_ps(p));
}
#endif
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
  static Register load_from(const float* p) { return *reinterpret_cast<const SixteenLanes*>(p); }
  static void store_to(float* p, Register v) { *reinterpret_cast<SixteenLanes*>(p) = v; }
  static Register all(float x) { return _mm512_set1_ps(x); }
};
#elif defined(KEYBLOCK_HALF_LANES)
template <int stride>
struct Registers<double, stride> {
  using Register = HalfLanes;
  template <typename Stored>
  static Register load_from(const Stored* p) {
    return load_half(p);
  }
  static void store_to(double* p, Register v) { *reinterpret_cast<HalfLanes*>(p) = v; }
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
/// Products added up lane by lane, and the sums of up to eight of them.
#if defined(KEYBLOCK_HALF_LANES)
struct LaneProducts {
  HalfLanes low, high;
};
inline double sum(const LaneProducts& t) {
  const auto of = [](HalfLanes v) { return (v[0] + v[1]) + (v[2] + v[3]); };
  return of(t.low) + of(t.high);
}
template <int count>
Lanes sums(const LaneProducts (&t)[count]) {
  Lanes v{};
  for (int k = 0; k < count; ++k) v[k] = sum(t[k]);
  return v;
}
template <typename Stored>
void add_lane_product(const Stored* a, const double* x, LaneProducts& t) {
  t.low = add_product(load_half(a), load_half(x), t.low);
  t.high = add_product(load_half(a + 4), load_half(x + 4), t.high);
}
#else
using LaneProducts = Lanes;
template <typename Stored>
void add_lane_product(const Stored* a, const double* x, Lanes& t) {
  t = add_product(Registers<double, row_padding>::load_from(a), load(x), t);
}
#endif
inline void add_lane_product(const float* a, const float* x, NarrowLanes& t) {
  t = add_product(load(a), load(x), t);
}

}  // namespace keyblock::linalg
