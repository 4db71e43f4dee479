#pragma once
#include <span>

#include "record/record.h"

namespace keyblock::record {

/// A word for how blocks are, as files and people have it.
struct StandingWord {
  Standing standing;
  const char* name;     ///< in files
  const char* one;      ///< what one block does
  const char* several;  ///< what several do
};

/// How blocks are at the end of a stage, judged from its record in this order:
///
/// | word | when |
/// |---|---|
/// | collapsed, fallen | blocks have fallen: around no opening, and beside one |
/// | moves | a static stage left blocks moving; a dynamic one, blocks faster than `loosened_distance` per second that have moved by more than it |
/// | rocks | a dynamic stage left blocks as fast as that, none of which has moved so far |
/// | unsettled | a static stage ended without equilibrium |
/// | unstable | its equilibrium is not stable: a column straight beyond its buckling load |
/// | stands | else |
///
/// loosened: m, DamageLimits::loosened_distance.
Standing standing_of(const StageRecord& stage, double loosened, bool has_opening);

/// All words, in the order of Standing.
std::span<const StandingWord> standing_words();
const StandingWord& word_of(Standing standing);
/// In files.
const char* standing_name(Standing standing);

}  // namespace keyblock::record
