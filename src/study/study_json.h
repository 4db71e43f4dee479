#pragma once
#include <string>

#include "study/summaries.h"

namespace keyblock::study {

/// study.json: the statistics, documented field by field in docs/study-report.md. Numbers have six significant digits;
/// one that is not known is null.
std::string study_json(const StudyData& study, const Summary& summary);

/// runs.csv: one row per run, variants too, documented there. Numbers can be read back to their last bit.
std::string runs_csv(const StudyData& study, const Summary& summary);

}  // namespace keyblock::study
