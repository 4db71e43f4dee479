#pragma once
#include "record/record.h"
#include "results/run_data.h"

namespace keyblock::study {

/// Keeps a run in memory as the result file would have it: a report can be written of it without one.
class MemoryRecorder : public simulation::RunObserver {
 public:
  void begin(const simulation::ModelRecord& model) override { data_.model = model; }
  void frame(const simulation::Frame& frame) override { data_.frames.push_back(frame); }
  void contacts(const simulation::ContactFrame& frame) override { data_.contacts.push_back(frame); }
  void history(const simulation::HistoryRow& row) override { data_.histories.push_back(row); }
  void step(const simulation::StepRow& row) override { data_.steps.push_back(row); }
  void end(const simulation::RunRecord& run) override { data_.run = run; }

  [[nodiscard]] const results::RunData& data() const { return data_; }

 private:
  results::RunData data_;
};

}  // namespace keyblock::study
