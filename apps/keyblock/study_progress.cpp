#include "study_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "core/text.h"
#include "progress.h"

namespace keyblock::app {

namespace {
constexpr std::size_t longest_failure = 4000;  // characters
}

std::string study_bar_line(const std::string& name, const study::StudyProgress& p, const Terminal& terminal) {
  std::vector<Field> fields{{0, percent_text(p.fraction)}, {1, fmt::format("{}/{} done", p.done, p.total)}};
  if (p.failed > 0) fields.push_back({2, fmt::format("{} failed", p.failed)});
  if (p.running > 0) fields.push_back({4, fmt::format("{} running", p.running)});
  fields.push_back({3, "ETA " + clock_text(p.seconds_left)});
  return composed_line(name, p.fraction, std::move(fields), terminal);
}

std::string study_log_line(const study::StudyProgress& p) {
  std::string text = fmt::format("{}/{} runs done, ", p.done, p.total);
  if (p.failed > 0) text += fmt::format("{} failed, ", p.failed);
  if (p.running > 0) text += fmt::format("{} running, ", p.running);
  return text + fmt::format("{:.0f} %, ETA {}", 100.0 * p.fraction, clock_text(p.seconds_left));
}

StudyDisplay::StudyDisplay(std::string name, std::function<void(const std::string&)> write,
                           std::function<Terminal()> terminal, std::function<double()> clock)
    : name_(std::move(name)),
      write_(std::move(write)),
      terminal_(std::move(terminal)),
      clock_(std::move(clock)),
      last_log_(clock_() - log_interval) {}

StudyDisplay StudyDisplay::to_standard_error(const std::string& name) {
  return {name, write_to_standard_error, [] { return Terminal::detect(STDERR_FILENO); }, wall_clock};
}

void StudyDisplay::show(const study::StudyProgress& progress) {
  const Terminal terminal = terminal_();
  if (!progress.failure.empty()) {
    const std::string line = printable(progress.finished + " failed: " + progress.failure, longest_failure);
    write_((terminal.interactive ? redrawn_line(line) : line) + "\n");
  }
  if (terminal.interactive) {
    write_(redrawn_line(study_bar_line(name_, progress, terminal)));
    bar_is_open_ = true;
  } else if (!progress.finished.empty() && clock_() - last_log_ >= log_interval) {
    last_log_ = clock_();
    write_(study_log_line(progress) + "\n");
  }
}

void StudyDisplay::end() {
  if (bar_is_open_) write_("\n");
  bar_is_open_ = false;
}

}  // namespace keyblock::app
