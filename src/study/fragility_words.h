#pragma once
#include <string>

#include "study/summaries.h"

namespace keyblock::study {

/// Why a group has no curve, as the end of a sentence that begins "no curve:"; empty where it has one.
std::string why_no_curve(const StudyData& study, const FragilityGroup& group);

/// Of which records its intervals tell: "for this record only".
std::string for_which_records(const statistics::FragilityCurve& curve);

}  // namespace keyblock::study
