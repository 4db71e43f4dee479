#pragma once
#include <string>

namespace keyblock::rockmass {

enum class DistributionKind { constant, uniform, normal, lognormal, exponential };

/// A distribution of positive lengths, or of angles about a mean. `mean` and `std` are those of the
/// distribution before truncation; a uniform one spans mean ± √3·std. Samples of a length are truncated to
/// positive values.
struct Distribution {
  DistributionKind kind = DistributionKind::constant;
  double mean = 0.0;
  double std = 0.0;
};

/// Whether `spacing` is measured normal to the joint plane or between traces in the section.
enum class SpacingMeasure { true_spacing, trace_spacing };

/// A family of parallel joints known only as statistics (Hsiung & Shi 2001, Table 1).
struct JointSet {
  std::string name;
  double dip = 0.0;                ///< degrees below the horizontal, 0 … 90
  double dip_direction = 0.0;      ///< degrees from north, clockwise
  double dip_std = 0.0;            ///< scatter of dip from joint to joint, degrees (normal)
  double dip_direction_std = 0.0;  ///< scatter of dip direction, degrees (normal)
  SpacingMeasure spacing_measure = SpacingMeasure::true_spacing;
  Distribution spacing;  ///< m
  Distribution length;   ///< m, of a trace
  Distribution gap;      ///< m, of the rock bridge between two traces on one line
};

}  // namespace keyblock::rockmass
