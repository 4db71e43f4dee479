#include "loading/motion_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {
namespace {

// A word between blanks and signs that part words.
struct Token {
  std::string text;  // small letters, ² as 2, without ^ and *
  std::size_t at = 0;
  char before = ' ';    // the last sign before it that is no blank, if it stands right there
  bool joined = false;  // to the token before by an underscore
  bool closed = false;  // a bracket closes right after it
};

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string canonical(std::string_view word) {
  std::string out = lower(word);
  constexpr std::pair<std::string_view, std::string_view> plain[] = {{"²", "2"}, {"³", "3"}, {"⁻", "-"},
                                                                     {"−", "-"}, {"·", "."}, {"⋅", "."}};
  for (const auto& [sign, by] : plain) {
    for (std::size_t at = out.find(sign); at != std::string::npos; at = out.find(sign, at))
      out.replace(at, sign.size(), by);
  }
  std::erase_if(out, [](char c) { return c == '^' || c == '*'; });
  while (out.ends_with('.')) out.pop_back();
  while (out.starts_with('.') && out.size() > 1 && (out[1] < '0' || out[1] > '9')) out.erase(0, 1);
  return out;
}

std::vector<Token> tokens_of(std::string_view line) {
  constexpr std::string_view parting = " \t,;:()[]{}\"=|#_<>+";
  std::vector<Token> tokens;
  char before = ' ';
  bool joined = false;
  for (std::size_t at = 0; at < line.size();) {
    if (parting.find(line[at]) != std::string_view::npos) {
      if (line[at] != ' ' && line[at] != '\t') before = line[at];
      joined = line[at] == '_';
      if (!tokens.empty() && (line[at] == ')' || line[at] == ']')) tokens.back().closed = true;
      ++at;
      continue;
    }
    const std::size_t end = std::min(line.find_first_of(parting, at), line.size());
    std::string word = canonical(line.substr(at, end - at));
    if (word == "g" && !tokens.empty() && tokens.back().text == "%") {
      tokens.back().text = "%g";  // `% g`
    } else if (!word.empty()) {
      tokens.push_back({std::move(word), at, before, joined, false});
    }
    before = ' ';
    joined = false;
    at = end;
  }
  return tokens;
}

bool is_second(std::string_view word) {
  return is_one_of(word, {"s", "sec", "secs", "second", "seconds"});
}

// 1 for s, 2 for s2, s/s, s-2 and the like; 0 for anything else.
int seconds_power(std::string_view word) {
  if (word.starts_with('/')) word.remove_prefix(1);
  if (is_second(word)) return 1;
  if (word.ends_with("-2")) return is_second(word.substr(0, word.size() - 2)) ? 2 : 0;
  if (word.ends_with('2')) return is_second(word.substr(0, word.size() - 1)) ? 2 : 0;
  const std::size_t slash = word.find('/');
  return slash != std::string_view::npos && is_second(word.substr(0, slash)) &&
                 is_second(word.substr(slash + 1))
             ? 2
             : 0;
}

struct Length {
  const char* name;
  double metres;
};

const Length* length_of(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, Length>, 19> known{{
      {"mm", {"mm", 1e-3}},
      {"millimeter", {"mm", 1e-3}},
      {"millimetre", {"mm", 1e-3}},
      {"millimeters", {"mm", 1e-3}},
      {"millimetres", {"mm", 1e-3}},
      {"cm", {"cm", 0.01}},
      {"centimeter", {"cm", 0.01}},
      {"centimetre", {"cm", 0.01}},
      {"centimeters", {"cm", 0.01}},
      {"centimetres", {"cm", 0.01}},
      {"m", {"m", 1.0}},
      {"meter", {"m", 1.0}},
      {"metre", {"m", 1.0}},
      {"meters", {"m", 1.0}},
      {"metres", {"m", 1.0}},
      {"in", {"in", 0.0254}},
      {"inch", {"in", 0.0254}},
      {"inches", {"in", 0.0254}},
      {"ft", {"ft", 0.3048}},
  }};
  const auto* found =
      std::find_if(known.begin(), known.end(), [&](const auto& entry) { return entry.first == word; });
  return found == known.end() ? nullptr : &found->second;
}

// Accelerations that are no length over a time squared.
std::optional<AccelerationUnit> plain_acceleration(std::string_view word) {
  if (is_one_of(word, {"g", "gs", "g's"})) return AccelerationUnit{"g", standard_gravity};
  if (is_one_of(word, {"gal", "gals"})) return AccelerationUnit{"cm/s2", 0.01};
  if (is_one_of(word, {"mgal", "mgals"})) return AccelerationUnit{"mgal", 1e-5};
  if (word == "g/10") return AccelerationUnit{"g/10", standard_gravity / 10.0};
  if (is_one_of(word, {"mg", "milli-g"})) return AccelerationUnit{"mg", standard_gravity / 1000.0};
  if (word == "%g") return AccelerationUnit{"%g", standard_gravity / 100.0};
  return {};
}

UnitMention of_length(const Length& length, int power) {
  UnitMention mention;
  mention.kind = power == 2   ? UnitKind::acceleration
                 : power == 1 ? UnitKind::velocity
                              : UnitKind::displacement;
  if (power == 2) mention.unit = {std::string(length.name) + "/s2", length.metres};
  mention.sure = power > 0;
  return mention;
}

// `cm/s2`, and what is no unit of a motion but looks like one: `samples/s`.
std::optional<UnitMention> fraction(std::string_view head, std::string_view below) {
  const int power = seconds_power(below);
  if (power == 0) return {};
  if (const Length* length = length_of(head)) return of_length(*length, power);
  const bool rate = is_one_of(
      head, {"pts", "pt", "points", "point", "samples", "sample", "cyc", "cycles", "cycle", "", "1"});
  const bool letters = !head.empty() && std::all_of(head.begin(), head.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || c == '%' || (c & 0x80) != 0;
  });
  if (rate || !letters) return {};
  UnitMention mention;
  mention.sure = true;
  return mention;
}

