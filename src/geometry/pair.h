#pragma once
#include "geometry/vec2.h"

namespace keyblock {

/// The two components of a vector, computed at once: what Vec2 gives one by one, to the last bit, in half the instructions.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));
/// The same among other numbers in memory, at any place.
using LoosePair __attribute__((aligned(8))) = Pair;

inline Pair load_pair(const double* xy) {
  return *reinterpret_cast<const LoosePair*>(xy);
}
inline Pair load_pair(const Vec2& v) {
  return load_pair(&v.x);
}
inline void store_pair(double* xy, Pair v) {
  *reinterpret_cast<LoosePair*>(xy) = v;
}
inline void store_pair(Vec2& out, Pair v) {
  store_pair(&out.x, v);
}
inline Pair pair_of(Vec2 v) {
  return Pair{v.x, v.y};
}
inline Vec2 vec2_of(Pair v) {
  return {v[0], v[1]};
}
inline Pair lerp(Pair a, Pair b, double s) {
  return (1.0 - s) * a + s * b;
}

}  // namespace keyblock
