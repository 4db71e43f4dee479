#include "loading/table_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "loading/text_table.h"

namespace keyblock::loading {
namespace {

std::vector<std::string> words_between(std::string_view text, std::string_view parting) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(parting), text.size());
    if (end > 0) words.push_back(lower(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

bool is_any(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string unquoted(std::string_view field) {
  std::string text(trim(field));
  std::erase(text, '"');
  std::erase(text, '\'');
  return std::string(trim(text));
}

// Fields that blanks part, where what is in brackets belongs to the field before: `Time [ms] acc [g]`.
std::vector<std::string> blank_fields(std::string_view line) {
  std::vector<std::string> fields;
  int depth = 0;
  for (const std::string_view word : split_fields(line, ' ')) {
    const bool bracket = word.starts_with('(') || word.starts_with('[');
    if (!fields.empty() && (depth > 0 || bracket)) {
      fields.back() += ' ';
      fields.back() += word;
    } else {
      fields.emplace_back(word);
    }
    for (const char c : word) depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
  }
  return fields;
}

// Fields that `parting` parts where it stands in no quotes.
std::vector<std::string> parted_names(std::string_view line, char parting) {
  std::vector<std::string> names;
  char quote = 0;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    const char c = k < line.size() ? line[k] : parting;
    const bool at_start = trim(line.substr(begin, k - begin)).empty();
    if (quote == 0 && c == parting) {
      names.push_back(unquoted(line.substr(begin, k - begin)));
      begin = k + 1;
    } else if (c == quote) {
      quote = 0;
    } else if (quote == 0 && at_start && (c == '"' || c == '\'')) {
      quote = c;
    }
  }
  return names;
}

// The names of `count` columns; with two columns, all words but the last may be of the time. Empty when there are more or fewer.
std::vector<std::string> column_names(std::string_view line, std::size_t count) {
  line = trim(line);
  for (const char parting : {';', ',', '\t'}) {
    if (line.find(parting) == std::string_view::npos) continue;
    std::vector<std::string> names = parted_names(line, parting);
    if (names.size() == count) return names;
  }
  std::vector<std::string> names;
  for (const std::string_view word : split_fields(line, ' ')) names.push_back(unquoted(word));
  if (names.size() == count) return names;
  names = blank_fields(line);
  for (std::string& name : names) name = unquoted(name);
  if (names.size() == count) return names;
  if (count != 2 || names.size() < count) return {};
  std::string time = names.front();
  for (std::size_t k = 1; k + 1 < names.size(); ++k) time += " " + names[k];
  return {time, names.back()};
}

// Seconds per unit; absent for any other word.
std::optional<double> time_unit(std::string_view word) {
  for (const char* second : {"s", "sec", "secs", "second", "seconds"}) {
    if (word == second) return 1.0;
    if (word == std::string("m") + second || word == std::string("milli") + second) return 1e-3;
  }
  return {};
}

// Seconds per unit of time that a name has, such as `time (ms)`, `t_s` or `t ms`; 1 when it names none.
double time_unit_of(const MotionText& text, std::size_t line, std::string_view time) {
  const char* expected = "a unit of time in the header: s or ms";
  const std::size_t open = time.find_first_of("([");
  const std::size_t close = time.find_first_of(")]");
  if (open < close && close != std::string_view::npos) {
    const auto unit = time_unit(lower(trim(time.substr(open + 1, close - open - 1))));
    if (!unit) text.fail(line, expected);
    return *unit;
  }
  for (const std::string& word : words_between(time, " \t_:/\"()[]")) {
    if (const auto unit = time_unit(word)) return *unit;
    if (is_any(word, {"us", "µs", "ns", "usec", "min", "mins", "minutes", "h", "hr", "hours"}))
      text.fail(line, expected);
  }
  return 1.0;
}

bool is_time_name(std::string_view name) {
  const auto words = words_between(name, " \t_:/()[]");
  return !words.empty() && (words.front().starts_with("time") ||
                            is_any(words.front(), {"t", "sec", "seconds", "s", "zeit", "temps"}));
}

// What is in the last brackets of a name that is no unit may be a direction or a sign: `U(+)`, `acc (N-S)`.
bool is_plain_bracket(std::string_view name) {
  const std::size_t open = name.find_last_of("([");
  if (open == std::string_view::npos) return true;
  const std::string_view words = trim(name.substr(open + 1, name.find_first_of(")]", open) - open - 1));
  return words == "+" || words == "-" || parse_direction(words).stated();
}

// A name whose last word can be nothing but a unit that is not understood: `acc in furlongs`, `a_cm/s3`, `acc (xyz)`.
bool has_strange_unit(std::string_view name) {
  if (!is_plain_bracket(name)) return true;
  const auto words = words_between(name, " \t_:");
  if (words.empty()) return false;
  const bool after_in = words.size() > 1 && words[words.size() - 2] == "in";
  return after_in || words.back().find_first_of("/%") != std::string::npos;
}

// `a (1e-3 g)`, `a 0.001 g`; the number of `acc_090_g` is none of this kind.
bool is_scaled(std::string_view name, const UnitMention& mention) {
  if (mention.scaled) return true;
  const auto words = words_between(name.substr(0, mention.at), " \t_:()[]");
  return mention.after_number && !words.empty() && words.back().find_first_of(".ex") != std::string::npos;
}

MotionDirection name_direction(std::string_view name) {
  for (const std::string& word : words_between(name, " \t_:()[]/,")) {
    if (is_any(word, {"v", "s", "w", "g"})) continue;
    const bool number = parse_number(word).has_value();
    constexpr std::size_t digits_of_azimuth = 3;
    if (number && word.size() != digits_of_azimuth) continue;
    if (const auto direction = parse_direction(word); direction.stated()) return direction;
    if (const auto direction = channel_code_direction(word); direction.stated()) return direction;
  }
  return {};
}

bool is_digit(const std::string& words, std::size_t k) {
  return k < words.size() && words[k] >= '0' && words[k] <= '9';
}

// Length of a sign of multiplication at place k: `*`, `×`, or an `x` that belongs to no word; 0: there is none.
std::size_t multiplication_sign(const std::string& words, std::size_t k) {
  if (words.compare(k, 2, "×") == 0) return 2;
  const bool in_word = k > 0 && words[k - 1] >= 'a' && words[k - 1] <= 'z';
  return words[k] == '*' || (words[k] == 'x' && !in_word) ? 1 : 0;
}

// Whether the sign of this length at place k has a number beside it that is no exponent.
bool multiplies(const std::string& words, std::size_t k, std::size_t length) {
  const std::size_t after = std::min(words.find_first_not_of("* ", k + length), words.size());
  if (words[k] == 'x')  // `x10`, `x 0.01`; x1 is a name
    return is_digit(words, after) &&
           (words.compare(after, 2, "10") == 0 || words.find('.', after) < words.size());
  std::size_t before = k;
  while (before > 0 && (words[before - 1] == ' ' || words[before - 1] == '*')) --before;
  const char last = before > 0 ? words[before - 1] : ' ';
  const bool is_exponent = (last == 's' || last == 'c') && words[after] == '2' && !is_digit(words, after + 1);
  const bool number_before = last >= '0' && last <= '9' && words[after] != 's';
  return !is_exponent && (is_digit(words, after) || number_before);
}

// A number that multiplies the samples or their unit: `acc*10`, `m/s2 x 100`. The exponent of `s**2` is none.
bool has_factor(std::string_view name) {
  const std::string words = lower(name);
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::size_t length = multiplication_sign(words, k);
    if (length > 0 && multiplies(words, k, length)) return true;
  }
  return false;
}

// What the words of a name say that the column is.
UnitKind kind_of_words(const std::string& name) {
  const std::string words = lower(name);
  if (words.find("acc") != std::string::npos) return UnitKind::acceleration;
  const auto all = words_between(words, " \t_:()[]/,.-");
  const auto has = [&](std::initializer_list<std::string_view> known) {
    return std::any_of(all.begin(), all.end(), [&](const std::string& word) { return is_any(word, known); });
  };
  if (words.find("veloc") != std::string::npos || words.starts_with("vel") || has({"vel", "vx", "vy", "vz"}))
    return UnitKind::velocity;
  if (words.find("displ") != std::string::npos || words.starts_with("disp") ||
      has({"disp", "dis", "ux", "uy", "uz", "dx", "dy", "dz"}))
    return UnitKind::displacement;
  return UnitKind::acceleration;
}

TableColumn read_column_name(const MotionText& text, std::size_t line, const std::string& name) {
  TableColumn column;
  column.name = name;
  column.kind = kind_of_words(name);
  const auto mentions = unit_mentions(name);
  const auto is_unit = [&](const UnitMention& m) {
    return m.sure || (m.last && (m.at > 0 || m.kind == UnitKind::acceleration)) ||
           (m.at > 0 && m.words.size() > 2 && m.kind != UnitKind::unknown);
  };
  const auto mention = std::find_if(mentions.begin(), mentions.end(), is_unit);
  const bool other = column.kind != UnitKind::acceleration;
  if (!other && has_factor(name))
    text.fail(line, 1, quoted_text(name),
              fmt::format("a unit of acceleration without a factor beside it: {}", acceleration_units_text),
              "unit = \"…\" names the unit that a sample of 1 has, as \"mm/s2\" or \"g/10\"");
  if (mention == mentions.end() ? !other && has_strange_unit(name)
                                : !other && (mention->kind == UnitKind::unknown || is_scaled(name, *mention)))
    text.fail(line, 1, quoted_text(name),
              fmt::format("a unit of acceleration in the header: {}", acceleration_units_text),
              "other files are read with skip, column, dt and unit");
  if (mention != mentions.end() && !other) column.kind = mention->kind;
  if (mention != mentions.end() && column.kind == UnitKind::acceleration) column.unit = mention->unit;
  column.direction = name_direction(name);
  return column;
}

// Beside a column `a` or `acc` those that begin with `v`, `d` or `u` alone are velocity and displacement. Elsewhere they may be directions.
void tell_quantities_apart(std::vector<TableColumn>& columns) {
  const auto first_word = [](const TableColumn& column) {
    const auto words = words_between(column.name, " \t_:()[]/,.-");
    return words.empty() ? std::string() : words.front();
  };
  const bool acceleration = std::any_of(columns.begin(), columns.end(), [&](const TableColumn& column) {
    const std::string word = first_word(column);
    return word == "a" || word.starts_with("acc");
  });
  if (!acceleration) return;
  for (TableColumn& column : columns) {
    if (column.unit) continue;
    const std::string word = first_word(column);
    if (word == "v") column.kind = UnitKind::velocity;
    if (word == "d" || word == "u" || word == "s") column.kind = UnitKind::displacement;
  }
}

void check_time_column(const MotionText& text, std::size_t line, const std::vector<std::string>& names) {
  const bool later = std::any_of(names.begin() + 1, names.end(),
                                 [](const std::string& name) { return lower(name).starts_with("time"); });
  const bool first = is_time_name(names.front());
  const std::string lower_first = lower(names.front());
  const bool other = parse_direction(names.front()).stated() || lower_first.starts_with("acc") ||
                     lower_first.starts_with("vel") || lower_first.starts_with("disp");
  if (!first && (later || other))
    text.fail(line, 1, quoted_text(names.front()), "time in the first column",
              "other tables are read with skip, column, dt and unit");
}

}  // namespace

std::string_view comment_words(std::string_view line) {
  line = trim(line);
  line.remove_prefix(std::min(line.find_first_not_of("#%!/ \t"), line.size()));
  const std::size_t colon = line.find(':');
  return colon == std::string_view::npos ? line : trim(line.substr(colon + 1));
}

bool names_columns(std::string_view line, std::size_t count) {
  const auto names = column_names(line, count);
  return !names.empty() && is_time_name(names.front()) && !parse_number(names.back());
}

bool has_column_names(std::string_view line, std::size_t count) {
  return !column_names(line, count).empty();
}

TableHeader read_table_header(const MotionText& text, const std::vector<std::size_t>& lines,
                              std::size_t count) {
  TableHeader header;
  header.columns.resize(count - 1);
  if (lines.empty()) return header;
  std::vector<std::string> names(count);
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    const std::string_view words = text.line(*line);
    const auto more = column_names(is_comment(words) ? comment_words(words) : words, count);
    if (more.empty())
      text.fail(*line, 1, quoted_text(words), fmt::format("the names of {} columns", count),
                "other tables are read with skip, column, dt and unit");
    for (std::size_t c = 0; c < count; ++c) names[c] += (names[c].empty() ? "" : " ") + more[c];
  }
  check_time_column(text, lines.back(), names);
  header.time_unit_in_brackets = names.front().find_first_of("([") != std::string::npos;
  header.seconds = time_unit_of(text, lines.back(), names.front());
  for (std::size_t c = 1; c < count; ++c)
    header.columns[c - 1] = read_column_name(text, lines.back(), names[c]);
  tell_quantities_apart(header.columns);
  return header;
}

}  // namespace keyblock::loading
