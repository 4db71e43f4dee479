#include "record/standing.h"

#include <algorithm>
#include <iterator>

namespace keyblock::record {
namespace {

constexpr StandingWord words[] = {{Standing::stands, "stands", "stands", "stand"},
                                  {Standing::moves, "moves", "moves", "move"},
                                  {Standing::collapsed, "collapsed", "has fallen", "have fallen"},
                                  {Standing::unsettled, "unsettled", "does not settle", "do not settle"},
                                  {Standing::rocks, "rocks", "still rocks", "still rock"},
                                  {Standing::fallen, "fallen", "has fallen", "have fallen"},
                                  {Standing::unstable, "unstable", "is not stable", "are not stable"}};

}  // namespace

Standing standing_of(const StageRecord& stage, double loosened, bool has_opening) {
  if (stage.damage.fallen_blocks > 0) return has_opening ? Standing::fallen : Standing::collapsed;
  if (stage.stage.kind != StageKind::settle) {
    if (stage.largest_speed <= loosened) return Standing::stands;
    return stage.movers.way > loosened ? Standing::moves : Standing::rocks;
  }
  if (!stage.moving.empty()) return Standing::moves;
  if (!stage.equilibrium_reached) return Standing::unsettled;
  return stage.unstable_block < 0 ? Standing::stands : Standing::unstable;
}

std::span<const StandingWord> standing_words() {
  return words;
}

const StandingWord& word_of(Standing standing) {
  return *std::find_if(std::begin(words), std::end(words),
                       [&](const StandingWord& word) { return word.standing == standing; });
}

const char* standing_name(Standing standing) {
  return word_of(standing).name;
}

}  // namespace keyblock::record
