#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "record/record.h"

namespace keyblock::results {

/// Writes what a run leaves in its folder: result.h5 while it goes on, and at the end summary.json and, where points
/// were chosen, histories.csv.
///
/// The layout is documented in docs/result-file.md. The file is written in HDF5's single-writer-multiple-reader mode
/// and flushed at every checkpoint, at the end of every stage and every `flush_interval` seconds (more seldom in runs of
/// more than a few minutes: every hundredth of the time that has passed): it can be read while the run goes on, and after it was killed,
/// up to the last flush (read_run; in Python h5py.File(path, swmr=True)).
///
/// A new run leaves the result.h5 of an earlier one alone until its first event. A resumed run (`resume`) keeps of the
/// earlier one what that had reported by its checkpoint; InputError where there is no earlier one, or less of it.
///
/// Every call may throw RunError: the disk may be full. Then nothing more is written, and what was flushed before can be read.
class ResultWriter : public record::RunObserver {
 public:
  static constexpr double default_flush_interval = 2.0;  // s of wall time
  explicit ResultWriter(std::filesystem::path directory, double flush_interval = default_flush_interval);
  ~ResultWriter() override;

  /// Is called once, when the new result.h5 stands complete under another name and is about to take the place of what is there:
  /// until then, nothing in the folder has changed.
  void before_publishing(std::function<void()> call);

  /// Lets the file go, with what was flushed. No event may follow.
  void close();

  void begin(const record::ModelRecord& model) override;
  void resume(const record::Reported& reported) override;
  void stage_begin(int index, const record::StageRecord& stage) override;
  void frame(const record::Frame& frame) override;
  void contacts(const record::ContactFrame& frame) override;
  void history(const record::HistoryRow& row) override;
  void breaks(const record::BreakRecord& row) override;
  void step(const record::StepRow& row) override;
  void checkpoint() override;
  void stage_end(int index, const record::StageRecord& stage) override;
  void end(const record::RunRecord& run) override;

 private:
  void before_event();
  void flush();

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace keyblock::results
