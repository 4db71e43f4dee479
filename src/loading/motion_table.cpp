#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loading/fixed_columns.h"
#include "loading/motion_formats.h"
#include "loading/table_header.h"
#include "loading/text_table.h"

// Tables: time and one or several accelerations, with or without names of the columns.
namespace keyblock::loading {
namespace {

constexpr std::size_t most_columns = 20, most_unnamed_columns = 4, most_header_lines = 2,
                      most_title_lines = 20;

// Whether a line that is no row was meant as one: a first row that is damaged is no header.
bool begins_like_row(std::string_view line) {
  const std::string first = lower(trim(line).substr(0, trim(line).find_first_of(" \t,;")));
  const bool number = first.find_first_not_of("0123456789+-.e") == std::string::npos &&
                      first.find_first_of("0123456789") != std::string::npos;
  return number || first == "nan" || first == "inf" || first == "-inf";
}

// The first line that is a row of two numbers or more, or that was meant as one.
std::size_t table_start(const MotionText& text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::string_view line = text.line(k);
    if (is_comment(line)) continue;
    const auto separator = row_separator(line);
    if ((separator && split_fields(line, *separator).size() >= 2) || begins_like_row(line)) return k;
  }
  return text.size();
}

// The lines before the first row that have the names of the columns, from the last one upwards: titles may stand above. Without any, the
// comment right before the rows where it has the names.
std::vector<std::size_t> header_lines(const MotionText& text, std::size_t rows, std::size_t columns) {
  std::vector<std::size_t> lines;
  for (std::size_t k = rows; k-- > 0;) {
    if (!is_comment(text.line(k))) lines.push_back(k);
  }
  for (std::size_t k = std::min(lines.size(), most_header_lines); k-- > 0;) {
    if (!names_columns(text.line(lines[k]), columns)) continue;
    lines.resize(k + 1);
    break;
  }
  const bool named = std::any_of(lines.begin(), lines.end(), [&](std::size_t line) {
    return has_column_names(text.line(line), columns);
  });
  if (!named) lines.clear();
  if (lines.empty() && rows > 0 && !trim(text.line(rows - 1)).empty() &&
      names_columns(comment_words(text.line(rows - 1)), columns))
    lines.push_back(rows - 1);
  return lines;
}

// Titles stand above names of the columns only: other text with numbers in it is no table.
bool may_follow(const MotionText& text, const std::vector<std::size_t>& lines, std::size_t columns) {
  if (lines.size() <= most_header_lines) return true;
  for (std::size_t k = 1; k <= most_header_lines; ++k) {
    if (names_columns(text.line(lines[lines.size() - k]), columns)) return true;
  }
  return false;
}

bool matches_table(const MotionText& text) {
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::string_view line = text.line(k);
    if (is_comment(line)) continue;
    const auto separator = row_separator(line);
    const std::size_t fields = separator ? split_fields(line, *separator).size() : 0;
    if (fields >= 2) return may_follow(text, others, fields);
    if (others.empty() && begins_like_row(line) &&
        trim(line).find_first_of(" \t,;") != std::string_view::npos)
      return true;
    others.push_back(k);
    if (others.size() > most_title_lines) return false;
  }
  return false;
}

// Units of acceleration that the comment in line k names. One that speaks of a unit in passing must not be passed over.
std::vector<UnitMention> units_in_comment(const MotionText& text, std::size_t k) {
  std::vector<UnitMention> units;
  const std::string words = lower(text.line(k));
  const bool announces = words.find("unit") != std::string::npos ||
                         words.find("accel") != std::string::npos || words.find("acc.") != std::string::npos;
  for (const UnitMention& mention : unit_mentions(words)) {
    const bool acceleration = mention.kind == UnitKind::acceleration;
    if (!mention.sure && !(acceleration && mention.after_number)) continue;
    const bool named = announces && mention.sure;
    if (!acceleration && !named) continue;
    const bool plain = acceleration && mention.unit.in_si == 1.0;
    if ((!acceleration || !named) && !plain)
      text.fail(k, mention.at + 1, quoted_text(mention.words),
                "the unit in a header line, such as 'time (s), acceleration (cm/s2)', or in a comment "
                "'# units: cm/s2'");
    units.push_back(mention);
  }
  return units;
}

