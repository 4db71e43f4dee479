#pragma once

namespace keyblock::statistics {

/// Φ(z) = ½ erfc(−z/√2), the standard normal distribution function; accurate in the lower tail.
double normal_cdf(double z);

/// t with P(|T| ≤ t) = confidence for Student's distribution with `degrees` ≥ 1 degrees of freedom. Hill (1970),
/// Algorithm 396: exact for 1 and 2 degrees, otherwise about six digits.
double student_t(double confidence, int degrees);

}  // namespace keyblock::statistics
