#pragma once
#include <functional>
#include <string>
#include <vector>

#include "record/record.h"
#include "terminal.h"

namespace keyblock::app {

/// 75.4 → "1:15", 4000 → "1:06:40", negative or not finite → "?".
std::string clock_text(double seconds);

/// Something to be said beside a bar. Those of high rank are left out first.
struct Field {
  int rank;
  std::string text;
};

/// Label, bar and fields in one line of the terminal's width (less one column, where the cursor rests).
std::string composed_line(std::string label, double fraction, std::vector<Field> fields,
                          const Terminal& terminal);

/// A line that takes the place of the one the cursor is on.
std::string redrawn_line(const std::string& line);

/// ` 42 %`; 100 % only when all is done.
std::string percent_text(double fraction);

void write_to_standard_error(const std::string& text);
double wall_clock();  ///< s, of a clock that never goes back

/// The bar of the stage at hand, at most terminal.width columns:
/// `4/5 first earthquake ━━━━━━╸────   58 %  step 5800  11.60 s  512 steps/s  ETA 0:08  3.1 it.`
/// Where it does not fit, fields are left out, the least important first. A settling stage, which has no
/// simulated time, shows its worst residual instead.
std::string bar_line(const record::Progress& progress, const Terminal& terminal);

/// What stays on the screen when the stage has ended (stage `index` of `count`), after its last progress
/// report.
std::string finished_line(int index, int count, const record::StageRecord& record,
                          const record::Progress& last, const Terminal& terminal);

/// The same two for a log, with nothing left out: `4/5 first earthquake: 58 %, step 5800, 11.60 s, …`.
std::string log_line(const record::Progress& progress, const Terminal& terminal);
std::string finished_log_line(int index, int count, const record::StageRecord& record,
                              const record::Progress& last, const Terminal& terminal);

/// Shows a run on a terminal, one bar per stage, redrawn in place; elsewhere writes a line now and then, and
/// one at the end of every stage.
class ProgressObserver : public record::RunObserver {
 public:
  /// Of a run of `stage_count` stages. Writes go to `write`, each ready to be shown at once; `terminal` is
  /// asked before each, as windows change their width; `clock` counts seconds.
  ProgressObserver(int stage_count, std::function<void(const std::string&)> write,
                   std::function<Terminal()> terminal, std::function<double()> clock);
  /// To standard error, by the wall clock.
  static ProgressObserver to_standard_error(int stage_count);

  /// Least wall time between two lines of a log, s.
  static constexpr double log_interval = 5.0;

  void stage_begin(int index, const record::StageRecord& record) override;
  void progress(const record::Progress& progress) override;
  void stage_end(int index, const record::StageRecord& record) override;
  void end(const record::RunRecord& record) override;

 private:
  int stage_count_;
  std::function<void(const std::string&)> write_;
  std::function<Terminal()> terminal_;
  std::function<double()> clock_;
  record::Progress last_;
  double last_log_ = 0.0;
  bool bar_is_open_ = false;  ///< a bar stands on the line of the cursor
};

}  // namespace keyblock::app