// A comment, or a title above line `top`, may name the unit: `# units: cm/s2`, `# acceleration in gal`.
std::optional<AccelerationUnit> comment_unit(const MotionText& text, std::size_t top,
                                             MotionComponent& first) {
  std::optional<AccelerationUnit> unit;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (k >= top && !is_comment(text.line(k))) continue;
    for (const UnitMention& mention : units_in_comment(text, k)) {
      if (unit && unit->in_si != mention.unit.in_si)
        text.fail(k, mention.at + 1, quoted_text(mention.words), "one unit of acceleration in the comments");
      if (!unit)
        first.notes.push_back(
            fmt::format("the unit {} is that of {} {}", mention.unit.name,
                        is_comment(text.line(k)) ? "the comment in line" : "the title in line", k + 1));
      unit = mention.unit;
    }
  }
  return unit;
}

// The unit that the columns name, if they name one.
std::optional<AccelerationUnit> named_unit(const MotionText& text, const TableHeader& header,
                                           std::size_t line) {
  std::optional<AccelerationUnit> named;
  bool unnamed = false, different = false;
  for (const TableColumn& column : header.columns) {
    if (column.kind != UnitKind::acceleration) continue;
    unnamed = unnamed || !column.unit;
    different = different || (named && column.unit && named->in_si != column.unit->in_si);
    if (column.unit) named = column.unit;
  }
  if (unnamed && different)
    text.fail(line, fmt::format("the unit of every column: {}", acceleration_units_text));
  return named;
}

// The unit of columns that name none: that of the other columns, that of the user, or that of a comment.
AccelerationUnit common_unit(const MotionText& text, const TableHeader& header, std::size_t line,
                             const MotionReading& reading, MotionComponent& first) {
  if (const auto named = named_unit(text, header, line)) return *named;
  if (const auto stated = stated_unit(text, reading)) return *stated;
  if (const auto unit = comment_unit(text, line, first)) return *unit;
  refuse_without_unit(text, line);
}

// Names and units of the columns of a table whose rows begin at line `rows`.
TableHeader header_of(const MotionText& text, std::size_t rows, std::size_t columns, std::size_t& line) {
  const auto lines = header_lines(text, rows, columns);
  line = lines.empty() ? rows : lines.back();
  if (columns > most_columns || (lines.empty() && columns > most_unnamed_columns))
    text.fail(line, 1, fmt::format("{} columns without names", columns),
              fmt::format("a table of time and accelerations, {} columns at most, without names {}",
                          most_columns, most_unnamed_columns),
              "other text is read with skip, column, dt and unit");
  return read_table_header(text, lines, columns);
}

// A table without names whose second column goes up evenly has times there, and perhaps a count in the first one.
void check_unnamed(const MotionText& text, const TextTable& table) {
  const std::vector<double>& second = table.columns[1];
  constexpr std::size_t least_rows = 10;
  if (second.size() < least_rows || table.columns.size() < 3) return;
  const double step = second[1] - second[0], rounding = 1e-3 * step;
  for (std::size_t k = 1; k < second.size(); ++k) {
    if (!(step > 0.0) || !(std::abs(second[k] - second[0] - step * static_cast<double>(k)) <= rounding))
      return;
  }
  text.fail(table.lines.front(), 1, "a second column that goes up evenly, as times do",
            "times in the first column only", "other tables are read with skip, column, dt and unit");
}

// Adds numbers in turn of times, which ascend, and accelerations; false where they are none.
bool append_pairs(const std::vector<std::string_view>& fields, std::vector<double>& pairs) {
  for (const std::string_view field : fields) {
    const auto number = parse_number(field);
    const bool is_time = pairs.size() % 2 == 0, is_first = pairs.size() < 2;
    if (!number || (is_time && !is_first && !(*number > pairs[pairs.size() - 2]))) return false;
    pairs.push_back(*number);
  }
  return true;
}

