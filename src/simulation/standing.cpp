#include "simulation/standing.h"

namespace keyblock::simulation {

Standing standing_of(const StageRecord& stage, double still) {
  if (stage.damage.fallen_blocks > 0) return Standing::collapsed;
  if (stage.stage.kind != StageKind::settle)
    return stage.largest_speed > still ? Standing::moves : Standing::stands;
  if (!stage.moving.empty()) return Standing::moves;
  return stage.equilibrium_reached ? Standing::stands : Standing::unsettled;
}

const char* standing_name(Standing standing) {
  switch (standing) {
    case Standing::stands:
      return "stands";
    case Standing::moves:
      return "moves";
    case Standing::collapsed:
      return "collapsed";
    case Standing::unsettled:
      break;
  }
  return "unsettled";
}

}  // namespace keyblock::simulation
