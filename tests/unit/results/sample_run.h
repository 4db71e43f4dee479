#pragma once
#include <random>
#include <string>

#include "results/run_data.h"

/// A made-up run with awkward numbers: two triangles and a square with a hole, two stages.
namespace keyblock::results {

class SampleRun {
 public:
  record::ModelRecord model;

  SampleRun();
  record::Frame frame(int stage, long step);
  record::ContactFrame contacts(int stage, long step, int count);
  record::HistoryRow history(long step);
  record::BreakRecord break_at(int stage, long step);
  record::StepRow step_row(int stage, long step);
  record::StageRecord stage(int index);
  record::RunRecord run();

  /// Steps 1 … 10 are stage 0 and 11 … 30 stage 1, from `first` on, to `observer`; a frame every 5, a break every 7, contacts every 10.
  /// Everything depends on the step alone. From a later `first` on, the run is resumed from a checkpoint before it. With
  /// `finish`, the run ends after the last step.
  void play(record::RunObserver& observer, long first = 1, long last = 30, bool finish = true);
  /// What `play` reports, as read back.
  RunData expected();
};

/// Same to the last bit (for NaN, too).
void expect_equal(const RunData& a, const RunData& b);

}  // namespace keyblock::results
