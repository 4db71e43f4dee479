#pragma once
#include "rockmass/joint_set.h"

namespace keyblock::rockmass {

/// Quantile of a length: x with F(x) = u for 0 < u < 1, F the distribution cut off at zero and scaled to 1
/// again:
///     F(x) = (F₀(x) − F₀(0)) / (1 − F₀(0)),   x > 0.
/// With mean m and standard deviation s of F₀, the distribution before the cut:
///     constant     x = m
///     uniform      F₀ from m − √3 s to m + √3 s
///     normal       F₀(x) = Φ((x − m)/s)
///     lognormal    ln x normal with variance σ² = ln(1 + s²/m²) and mean ln m − σ²/2; nothing is cut off
///     exponential  F₀(x) = 1 − exp(−x/m); s is not used, nothing is cut off
/// So a sample of u uniform in (0, 1) is quantile(d, u). Precondition: m ≥ 0, s ≥ 0, and m > 0 unless
/// constant.
double quantile(const Distribution& distribution, double u);

/// Mean of the distribution that quantile() samples. It is larger than `mean` where something is cut off:
/// noticeably for s > m/√3 (uniform) and s > m/2 (normal).
double truncated_mean(const Distribution& distribution);

/// Largest s/m of a lognormal distribution that is of use; that of joints in rock is about 1. Half of the total length of all
/// intervals is in those longer than the quantile Φ(σ), which for s/m = 10 are 1.6 % of them, 2 of the 128 among which
/// generate_traces() picks one by its length. Beyond, it would seldom find any.
constexpr double most_lognormal_variation = 10.0;

}  // namespace keyblock::rockmass
