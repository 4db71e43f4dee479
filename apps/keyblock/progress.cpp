#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "record/verdict.h"

namespace keyblock::app {
namespace {

using record::Progress;
using record::StageKind;
using record::StageRecord;

constexpr int name_width = 16;
constexpr int label_width = name_width + 4;  // "4/5 " and the name
constexpr int width_to_align = 60;           // narrower terminals have no columns to spare
constexpr int shortest_bar = 8;
constexpr int longest_bar = 40;

constexpr std::string_view green = "\x1b[32m";
constexpr std::string_view dim = "\x1b[2m";
constexpr std::string_view plain = "\x1b[0m";
// Back to the first column, no wrapping at the edge (a window may shrink while a line is drawn); and undone
// again.
constexpr std::string_view redraw = "\r\x1b[?7l";
constexpr std::string_view redrawn = "\x1b[K\x1b[?7h";

std::string rate_text(double steps_per_second) {
  return fmt::format("{:.{}f} steps/s", steps_per_second, steps_per_second < 10.0 ? 1 : 0);
}

std::string state_text(const Progress& p) {
  return p.kind == StageKind::settle ? fmt::format("residual {:.1e}", p.worst_residual_ratio)
                                     : fmt::format("{:.2f} s", p.time);
}

/// The fields that fit beside a bar of the shortest length, in their order.
std::string fitted(std::vector<Field> fields, int columns) {
  const auto width = [&] {
    int sum = 0;
    for (const Field& field : fields) sum += 2 + column_count(field.text);
    return sum;
  };
  while (!fields.empty() && width() > columns) {
    fields.erase(std::max_element(fields.begin(), fields.end(),
                                  [](const Field& a, const Field& b) { return a.rank < b.rank; }));
  }
  std::string text;
  for (const Field& field : fields) text += "  " + field.text;
  return text;
}

std::string bar(double fraction, int columns, const Terminal& terminal) {
  const int halves = static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * 2.0 * columns));
  const bool half = terminal.unicode && halves % 2 == 1;
  const int full = halves / 2;
  std::string done, rest;
  for (int k = 0; k < full; ++k) done += terminal.unicode ? "━" : "#";
  if (half) done += "╸";
  for (int k = full + (half ? 1 : 0); k < columns; ++k) rest += terminal.unicode ? "─" : "-";
  if (!terminal.color) return done + rest;
  return fmt::format("{}{}{}{}{}", green, done, dim, rest, plain);
}

std::string stage_label(int index, int count, std::string_view name, int columns, const Terminal& terminal) {
  return fmt::format("{}/{} {}", index + 1, count, one_line(name, columns, terminal.unicode));
}

std::string full_label(int index, int count, std::string_view name, const Terminal& terminal) {
  return stage_label(index, count, name, static_cast<int>(name.size()), terminal);
}

}  // namespace

std::string percent_text(double fraction) {
  const double percent = std::round(100.0 * std::clamp(fraction, 0.0, 1.0));
  return fmt::format("{:3.0f} %", fraction < 1.0 ? std::min(percent, 99.0) : percent);
}

std::string composed_line(std::string label, double fraction, std::vector<Field> fields,
                          const Terminal& terminal) {
  const int available = terminal.width - 1;
  if (available >= width_to_align) {
    label.append(static_cast<std::size_t>(std::max(0, label_width - column_count(label))), ' ');
  }
  const int beside_label = available - column_count(label) - 1;
  if (beside_label < shortest_bar) return one_line(label, available, terminal.unicode);
  const std::string text = fitted(std::move(fields), beside_label - shortest_bar);
  const int length = std::min(longest_bar, beside_label - column_count(text));
  return label + " " + bar(fraction, length, terminal) + text;
}

std::string redrawn_line(const std::string& line) {
  return fmt::format("{}{}{}", redraw, line, redrawn);
}

double wall_clock() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

