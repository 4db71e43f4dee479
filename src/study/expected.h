#pragma once
#include <vector>

#include "study/risk.h"

namespace keyblock::study {

/// What is expected in a year of the area and of the weight that fall, for each group of combinations that differ in their shaking alone:
///
///   ∫ m(x) |dλ_h(x)|,     m: the mean of the measure, known at the intensities that were run (statistics::rate_of_points)
///
/// with the interval of two_way.h, of the means without one rock mass, record or pair. risk: its hazards and intensity.
std::vector<ExpectedMeasure> expected_measures(const StudyData& study, const Summary& summary,
                                               const Risk& risk);

}  // namespace keyblock::study
