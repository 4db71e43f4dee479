#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "loading/motion_formats.h"

// Files of the California Strong Motion Instrumentation Program (CDMG/CSMIP Report OSMS 85-03) and of those who write like it. Per
// channel there are lines of text, a header of integers and reals, and blocks of samples. Volume 2 (25 lines of text) has acceleration,
// velocity and displacement, of which the acceleration is taken; volume 1 (13 lines) is not corrected. The blocks begin with
//   3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)
//    400 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)        since about 2000
//  13200 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)       volume 1
// In volume 1 of film records pairs of time and acceleration follow the header without such a line.
namespace keyblock::loading {
namespace {

constexpr std::string_view block_title = "points of accel data equally spaced at",
                           rate_title = "accelerogram points at";
constexpr std::string_view channel_end = "end of data for channel", channel_start = "corrected accelerogram";
constexpr std::size_t text_lines_1 = 13, station_line_1 = 5, station_line_2 = 6;
constexpr std::size_t event_line_1 = 1, event_line_2 = 2;
constexpr std::size_t integers_1 = 100, reals_1 = 50, integer_width_1 = 5, real_width_1 = 10;
constexpr std::size_t points_integer = 27, pair_width = 7;

// A channel of the file.
struct Channel {
  std::size_t first = 0;     // line of its text
  bool uncorrected = false;  // volume 1
  std::size_t block = 0;     // line before its samples
  bool titled = true;        // that line names points, step and unit
};

bool contains(const MotionText& text, std::size_t line, std::string_view words) {
  return lower(text.line(line)).find(words) != std::string::npos;
}

bool is_title(const MotionText& text, std::size_t line) {
  return contains(text, line, block_title) || contains(text, line, rate_title);
}

// "CHAN  1:  90 DEG" anywhere in the channel's text.
MotionDirection find_chan_direction(const MotionText& text, const Channel& channel, std::string& label) {
  for (std::size_t k = channel.first; k < channel.block; ++k) {
    const std::string lower_line = lower(text.line(k));
    const std::string_view line = lower_line;
    const std::size_t chan = line.find("chan");
    const std::size_t colon = chan == std::string::npos ? chan : line.find(':', chan);
    if (colon == std::string::npos) continue;
    const std::string words = squeeze(text.line(k).substr(colon + 1));
    const std::string direction = words.substr(0, lower(words).find(" from"));
    label = fmt::format("channel {}: {}", trim(line.substr(chan + 4, colon - chan - 4)), direction);
    return parse_direction(direction);
  }
  return {};
}

// Of volume 2 `Peak acceleration =  -94.216 cm/sec/sec`, in the unit of the samples; of volume 1 `Max = .079 g`.
void check_channel_peak(const MotionText& text, const Channel& channel, MotionComponent& component) {
  for (std::size_t k = channel.first; k < channel.block; ++k) {
    const std::string line = lower(text.line(k));
    const auto peak = number_after(line, "peak acceleration");
    if (peak && !channel.uncorrected)
      return compare_peak(component, *peak * component.file_unit_in_si, 0.0005 * component.file_unit_in_si);
    const std::size_t at = line.find("max ");
    if (!channel.uncorrected || at == std::string::npos || line.find("uncor") == std::string::npos) continue;
    const auto largest = number_after(line, "max");
    const bool in_g = line.find(" g", at) != std::string::npos;
    constexpr double rounding = 0.0005;  // g
    if (largest && in_g) compare_peak(component, *largest * standard_gravity, rounding * standard_gravity);
    return;
  }
}

std::size_t stated_points(const MotionText& text, std::size_t line) {
  const std::string title = squeeze(text.line(line));
  const auto points = text.count(parse_number(std::string_view(title).substr(0, title.find(' '))));
  if (!points) {
    text.fail(line, "the number of points, which the file must hold, before `POINTS OF ACCEL DATA`");
  }
  return *points;
}

// Samples after a line with their number, step, unit and format. Returns the line after them.
std::size_t read_titled(const MotionText& text, const Channel& channel, MotionComponent& component) {
  const std::size_t line = channel.block;
  const std::string title = lower(text.line(line));
  const bool by_rate = title.find(rate_title) != std::string::npos;
  const std::string_view words = by_rate ? rate_title : block_title;
  const auto number = number_after(title, words);
  const auto dt = by_rate && number && *number > 0.0 ? 1.0 / *number : number;
  const std::size_t points = stated_points(text, line);
  if (!is_time_step(dt))
    text.fail(line,
              fmt::format("{}, after `{}`", time_step_text, by_rate ? "POINTS AT" : "EQUALLY SPACED AT"));
  component.dt = *dt;
  const auto unit = line_unit(text, line, title.find(words) + words.size());
  if (!unit) text.fail(line, "a unit of acceleration, as in `(UNITS: CM/SEC/SEC)` or `in cm/sec2.`");
  std::size_t next = 0;
  auto samples = text.numbers(line + 1, points, column_width(title).value_or(0), "samples", &next);
  set_samples(component, std::move(samples), *unit, find_chan_direction(text, channel, component.label));
  return next;
}

// Pairs of time and acceleration of film records, in the unit of `UNITS OF UNCOR ACCEL ARE SEC AND G/10.`
std::size_t read_pairs(const MotionText& text, const Channel& channel, MotionComponent& component) {
  std::size_t next = 0;
  const auto integers = text.numbers(channel.first + text_lines_1, integers_1, integer_width_1,
                                     "integers of the header", &next);
  const std::size_t count_line = channel.first + text_lines_1 + 1;
  static_cast<void>(text.numbers(next, reals_1, real_width_1, "reals of the header", &next));
  const auto points = text.count(integers[points_integer]);
  if (!points) text.fail(count_line, "the number of points, which the file must hold, in columns 56 to 60");
  const std::size_t unit_line = std::min(text.find("units of uncor", channel.first), text.size());
  const auto unit = unit_line < next ? line_unit(text, unit_line) : std::nullopt;
  if (!unit)
    text.fail(channel.first, "a line `UNITS OF UNCOR ACCEL ARE SEC AND G/10.` in the text of the channel");
  const std::size_t first = next;
  const auto pairs = text.numbers(first, 2 * *points, pair_width, "times and samples", &next);
  std::vector<double> samples;
  for (std::size_t k = 0; k < pairs.size(); k += 2) {
    component.times.push_back(pairs[k]);
    samples.push_back(pairs[k + 1]);
  }
  const auto descent =
      std::adjacent_find(component.times.begin(), component.times.end(), std::greater_equal<>());
  if (descent != component.times.end() || component.times.size() < 2) {
    constexpr std::size_t pairs_per_line = 5;
    const auto at = static_cast<std::size_t>(descent - component.times.begin());
    text.fail(first + at / pairs_per_line, "times that ascend, in every second column");
  }
  component.start = component.times.front();
  component.notes.push_back("samples are not evenly spaced in time");
  set_samples(component, std::move(samples), *unit, find_chan_direction(text, channel, component.label));
  return next;
}

// Where the samples of the channel are whose text begins at line `first`.
Channel find_channel(const MotionText& text, std::size_t first) {
  Channel channel;
  channel.first = first;
  channel.uncorrected = contains(text, first, "uncorrected accelerogram");
  std::size_t k = first;
  while (k < text.size() && !is_title(text, k) && !contains(text, k, channel_end)) ++k;
  channel.block = k;
  channel.titled = k < text.size() && is_title(text, k);
  if (!channel.titled && !channel.uncorrected)
    text.fail(std::min(k, text.size() - 1), "a line `POINTS OF ACCEL DATA EQUALLY SPACED AT`");
  if (!channel.titled) channel.block = first + text_lines_1;
  return channel;
}

// After the samples there is the title of the velocities, the end mark or the next channel.
void check_after_samples(const MotionText& text, std::size_t next) {
  while (next < text.size() && trim(text.line(next)).empty()) ++next;
  if (next == text.size() || contains(text, next, channel_end) || contains(text, next, channel_start)) return;
  if (contains(text, next, "points of vel") || contains(text, next, "points of dis")) return;
  text.fail(next, "the velocities or the line `END OF DATA FOR CHANNEL` after the samples");
}

// The line after the end mark, or the first line of the next channel where the mark is missing.
std::size_t next_channel(const MotionText& text, std::size_t from, MotionComponent& component) {
  for (std::size_t k = from; k < text.size(); ++k) {
    const bool end = contains(text, k, channel_end);
    if (!end && !contains(text, k, channel_start)) continue;
    if (!end) component.notes.push_back("the line `END OF DATA FOR CHANNEL` is missing");
    std::size_t next = end ? k + 1 : k;
    while (next < text.size() && trim(text.line(next)).empty()) ++next;
    return next;
  }
  component.notes.push_back(
      "the line `END OF DATA FOR CHANNEL` is missing; the file may have been cut short");
  return text.size();
}

bool matches_csmip(const MotionText& text) {
  if (lower(text.line(0)).find("(format v") != std::string::npos ||
      lower(text.line(0)).find("gns") != std::string::npos)
    return false;
  constexpr std::size_t first_lines = 3;
  for (std::size_t k = 0; k < first_lines; ++k) {
    if (contains(text, k, channel_start) || contains(text, k, "response and fourier")) return true;
  }
  return text.find(block_title) < text.size();
}

std::vector<MotionComponent> read_csmip(const MotionText& text, const MotionReading& /*reading*/) {
  if (contains(text, 0, "response and fourier"))
    text.fail(0, "accelerations, as in the V1 and V2 files of the record; this is a file of spectra (V3)");
  std::vector<MotionComponent> components;
  for (std::size_t first = 0; first < text.size();) {
    const Channel channel = find_channel(text, first);
    MotionComponent component = make_component(text, channel.uncorrected ? "CSMIP V1" : "CSMIP V2");
    component.event = squeeze(text.line(first + (channel.uncorrected ? event_line_1 : event_line_2)));
    component.station = squeeze(text.line(first + (channel.uncorrected ? station_line_1 : station_line_2)));
    const std::size_t next =
        channel.titled ? read_titled(text, channel, component) : read_pairs(text, channel, component);
    check_channel_peak(text, channel, component);
    check_after_samples(text, next);
    first = next_channel(text, next, component);
    components.push_back(std::move(component));
  }
  return components;
}

}  // namespace

const MotionFormat csmip_format{"CSMIP V1 or V2", matches_csmip, read_csmip};

}  // namespace keyblock::loading
