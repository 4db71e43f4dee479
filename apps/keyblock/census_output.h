#pragma once
#include <string>
#include <vector>

#include "cutting/picture.h"
#include "scenario/build.h"
#include "study/census_study.h"

/// What `keyblock cut --census` shows of key blocks.
namespace keyblock::app {

/// A table of the blocks that move or need a force, and a sentence on all.
std::string census_table(const study::RealizationCensus& census, double wanted_factor);

/// The measures over realizations, each with its mean, interval and range.
std::string censuses_table(const study::CensusStudy& study);

/// Blocks by what becomes of them.
std::vector<cutting::BlockPaint> census_paint(const census::Census& census, double wanted_factor);

}  // namespace keyblock::app
