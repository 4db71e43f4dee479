#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "loading/motion_formats.h"
#include "loading/text_table.h"

// Records of the Central Weather Administration (before: Bureau), Taiwan: a header of lines `#Key: value`, then rows of time and three
// components.
//   #AmplitudeUnit:  gal. DCoffset(corr)
//   #DataSequence: Time U(+); N(+); E(+)
namespace keyblock::loading {
namespace {

constexpr std::string_view unit_key = "#AmplitudeUnit", sequence_key = "#DataSequence",
                           code_key = "#StationCode", origin_key = "#Origin Time";

// Words of `Time U(+); N(+); E(+)`: the name of each column.
std::vector<std::string> cwa_columns(std::string_view sequence) {
  std::string words(sequence);
  std::replace(words.begin(), words.end(), ';', ' ');
  std::replace(words.begin(), words.end(), ',', ' ');
  std::vector<std::string> columns;
  for (const std::string_view word : split_fields(words, ' ')) columns.emplace_back(word);
  return columns;
}

MotionDirection cwa_direction(const MotionText& text, std::size_t line, const std::string& column) {
  MotionDirection direction = parse_direction(column);
  if (!direction.stated()) text.fail(line, 1, quoted_text(column), "directions such as U(+), N(+), E(+)");
  if (column.find("(-)") == std::string::npos) return direction;
  constexpr double half_turn = 180.0, turn = 360.0;
  if (direction.vertical)
    direction.downwards = true;
  else
    direction.azimuth = *direction.azimuth < half_turn ? *direction.azimuth + half_turn
                                                       : *direction.azimuth + half_turn - turn;
  return direction;
}

// Samples by `#RecordLength(sec)` and `#SampleRate(Hz)`; a file that has both must hold them, and end with a whole row.
void check_length(const MotionText& text, const HeaderKeys& keys, const TextTable& table,
                  MotionComponent& component) {
  constexpr std::string_view length_key = "#RecordLength", rate_key = "#SampleRate";
  const auto after_colon = [&](std::string_view key) {
    const std::string_view line = text.line(keys.line(key));
    return parse_number(
        line.substr(std::min(line.find(':'), line.size() - (line.empty() ? 0 : 1)) + (line.empty() ? 0 : 1)));
  };
  const std::size_t rows = table.lines.size(), last = table.lines.back();
  if (rows > 1 && trim(text.line(last)).size() < trim(text.line(table.lines[rows - 2])).size() &&
      text.line(last).size() < text.line(table.lines[rows - 2]).size())
    text.fail(last, "a whole row: the file may have been cut short");
  const auto length = after_colon(length_key), rate = after_colon(rate_key);
  if (!length || !rate) return;
  const double stated = std::round(*length * *rate), found = static_cast<double>(rows);
  if (found < stated) text.fail(last, fmt::format("{} rows, as {} s at {} Hz have", stated, *length, *rate));
  if (found > stated + 1.0)
    component.notes.push_back(fmt::format("the header states {} samples, the file has {}", stated, found));
}

bool matches_cwa(const MotionText& text) {
  return lower(text.line(0)).starts_with("#earthquake information");
}

std::vector<MotionComponent> read_cwa(const MotionText& text, const MotionReading& /*reading*/) {
  const HeaderKeys keys(text);
  const std::size_t unit_line = keys.required(unit_key, "the unit");
  const auto unit = line_unit(text, unit_line, unit_key.size());
  const auto word = trim(keys.value(unit_key));
  const auto first_word = acceleration_unit(word.substr(0, word.find_first_of(" .,")));
  if (!unit && !first_word)
    text.fail(unit_line, std::string("a unit of acceleration: ") + acceleration_units_text);
  const std::size_t sequence_line = keys.required(sequence_key, "the columns");
  const auto columns = cwa_columns(keys.value(sequence_key));
  if (columns.size() < 2 || lower(columns.front()) != "time")
    text.fail(sequence_line, "the columns, as in `Time U(+); N(+); E(+)`");
  TextTable table = read_rows(text, sequence_line);
  if (table.columns.size() != columns.size())
    text.fail(table.lines.front(), "as many columns as the header names");
  MotionComponent pattern = make_component(text, cwa_format.name);
  pattern.station = std::string(keys.value(code_key));
  pattern.event = std::string(keys.value(origin_key));
  set_times(text, table, 1.0, pattern);
  check_length(text, keys, table, pattern);
  std::vector<MotionComponent> components;
  for (std::size_t c = 1; c < columns.size(); ++c) {
    components.push_back(pattern);
    components.back().label = columns[c];
    set_samples(components.back(), std::move(table.columns[c]), unit ? *unit : *first_word,
                cwa_direction(text, sequence_line, columns[c]));
  }
  return components;
}

}  // namespace

const MotionFormat cwa_format{"CWA", matches_cwa, read_cwa};

}  // namespace keyblock::loading
