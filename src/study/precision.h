#pragma once
#include "study/run_result.h"

namespace keyblock::study {

/// Whether study.precision is reached: the confidence interval of the mean of its measure (that of study.json, by
/// bootstrap) is narrow enough in every combination that has runs without an error. False where there are none, or too
/// few for an interval, or no precision is asked for. Throws std::invalid_argument for a measure that does not exist.
bool precise_enough(const StudyData& study);

}  // namespace keyblock::study