// A unit without a sign between length and time, as names of columns have it: `cms2`, `cmss`, `mps2`; of a velocity `cms`, `mps`. `ms`
// is none, as it may be milliseconds.
std::optional<UnitMention> compact(std::string_view word) {
  for (const std::string_view prefix : {"mm", "cm", "in", "ft", "m"}) {
    if (!word.starts_with(prefix) || word == "ms") continue;
    std::string_view below = word.substr(prefix.size());
    if (below.starts_with('p')) below.remove_prefix(1);
    const bool twice = is_one_of(below, {"ss", "s2", "sec2", "secsec", "s-2", "sec-2"});
    if (!twice && !is_second(below)) continue;
    UnitMention mention = of_length(*length_of(prefix), twice ? 2 : 1);
    mention.sure = below.ends_with('2');
    return mention;
  }
  return {};
}

// A unit in one word.
std::optional<UnitMention> single(std::string_view word) {
  if (const auto plain = plain_acceleration(word)) {
    UnitMention mention;
    mention.kind = UnitKind::acceleration;
    mention.unit = *plain;
    mention.sure = !is_one_of(word, {"g", "gs"});
    return mention;
  }
  const std::size_t slash = word.find('/');
  if (slash != std::string_view::npos) return fraction(word.substr(0, slash), word.substr(slash + 1));
  if (const Length* length = length_of(word)) return of_length(*length, 0);
  for (const std::string_view end : {"s-2", "sec-2"}) {
    if (!word.ends_with(end)) continue;
    std::string_view start = word.substr(0, word.size() - end.size());
    if (start.ends_with('.')) start.remove_suffix(1);
    if (const Length* length = length_of(start)) return of_length(*length, 2);
  }
  if (auto mention = compact(word)) return mention;
  UnitMention mention;
  if (is_one_of(word, {"kine", "kines"})) {
    mention.kind = UnitKind::velocity;
    mention.sure = true;
    return mention;
  }
  if (is_one_of(word, {"km", "feet", "foot", "counts", "count", "digits", "volts", "volt", "mv", "m/s3"}))
    return mention;
  return {};
}

// A unit that begins with the length of token k and goes on in others: `cm / s / s`, `cm per second squared`, `cm_s_2`. `next` is the
// token after it.
std::optional<UnitMention> spread(const std::vector<Token>& tokens, std::size_t k, std::size_t& next) {
  const Length* length = length_of(tokens[k].text);
  if (length == nullptr) return {};
  int power = 0;
  bool over = false;
  std::size_t end = k + 1;
  for (std::size_t j = k + 1; j < tokens.size(); ++j) {
    const std::string& word = tokens[j].text;
    if (is_one_of(word, {"/", "per"})) {
      over = true;
      continue;
    }
    const bool divides = over || word.starts_with('/') || tokens[j].joined;
    const int seconds = seconds_power(word);
    if (seconds == 2 || (seconds == 1 && divides)) {
      power += seconds;
    } else if (power == 1 && is_one_of(word, {"squared", "square", "2", "-2"})) {
      power = 2;
    } else {
      break;
    }
    over = false;
    end = j + 1;
    if (power >= 2) break;
  }
  if (power == 0 || power > 2) return {};
  next = end;
  return of_length(*length, power);
}

// Whether what stands before token k announces a unit.
bool is_announced(const std::vector<Token>& tokens, std::size_t k) {
  const Token& token = tokens[k];
  if (k > 0 && is_one_of(tokens[k - 1].text, {"of", "in", "unit", "units", "are", "is", "and"}) &&
      token.before != ',')
    return true;
  return (token.before == '(' || token.before == '[') && token.closed;
}

