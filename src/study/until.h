#pragma once
#include <optional>
#include <string>
#include <vector>

#include "study/plan.h"

namespace keyblock::study {

/// How many realizations the rule [study.until] asks for: the smallest n from `minimum` on for which, over the first n
/// realizations and for every combination, the confidence interval of the mean m of the measure,
///
///     m ± t s / √N,   t the quantile of Student's distribution with N − 1 degrees of freedom,
///
/// is narrow enough. Without variation, s = 0, a share of the mean (half_width) is not reached: that nothing has fallen n times
/// does not say how often something will. An absolute width is: it is what ends a study where nothing falls. Runs that failed are
/// left out; at least two must have been done. As n depends on the results alone, it is the same for any number of workers.
/// Nothing when no n up to the first run that is missing is enough, or without a rule.
///
/// `results` are in the places of plan.runs; null: missing. Variants have no say.
std::optional<int> enough_realizations(const Plan& plan, const std::vector<const RunResult*>& results);

/// What a study that has come to its end lacks of the precision that [study.until] asks for: how many combinations are not known
/// well enough, and the interval of the one that is farthest from it. Empty when realizations are enough, while results are
/// missing, and without a rule.
std::string lacking_precision(const Plan& plan, const std::vector<const RunResult*>& results);

}  // namespace keyblock::study
