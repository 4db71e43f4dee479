#pragma once
#include <array>
#include <cstdint>

namespace keyblock {

/// Philox4x32-10, a bijection of 128-bit counters for every 64-bit key that passes for random (Salmon,
/// Moraes, Dror & Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"). Any number of a stream is had
/// without those before it.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// The random numbers of one line of one joint set in one realization. Draw k is a function of
/// (seed, realization, joint set, line, k) and of nothing else: not of the order of the draws, nor of what
/// else was drawn, nor of the machine.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint32_t realization, std::uint32_t joint_set, std::uint32_t line);

  /// Uniform in the open interval (0, 1): (i + ½)·2⁻⁵², i of 52 random bits.
  [[nodiscard]] double uniform(std::uint32_t draw) const;

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 3> counter_;
};

/// z with Φ(z) = p for 0 < p < 1, Φ the standard normal distribution function; ∓∞ at p = 0 and 1.
/// Rational approximation of Wichura (1988), Algorithm AS 241 (PPND16): relative error about 1e-16. Between
/// p = 0.075 and 0.925 it is arithmetic alone; beyond, one logarithm and one square root.
double inverse_normal_cdf(double p);

}  // namespace keyblock
