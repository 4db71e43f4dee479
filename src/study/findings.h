#pragma once
#include <string>
#include <vector>

#include "study/summaries.h"

namespace keyblock::study {

/// What a study found, line by line, for a terminal: the share of realizations that exceed each level in each combination, before the
/// shaking and by what the shaking adds; then the curve over PGA of each level and group, or why there is none; then runs whose energies
/// balance badly, if there are any.
std::vector<std::string> findings(const StudyData& study, const Summary& summary);

}  // namespace keyblock::study
