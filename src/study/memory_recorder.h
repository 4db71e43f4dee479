#pragma once
#include "record/record.h"
#include "results/run_data.h"

namespace keyblock::study {

/// Keeps a run in memory as the result file would have it: a report can be written of it without one.
class MemoryRecorder : public record::RunObserver {
 public:
  void begin(const record::ModelRecord& model) override { data_.model = model; }
  void frame(const record::Frame& frame) override { data_.frames.push_back(frame); }
  void contacts(const record::ContactFrame& frame) override { data_.contacts.push_back(frame); }
  void history(const record::HistoryRow& row) override { data_.histories.push_back(row); }
  void step(const record::StepRow& row) override { data_.steps.push_back(row); }
  void end(const record::RunRecord& run) override { data_.run = run; }

  [[nodiscard]] const results::RunData& data() const { return data_; }

 private:
  results::RunData data_;
};

}  // namespace keyblock::study