// Several pairs of time and acceleration in a line, the last one perhaps with fewer: the times ascend from pair to pair. Of other tables the
// third column holds accelerations, which do not lie between the times around them.
std::optional<std::vector<double>> pairs_of(const MotionText& text, std::size_t rows,
                                            std::vector<std::size_t>& lines) {
  constexpr std::size_t least_pairs = 8, least_columns = 4;
  std::vector<double> pairs;
  std::size_t columns = 0, last = 0;  // of the first row; of the last one
  for (std::size_t k = rows; k < text.size(); ++k) {
    if (is_comment(text.line(k))) continue;
    const auto separator = row_separator(text.line(k));
    if (!separator || last < columns) return {};
    const auto fields = split_fields(text.line(k), *separator);
    last = fields.size();
    if (columns == 0) columns = last;
    if (columns < least_columns || last % 2 != 0 || last > columns || !append_pairs(fields, pairs)) return {};
    lines.resize(pairs.size() / 2, k);
  }
  if (pairs.size() < 2 * least_pairs) return {};
  return pairs;
}

// The unit that lines before the rows name, or the user.
AccelerationUnit unit_of_pairs(const MotionText& text, std::size_t rows, const MotionReading& reading) {
  std::optional<AccelerationUnit> unit;
  for (std::size_t k = 0; k < rows; ++k) {
    refuse_other_quantity(text, k);
    const auto named = line_unit(text, k);
    if (named && unit && named->in_si != unit->in_si) text.fail(k, "one unit of acceleration");
    if (named) unit = named;
  }
  if (!unit) unit = stated_unit(text, reading);
  if (!unit) refuse_without_unit(text, rows);
  return *unit;
}

std::vector<MotionComponent> read_table(const MotionText& text, const MotionReading& reading) {
  const std::size_t rows = table_start(text);
  std::vector<std::size_t> lines;
  if (const auto pairs = pairs_of(text, rows, lines)) {
    MotionComponent component = make_component(text, "pairs of time and acceleration");
    set_pairs(
        text, *pairs, [&](std::size_t k) { return lines[k]; }, unit_of_pairs(text, rows, reading), {},
        component);
    return {std::move(component)};
  }
  const auto separator = row_separator(text.line(rows));
  if (!separator || split_fields(text.line(rows), *separator).size() < 2)
    text.fail(rows, "two finite numbers: time and acceleration");
  TextTable table = read_rows(text, rows);
  std::size_t line = rows;
  const TableHeader header = header_of(text, rows, table.columns.size(), line);
  if (line == rows) check_unnamed(text, table);
  std::vector<MotionComponent> components;
  MotionComponent pattern = make_component(text, table_format.name);
  set_times(text, table, header.seconds, pattern);
  const bool some = std::any_of(header.columns.begin(), header.columns.end(),
                                [](const TableColumn& c) { return c.kind == UnitKind::acceleration; });
  if (!some) text.fail(line, fmt::format("a time series of acceleration, in {}", acceleration_units_text));
  const AccelerationUnit unit = common_unit(text, header, line, reading, pattern);
  for (const TableColumn& column : header.columns) {
    if (column.kind != UnitKind::acceleration)
      pattern.processing += fmt::format("{}column \"{}\" is no acceleration and is left out",
                                        pattern.processing.empty() ? "" : "; ", column.name);
  }
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const TableColumn& column = header.columns[c];
    if (column.kind != UnitKind::acceleration) continue;
    components.push_back(pattern);
    components.back().label = column.name;
    pattern.notes.clear();
    set_samples(components.back(), std::move(table.columns[c + 1]), column.unit.value_or(unit),
                column.direction);
  }
  return components;
}

}  // namespace

const MotionFormat table_format{"table", matches_table, read_table};

}  // namespace keyblock::loading
