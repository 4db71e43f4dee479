#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "record/record.h"

namespace keyblock::results {

/// A whole result file in memory.
struct RunData {
  record::ModelRecord model;
  record::RunRecord run;
  /// There is no record of the end of the run: it was killed, or still goes on. `run` then holds the stages that had
  /// ended, the one that had not, marked as interrupted, and what follows from these and the rows. Of that stage, fallen
  /// and loosened blocks are those of its last frame. What is not known is not a number, or 0 where it is of whole numbers.
  bool cut_off = false;
  std::vector<record::Frame> frames;
  std::vector<record::ContactFrame> contacts;
  std::vector<record::HistoryRow> histories;
  std::vector<record::BreakRecord> breaks;
  std::vector<record::StepRow> steps;
};

/// Of every block, at the end of what was recorded.
std::vector<int> last_orders(const RunData& run);

/// The frame that shows the moment of a snapshot: the last that is not later, else the first.
std::size_t frame_of(const record::ContactFrame& snapshot, const std::vector<record::Frame>& frames);

/// Reads DIR/result.h5. Throws InputError when there is none, or when it is truncated or of another format.
RunData read_run(const std::filesystem::path& directory);

/// The record of a run that has come to its end, so that all it leaves is in DIR but the report; else none. Throws InputError as read_run
/// does.
std::optional<record::RunRecord> ended_run(const std::filesystem::path& directory);
inline bool has_ended(const std::filesystem::path& directory) {
  return ended_run(directory).has_value();
}

/// Its histories alone.
std::vector<record::HistoryRow> read_histories(const std::filesystem::path& directory);

}  // namespace keyblock::results
