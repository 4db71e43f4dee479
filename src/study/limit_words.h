#pragma once
#include <string>

#include "study/limit.h"

/// A limit in words, for people: the terminal, the page, and `answer` of limit.json.
namespace keyblock::study {

/// "7.8 kPa", "30.1°", "1.198": a value of the key, with so many digits.
std::string quantity(double value, const std::string& unit, int digits);

/// What the run of a trial came to: "the blocks stand", "block 292 (7.2 kN/m) has fallen", "vertical closure is 0.012 m".
std::string outcome_text(const LimitRequest& request, const LimitTrial& trial);

/// One sentence, and where the criterion is not all that there is to say, more of them: other limits, and what moves before.
std::string answer_text(const LimitResult& result);

/// What was asked, the answer, and a line for each realization.
std::string limit_text(const LimitResult& result);

/// Where one search found that the criterion holds nowhere: what is to be asked instead.
std::string not_met_hint(const LimitResult& result);

}  // namespace keyblock::study
