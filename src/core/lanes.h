#pragma once
#if defined(__AVX512F__)
#include "core/lanes_whole.h"
#else
#include "core/lanes_halves.h"
#endif

/// Numbers that are computed at once: each lane on its own and sums always in the same order, so that any instruction set gives the
/// same bits.
namespace keyblock {

inline constexpr int lane_count = 8;
static_assert(sizeof(Lanes) == lane_count * sizeof(double));
using NarrowLanes = float __attribute__((vector_size(lane_count * sizeof(float))));
using LooseNarrowLanes __attribute__((aligned(4))) = NarrowLanes;

inline NarrowLanes load(const float* p) {
  return *reinterpret_cast<const LooseNarrowLanes*>(p);
}
inline void store(float* p, NarrowLanes v) {
  *reinterpret_cast<LooseNarrowLanes*>(p) = v;
}
/// Calls what(first, count) for `n` numbers, as many at once as there are lanes.
template <typename Do>
void in_lanes(int n, const Do& what) {
  for (int k = 0; k < n; k += lane_count) what(k, n - k < lane_count ? n - k : lane_count);
}
/// number(i) in lane i.
template <typename Number>
Lanes each_lane(const Number& number) {
  return lanes_from(number(0), number(1), number(2), number(3), number(4), number(5), number(6), number(7));
}
inline Lanes broadcast(double x) {
  return lanes_from(x, x, x, x, x, x, x, x);
}
inline NarrowLanes broadcast(float x) {
  return NarrowLanes{x, x, x, x, x, x, x, x};
}

/// One or the other, of a number as of each lane.
inline double where(bool condition, double yes, double no) {
  return condition ? yes : no;
}
inline Lanes least(Lanes a, Lanes b) {
  return where(b < a, b, a);
}
inline Lanes largest(Lanes a, Lanes b) {
  return where(a < b, b, a);
}
/// The largest of all lanes.
inline double largest(Lanes v) {
  double x = v[0];
  for (int i = 1; i < lane_count; ++i) x = x < v[i] ? v[i] : x;
  return x;
}

/// Of all lanes.
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

}  // namespace keyblock
