#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#if defined(__AVX__)
#include <immintrin.h>
#endif

/// Lanes of machines whose registers have no room for eight numbers: two halves. Compilers take larger vectors apart, for most of what
/// is done with them number by number.
namespace keyblock {

using HalfLanes = double __attribute__((vector_size(4 * sizeof(double))));
/// The same at any place in memory.
using LooseHalf __attribute__((aligned(8))) = HalfLanes;

/// What comparisons give: in each lane all bits or none.
struct LaneCondition {
  using Half = std::int64_t __attribute__((vector_size(4 * sizeof(std::int64_t))));
  Half low, high;

  template <typename Index>
  std::int64_t operator[](Index i) const {
    return reinterpret_cast<const std::int64_t*>(this)[i];
  }
  template <typename Index>
  std::int64_t& operator[](Index i) {
    return reinterpret_cast<std::int64_t*>(this)[i];
  }
  friend LaneCondition operator&(LaneCondition a, LaneCondition b) {
    return {a.low & b.low, a.high & b.high};
  }
  friend LaneCondition operator|(LaneCondition a, LaneCondition b) {
    return {a.low | b.low, a.high | b.high};
  }
  friend LaneCondition operator&(LaneCondition a, std::int64_t b) { return {a.low & b, a.high & b}; }
  friend LaneCondition operator~(LaneCondition a) { return {~a.low, ~a.high}; }
  friend LaneCondition operator!=(LaneCondition a, LaneCondition b) {
    return {a.low != b.low, a.high != b.high};
  }
  LaneCondition& operator|=(LaneCondition b) { return *this = *this | b; }
};

struct Lanes {
  HalfLanes low, high;

  template <typename Index>
  double operator[](Index i) const {
    return reinterpret_cast<const double*>(this)[i];
  }
  template <typename Index>
  double& operator[](Index i) {
    return reinterpret_cast<double*>(this)[i];
  }
  friend Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
  friend Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.low - b.low, a.high - b.high}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {a.low / b.low, a.high / b.high}; }
  friend Lanes operator+(double a, Lanes b) { return {a + b.low, a + b.high}; }
  friend Lanes operator-(double a, Lanes b) { return {a - b.low, a - b.high}; }
  friend Lanes operator*(double a, Lanes b) { return {a * b.low, a * b.high}; }
  friend Lanes operator+(Lanes a, double b) { return {a.low + b, a.high + b}; }
  friend Lanes operator-(Lanes a, double b) { return {a.low - b, a.high - b}; }
  friend Lanes operator*(Lanes a, double b) { return {a.low * b, a.high * b}; }
  friend Lanes operator/(Lanes a, double b) { return {a.low / b, a.high / b}; }
  Lanes& operator+=(Lanes b) { return *this = *this + b; }
  Lanes& operator-=(Lanes b) { return *this = *this - b; }
  friend LaneCondition operator<(Lanes a, Lanes b) { return {a.low < b.low, a.high < b.high}; }
  friend LaneCondition operator<=(Lanes a, Lanes b) { return {a.low <= b.low, a.high <= b.high}; }
  friend LaneCondition operator>(Lanes a, Lanes b) { return b < a; }
  friend LaneCondition operator>=(Lanes a, Lanes b) { return b <= a; }
  friend LaneCondition operator<(Lanes a, double b) { return {a.low < b, a.high < b}; }
  friend LaneCondition operator<=(Lanes a, double b) { return {a.low <= b, a.high <= b}; }
  friend LaneCondition operator>(Lanes a, double b) { return {a.low > b, a.high > b}; }
  friend LaneCondition operator>=(Lanes a, double b) { return {a.low >= b, a.high >= b}; }
  friend LaneCondition operator==(Lanes a, double b) { return {a.low == b, a.high == b}; }
};

inline HalfLanes load_half(const double* p) {
  return *reinterpret_cast<const LooseHalf*>(p);
}
inline void store_half(double* p, HalfLanes v) {
  *reinterpret_cast<LooseHalf*>(p) = v;
}
inline Lanes load(const double* p) {
  return {load_half(p), load_half(p + 4)};
}
inline void store(double* p, Lanes v) {
  store_half(p, v.low);
  store_half(p + 4, v.high);
}
inline Lanes lanes_from(double a, double b, double c, double d, double e, double f, double g, double h) {
  return {HalfLanes{a, b, c, d}, HalfLanes{e, f, g, h}};
}
inline Lanes where(LaneCondition condition, Lanes yes, Lanes no) {
  return {condition.low ? yes.low : no.low, condition.high ? yes.high : no.high};
}

/// Whether a lane is one of the first `count`.
inline LaneCondition first_lanes(std::size_t count) {
  const auto n = static_cast<std::int64_t>(count);
  const LaneCondition::Half low{0, 1, 2, 3}, high{4, 5, 6, 7};
  return {low < n, high < n};
}

