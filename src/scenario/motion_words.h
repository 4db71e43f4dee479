#pragma once
#include "scenario/scenario.h"
#include "scenario/table_reader.h"

/// Words of [[motion]] that [[suite]] has as well.
namespace keyblock::scenario {

inline constexpr Word<loading::Baseline> baseline_words[] = {{"none", loading::Baseline::none},
                                                             {"demean", loading::Baseline::demean},
                                                             {"linear", loading::Baseline::linear},
                                                             {"taper", loading::Baseline::taper}};

}  // namespace keyblock::scenario
