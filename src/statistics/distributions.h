#pragma once

namespace keyblock::statistics {

/// Φ(z) = ½ erfc(−z/√2), the standard normal distribution function; accurate in the lower tail.
double normal_cdf(double z);

/// t with P(|T| ≤ t) = confidence for Student's distribution with `degrees` ≥ 1 degrees of freedom, from the incomplete
/// beta function (continued fraction of Lentz; Press et al., Numerical Recipes, 6.4).
double student_t(double confidence, int degrees);

}  // namespace keyblock::statistics
