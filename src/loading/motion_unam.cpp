#include <algorithm>

#include "loading/motion_formats.h"
#include "loading/text_table.h"

// `ARCHIVO ESTANDAR DE ACELERACION` of the Instituto de Ingenieria, UNAM, and other networks of Mexico: lines `KEY : value`, where those
// of the channels C1 to C6 part them by `/`; then the samples, a column for each channel, in gal.
//   ORIENTACION C1-C6 (rumbo;orientacion)  : /S00E;1/+V;2/N90W;3
//   INTERVALO DE MUESTREO, C1-C6 (s)       : /0.01/0.01/0.01
//   NUM. TOTAL DE MUESTRAS, C1-C6          : /8000/8000/8000
namespace keyblock::loading {
namespace {

constexpr std::string_view unam_title = "archivo estandar de aceleracion";
constexpr std::string_view orientation_key = "ORIENTACION C1-C6", step_key = "INTERVALO DE MUESTREO",
                           points_key = "NUM. TOTAL DE MUESTRAS", peak_key = "ACEL. MAX.";

// What stands between the `/` of a line, after its colon.
std::vector<std::string> channel_values(const MotionText& text, std::size_t line) {
  std::string_view rest = text.line(line);
  rest = trim(rest.substr(std::min(rest.find(':'), rest.size() - 1) + 1));
  if (rest.starts_with('/')) rest.remove_prefix(1);
  std::vector<std::string> values;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('/'), rest.size());
    const std::string value = squeeze(rest.substr(0, end));
    if (!value.empty()) values.push_back(value);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return values;
}

MotionDirection unam_direction(const MotionText& text, std::size_t line, const std::string& value) {
  std::string words = value.substr(0, value.find(';'));
  std::erase(words, '+');
  const bool negative = words.starts_with('-');
  if (negative) words.erase(0, 1);
  MotionDirection direction = parse_direction(words);
  if (!direction.stated()) text.fail(line, 1, quoted_text(value), "directions such as N90E, S00W or V");
  direction.downwards = direction.downwards || (negative && direction.vertical);
  return direction;
}

// Where the last `points` lines of numbers begin.
std::size_t first_row(const MotionText& text, std::size_t points) {
  std::size_t last = text.size();
  while (last > 0 && trim(text.line(last - 1)).empty()) --last;
  if (last < points) text.fail(0, "as many lines of samples as the header says");
  return last - points;
}

bool matches_unam(const MotionText& text) {
  constexpr std::size_t first_lines = 12;
  return text.find(unam_title) < std::min(first_lines, text.size());
}

std::vector<MotionComponent> read_unam(const MotionText& text, const MotionReading& /*reading*/) {
  const HeaderKeys keys(text);
  const std::size_t orientation = keys.required(orientation_key, "the directions of the channels");
  const auto directions = channel_values(text, orientation);
  const std::size_t step_line = keys.required(step_key, "the time step");
  const auto steps = channel_values(text, step_line);
  const std::size_t points_line = keys.required(points_key, "the number of samples");
  const auto counts = channel_values(text, points_line);
  if (directions.empty() || counts.size() < directions.size() || steps.size() < directions.size())
    text.fail(orientation, "a direction, a time step and a number of samples for each channel");
  const auto dt = parse_number(steps.front());
  if (!is_time_step(dt)) text.fail(step_line, time_step_text);
  const auto points = text.count(parse_number(counts.front()), 2);
  if (!points) text.fail(points_line, "the number of samples, which the file must hold");
  for (std::size_t c = 1; c < directions.size(); ++c) {
    if (steps[c] != steps[0] || counts[c] != counts[0])
      text.fail(points_line, "channels of one time step and one number of samples");
  }
  const std::size_t rows = first_row(text, *points), channels = directions.size();
  const std::string_view before = text.line(rows == 0 ? 0 : rows - 1);
  if (!trim(before).empty() && row_separator(before))
    text.fail(rows - 1, "no more lines of samples than the header says");
  const auto all = text.numbers(rows, channels * *points, 0, "samples in a column for each channel");
  const std::size_t peaks = keys.line(peak_key);
  const AccelerationUnit gal{"cm/s2", 0.01};
  std::vector<MotionComponent> components;
  for (std::size_t c = 0; c < channels; ++c) {
    MotionComponent component = make_component(text, unam_format.name);
    component.station = std::string(keys.value("NOMBRE DE LA ESTACION"));
    component.event = std::string(keys.value("FECHA DEL SISMO"));
    component.label = directions[c];
    component.dt = *dt;
    std::vector<double> samples(*points);
    for (std::size_t k = 0; k < *points; ++k) samples[k] = all[channels * k + c];
    set_samples(component, std::move(samples), gal, unam_direction(text, orientation, directions[c]));
    const auto stated = peaks < text.size() ? channel_values(text, peaks) : std::vector<std::string>{};
    if (const auto peak = c < stated.size() ? parse_number(stated[c]) : std::nullopt)
      compare_peak(component, *peak * gal.in_si);
    components.push_back(std::move(component));
  }
  return components;
}

}  // namespace

const MotionFormat unam_format{"UNAM ASA", matches_unam, read_unam};

}  // namespace keyblock::loading