void write_to_standard_error(const std::string& text) {
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, rest.data(), rest.size());
    if (written <= 0) return;  // nobody reads any more; the run goes on
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::string clock_text(double seconds) {
  if (!(seconds >= 0.0) || seconds > 1e9) return "?";
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string bar_line(const Progress& p, const Terminal& terminal) {
  std::vector<Field> fields{{0, percent_text(p.fraction)},
                            {3, fmt::format("step {}", p.step)},
                            {2, state_text(p)},
                            {4, rate_text(p.steps_per_second)},
                            {1, "ETA " + clock_text(p.seconds_left)},
                            {5, fmt::format("{:.1f} it.", p.mean_iterations)}};
  return composed_line(stage_label(p.stage, p.stage_count, p.stage_name, name_width, terminal), p.fraction,
                       std::move(fields), terminal);
}

namespace {

/// What a stage came to: its state at the end, steps, wall time and rate.
std::vector<Field> outcome(const StageRecord& record, const Progress& last) {
  std::vector<Field> fields;
  if (record.interrupted) {
    fields.push_back({0, "interrupted"});
  } else if (record.stage.kind == StageKind::settle) {
    fields.push_back({0, record::verdict_text(record)});
  }
  if (record.stage.kind != StageKind::settle) fields.push_back({2, fmt::format("{:.2f} s", record.duration)});
  if (record.still)
    fields.push_back({6, record.waits_for ? fmt::format("still, after {} until {:.4g} s",
                                                        record.waits_for->what, record.waits_for->until)
                                          : "still"});
  fields.push_back({1, fmt::format("{} steps", record.steps)});
  fields.push_back({3, "in " + clock_text(record.wall_time)});
  if (record.wall_time > 0.0) {
    fields.push_back({4, rate_text(static_cast<double>(record.steps) / record.wall_time)});
  }
  fields.push_back({5, fmt::format("{:.1f} it.", last.mean_iterations)});
  return fields;
}

}  // namespace

std::string finished_line(int index, int count, const StageRecord& record, const Progress& last,
                          const Terminal& terminal) {
  return composed_line(stage_label(index, count, record.stage.name, name_width, terminal),
                       record.interrupted ? last.fraction : 1.0, outcome(record, last), terminal);
}

std::string finished_log_line(int index, int count, const StageRecord& record, const Progress& last,
                              const Terminal& terminal) {
  std::string line = full_label(index, count, record.stage.name, terminal) + ":";
  for (const Field& field : outcome(record, last)) line += (line.back() == ':' ? " " : ", ") + field.text;
  return line;
}

std::string log_line(const Progress& p, const Terminal& terminal) {
  return fmt::format("{}: {}, step {}, {}, {}, ETA {}, {:.1f} it.",
                     full_label(p.stage, p.stage_count, p.stage_name, terminal), percent_text(p.fraction),
                     p.step, state_text(p), rate_text(p.steps_per_second), clock_text(p.seconds_left),
                     p.mean_iterations);
}

ProgressObserver::ProgressObserver(int stage_count, std::function<void(const std::string&)> write,
                                   std::function<Terminal()> terminal, std::function<double()> clock)
    : stage_count_(stage_count),
      write_(std::move(write)),
      terminal_(std::move(terminal)),
      clock_(std::move(clock)),
      last_log_(clock_()) {}

ProgressObserver ProgressObserver::to_standard_error(int stage_count) {
  return {stage_count, write_to_standard_error, [] { return Terminal::detect(STDERR_FILENO); }, wall_clock};
}

void ProgressObserver::stage_begin(int, const StageRecord&) {
  last_ = {};
}

void ProgressObserver::progress(const Progress& progress) {
  last_ = progress;
  const Terminal terminal = terminal_();
  if (terminal.interactive) {
    write_(redrawn_line(bar_line(progress, terminal)));
    bar_is_open_ = true;
  } else if (clock_() - last_log_ >= log_interval) {
    last_log_ = clock_();
    write_(log_line(progress, terminal) + "\n");
  }
}

void ProgressObserver::stage_end(int index, const StageRecord& record) {
  const Terminal terminal = terminal_();
  if (terminal.interactive) {
    write_(redrawn_line(finished_line(index, stage_count_, record, last_, terminal)) + "\n");
    bar_is_open_ = false;
    return;
  }
  last_log_ = clock_();
  write_(finished_log_line(index, stage_count_, record, last_, terminal) + "\n");
}

void ProgressObserver::end(const record::RunRecord&) {
  if (bar_is_open_) write_("\n");
  bar_is_open_ = false;
}

}  // namespace keyblock::app