#if defined(__AVX__)
/// Where the second half of the first `count` numbers begins; any place will do where it has none, as none is touched. The address of a
/// number that is not there may not even be formed.
template <typename Number>
Number* second_half(Number* p, int count) {
  return count > 4 ? p + 4 : p;
}
inline Lanes load_first(const double* p, int count) {
  const LaneCondition mask = first_lanes(static_cast<std::size_t>(count));
  return {_mm256_maskload_pd(p, reinterpret_cast<__m256i>(mask.low)),
          _mm256_maskload_pd(second_half(p, count), reinterpret_cast<__m256i>(mask.high))};
}
inline void store_first(double* p, Lanes v, int count) {
  const LaneCondition mask = first_lanes(static_cast<std::size_t>(count));
  _mm256_maskstore_pd(p, reinterpret_cast<__m256i>(mask.low), v.low);
  _mm256_maskstore_pd(second_half(p, count), reinterpret_cast<__m256i>(mask.high), v.high);
}
inline Lanes square_root(Lanes v) {
  return {_mm256_sqrt_pd(v.low), _mm256_sqrt_pd(v.high)};
}
inline bool any(LaneCondition c) {
  return _mm256_testz_si256(reinterpret_cast<__m256i>(c.low), reinterpret_cast<__m256i>(c.low)) == 0 ||
         _mm256_testz_si256(reinterpret_cast<__m256i>(c.high), reinterpret_cast<__m256i>(c.high)) == 0;
}
#else
inline Lanes load_first(const double* p, int count) {
  Lanes v{};
  for (int i = 0; i < count; ++i) v[i] = p[i];
  return v;
}
inline void store_first(double* p, Lanes v, int count) {
  for (int i = 0; i < count; ++i) p[i] = v[i];
}
inline Lanes square_root(Lanes v) {
  for (int i = 0; i < 8; ++i) v[i] = std::sqrt(v[i]);
  return v;
}
inline bool any(LaneCondition c) {
  const LaneCondition::Half either = c.low | c.high;
  return (either[0] | either[1] | either[2] | either[3]) != 0;
}
#endif

/// As many codes, one in each lane.
inline LaneCondition lane_codes(const std::uint16_t* codes) {
#if defined(__AVX2__)
  const auto half = [](const std::uint16_t* p) {
    return reinterpret_cast<LaneCondition::Half>(
        _mm256_cvtepu16_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))));
  };
  return {half(codes), half(codes + 4)};
#else
  LaneCondition v;
  for (int i = 0; i < 4; ++i) {
    v.low[i] = codes[i];
    v.high[i] = codes[i + 4];
  }
  return v;
#endif
}

/// Likewise, back.
inline void store_codes(std::uint16_t* codes, LaneCondition c) {
  for (int i = 0; i < 8; ++i) codes[i] = static_cast<std::uint16_t>(c[i]);
}

/// Each number in the place of its neighbour: 1 0 3 2 …
inline Lanes swap_neighbours(Lanes v) {
  return {__builtin_shufflevector(v.low, v.low, 1, 0, 3, 2),
          __builtin_shufflevector(v.high, v.high, 1, 0, 3, 2)};
}
/// Every second number of both, a's first.
inline Lanes even_lanes(Lanes a, Lanes b) {
  return {__builtin_shufflevector(a.low, a.high, 0, 2, 4, 6),
          __builtin_shufflevector(b.low, b.high, 0, 2, 4, 6)};
}
inline Lanes odd_lanes(Lanes a, Lanes b) {
  return {__builtin_shufflevector(a.low, a.high, 1, 3, 5, 7),
          __builtin_shufflevector(b.low, b.high, 1, 3, 5, 7)};
}

namespace halves {

/// {a₀+a₁, b₀+b₁, a₂+a₃, b₂+b₃}
inline HalfLanes pairs(HalfLanes a, HalfLanes b) {
  return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
}
/// The sums of four.
inline HalfLanes fours(HalfLanes a, HalfLanes b, HalfLanes c, HalfLanes d) {
  const HalfLanes ab = pairs(a, b), cd = pairs(c, d);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}
/// Rows become columns.
inline void transpose(HalfLanes& a, HalfLanes& b, HalfLanes& c, HalfLanes& d) {
  const HalfLanes ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                  ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                  cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                  cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

}  // namespace halves

inline double sum(Lanes v) {
  const HalfLanes two = halves::pairs(v.low, v.high);
  return (two[0] + two[2]) + (two[1] + two[3]);
}
/// The sum of each of up to eight, as sum() forms it.
template <int count>
Lanes sums(const Lanes (&t)[count]) {
  static_assert(count <= 8);
  const auto four = [&](int first) {
    const auto at = [&](int k) { return first + k < count ? t[first + k] : Lanes{}; };
    const Lanes a = at(0), b = at(1), c = at(2), d = at(3);
    return halves::fours(a.low, b.low, c.low, d.low) + halves::fours(a.high, b.high, c.high, d.high);
  };
  return {four(0), count > 4 ? four(4) : HalfLanes{}};
}
/// Rows become columns.
inline void transpose(Lanes (&m)[8]) {
  halves::transpose(m[0].low, m[1].low, m[2].low, m[3].low);
  halves::transpose(m[4].low, m[5].low, m[6].low, m[7].low);
  halves::transpose(m[0].high, m[1].high, m[2].high, m[3].high);
  halves::transpose(m[4].high, m[5].high, m[6].high, m[7].high);
  for (int c = 0; c < 4; ++c) {
    const HalfLanes high = m[c].high;
    m[c].high = m[c + 4].low;
    m[c + 4].low = high;
  }
}

}  // namespace keyblock
