#pragma once
#include <string>
#include <vector>

/// Scales of colours and of lengths, the same rules as in the report and in Python.
namespace keyblock::picture {

/// What a number is, and so in which units it is written.
enum class Quantity { none, length, stress, velocity, density, force, share };

/// "3.4 mm"; with at most `digits` significant digits.
std::string with_unit(double value, Quantity quantity, int digits = 3);

/// Of 1, 2, 5 times a power of ten: the smallest that is not below x > 0, the largest that is not above it.
double nice_above(double x);
double nice_below(double x);

/// From where to where colours go.
struct Scale {
  double low = 0.0, high = 1.0;
  bool logarithmic = false;

  /// Place of a value, 0 … 1, held at the ends.
  [[nodiscard]] double place(double value) const;
  /// The ends, and round values between them that have room for their labels.
  [[nodiscard]] std::vector<double> ticks() const;
};

/// For sizes: from 0, or in decades where a few values are far above the rest.
Scale scale_of_sizes(std::vector<double> values);
/// For stresses: from the 2nd to the 98th percentile, rounded outwards; 0 is an end where there is no other sign.
Scale scale_of_stresses(std::vector<double> values);
Scale scale_between(std::vector<double> values);
/// Three decades up to the largest.
Scale scale_of_joints(double largest);

/// The value that so large a share of the values does not exceed; 0 of none.
double quantile(std::vector<double>& values, double share);

}  // namespace keyblock::picture
