#pragma once
#include <functional>
#include <string>

#include "study/workers.h"
#include "terminal.h"

namespace keyblock::app {

/// `study ━━━━╸─────   42 %  41/100 done  1 failed  2 running  ETA 12:30`, at most terminal.width columns. name: what it says in front.
std::string study_bar_line(const std::string& name, const study::StudyProgress& progress,
                           const Terminal& terminal);

/// The same for a log: `41/100 runs done, 1 failed, 2 running, 42 %, ETA 12:30`.
std::string study_log_line(const study::StudyProgress& progress);

/// Shows a study on a terminal, one bar, redrawn in place; elsewhere a line when a run has ended, but not too often. Runs that
/// fail are always told.
class StudyDisplay {
 public:
  /// name: of the bar, "study".
  StudyDisplay(std::string name, std::function<void(const std::string&)> write,
               std::function<Terminal()> terminal, std::function<double()> clock);
  static StudyDisplay to_standard_error(const std::string& name);

  /// Least wall time between two lines of a log, s.
  static constexpr double log_interval = 5.0;

  void show(const study::StudyProgress& progress);
  void end();

 private:
  std::string name_;
  std::function<void(const std::string&)> write_;
  std::function<Terminal()> terminal_;
  std::function<double()> clock_;
  double last_log_;
  bool bar_is_open_ = false;
};

}  // namespace keyblock::app
