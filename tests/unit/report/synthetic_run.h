#pragma once
#include "results/run_data.h"

namespace keyblock::made_up {

/// A made-up run, of which every part of the report has something to show: a brick wall in a frame, an opening cut
/// into it, blocks that fall on the invert, an earthquake, contacts, histories. No mechanics: motions are prescribed.
struct SyntheticOptions {
  int columns = 16, rows = 13;  ///< of bricks
  int edge_pieces = 1;          ///< display pieces per edge of ordinary bricks
  int frames_per_stage = 30;
  bool excavation = true;
  bool frames = true;        ///< false: a run that recorded none
  bool interrupted = false;  ///< ends in the middle of the shaking
  bool marginal = false;     ///< blocks are left moving at the end of settling
  double shake_duration = 10.0;
};

results::RunData synthetic_run(const SyntheticOptions& options = {});

}  // namespace keyblock::made_up