bool is_factor(std::string_view word) {
  if (word.starts_with('x')) word.remove_prefix(1);
  return parse_number(word).has_value();
}

// Whether the number at token k stands where a unit should: `in 0.001 g`, `(1e-3 g)`.
bool announces_factor(const std::vector<Token>& tokens, std::size_t k) {
  if (tokens[k].before == '(' || tokens[k].before == '[') return true;
  return k > 0 && is_one_of(tokens[k - 1].text, {"of", "in", "unit", "units", "are", "is"});
}

// "units of", "the unit is", "unit:" and the like. "COMMUNITY HOSPITAL" and "UNIT 1" are none.
bool announces_unit(const std::vector<Token>& tokens, std::string_view line) {
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const std::string& word = tokens[k].text;
    if (!word.ends_with("unit") && !word.ends_with("units")) continue;
    if (word != "unit" && word != "units" && !word.ends_with("eunit") && !word.ends_with("eunits")) continue;
    const std::size_t end = line.find_first_not_of(' ', tokens[k].at + word.size());
    if (end != std::string_view::npos && (line[end] == ':' || line[end] == '=')) return true;
    if (k + 1 < tokens.size() && is_one_of(tokens[k + 1].text, {"of", "are", "is"})) return true;
  }
  return false;
}

}  // namespace

std::vector<UnitMention> unit_mentions(std::string_view line) {
  const std::vector<Token> tokens = tokens_of(line);
  std::vector<UnitMention> mentions;
  for (std::size_t k = 0; k < tokens.size();) {
    std::size_t next = k + 1;
    auto mention = spread(tokens, k, next);
    if (!mention) mention = single(tokens[k].text);
    const std::size_t end = tokens[next - 1].at + tokens[next - 1].text.size();
    // `g = 9.81` gives g a value and is no unit of anything.
    const std::size_t after = std::min(line.find_first_not_of(' ', end), line.size());
    const bool defined = mention && !mention->sure && line.substr(after).starts_with('=');
    if (mention && !defined) {
      mention->at = tokens[k].at;
      mention->words = lower(line.substr(tokens[k].at, std::min(end, line.size()) - tokens[k].at));
      mention->after_number = k > 0 && is_factor(tokens[k - 1].text);
      mention->scaled = mention->after_number && announces_factor(tokens, k - 1);
      mention->last = next == tokens.size();
      mention->sure = mention->sure || (is_announced(tokens, k) && tokens[k].text != "in");
      mentions.push_back(std::move(*mention));
    }
    k = next;
  }
  return mentions;
}

std::optional<AccelerationUnit> acceleration_unit(std::string_view words) {
  words = trim(words);
  const auto mentions = unit_mentions(words);
  const bool whole = mentions.size() == 1 && mentions[0].at == 0 && mentions[0].last;
  return whole && mentions[0].kind == UnitKind::acceleration ? std::optional(mentions[0].unit) : std::nullopt;
}

namespace {

std::optional<AccelerationUnit> unit_in_line(const MotionText& text, std::size_t line, std::size_t from,
                                             bool values) {
  const std::string_view words = text.line(line).substr(std::min(from, text.line(line).size()));
  const std::string expected = fmt::format("a unit of acceleration: {}", acceleration_units_text);
  std::optional<AccelerationUnit> unit;
  for (const UnitMention& mention : unit_mentions(words)) {
    const std::size_t column = from + mention.at + 1;
    const bool number = !values && (mention.scaled || (mention.sure && mention.after_number));
    if (number)
      text.fail(line, column, fmt::format("a number before the unit \"{}\"", mention.words),
                expected + ", and no factor");
    if (!mention.sure) continue;
    if (mention.kind != UnitKind::acceleration)
      text.fail(line, column, fmt::format("the unit \"{}\"", mention.words), expected);
    if (unit && unit->in_si != mention.unit.in_si)
      text.fail(line, column, fmt::format("two units, {} and {}", unit->name, mention.unit.name),
                "one unit of acceleration");
    unit = mention.unit;
  }
  if (!unit && announces_unit(tokens_of(words), words)) text.fail(line, expected);
  return unit;
}

}  // namespace

std::optional<AccelerationUnit> line_unit(const MotionText& text, std::size_t line, std::size_t from) {
  return unit_in_line(text, line, from, false);
}

std::optional<AccelerationUnit> unit_of_values(const MotionText& text, std::size_t line) {
  return unit_in_line(text, line, 0, true);
}

void refuse_other_quantity(const MotionText& text, std::size_t line) {
  const std::string words = lower(text.line(line));
  if (words.find("accel") != std::string::npos) return;
  if (words.find("veloc") != std::string::npos || words.find("displ") != std::string::npos)
    text.fail(line, "a time series of acceleration");
}

}  // namespace keyblock::loading
