#include "scenario/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scenario/key_hints.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"

namespace keyblock::scenario {
namespace {

constexpr std::string_view no_default = "none";

bool in_range(double value, const Rule& rule) {
  return std::isfinite(value) && value > rule.above && value >= rule.at_least && value <= rule.at_most &&
         value < rule.below;
}

std::string range_text(const Rule& rule) {
  std::string lower, upper;
  if (std::isfinite(rule.above)) lower = fmt::format("above {}", rule.above);
  if (std::isfinite(rule.at_least)) lower = fmt::format("of at least {}", rule.at_least);
  if (std::isfinite(rule.at_most)) upper = fmt::format("at most {}", rule.at_most);
  if (std::isfinite(rule.below)) upper = fmt::format("below {}", rule.below);
  if (std::isfinite(rule.at_least) && std::isfinite(rule.at_most)) {
    return fmt::format(" from {} to {}", rule.at_least, rule.at_most);
  }
  return (lower.empty() ? "" : " " + lower) + (!lower.empty() && !upper.empty() ? " and" : "") +
         (upper.empty() ? "" : " " + upper);
}

KeyType numeric(const Rule& rule, bool integer) {
  const auto bound = [](double value) {
    return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
  };
  KeyType type{integer ? KeyKind::integer : KeyKind::number};
  type.above = bound(rule.above);
  type.at_least = bound(rule.at_least);
  type.at_most = bound(rule.at_most);
  type.below = bound(rule.below);
  return type;
}

std::string with_article(const std::string& type) {
  if (type.front() < 'a' || type.front() > 'z') return type;
  return (std::string_view("aeiou").find(type.front()) == std::string_view::npos ? "a " : "an ") + type;
}

std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

}  // namespace

SourcePosition nearest_position(const std::map<std::string, SourcePosition>& positions,
                                std::string key_path) {
  while (!key_path.empty()) {
    const auto position = positions.find(key_path);
    if (position != positions.end()) return position->second;
    const auto end = key_path.find_last_of(".[");
    key_path.resize(end == std::string::npos ? 0 : end);
  }
  return {};
}

SourcePosition ReadContext::where(const std::string& key_path) const {
  return nearest_position(positions, key_path);
}

TableReader::TableReader(ReadContext& context, const Value* root) : TableReader(context, root, "", 0, "") {
  if (documenting()) context_.reference->push_back({"", "They stand at the top of the file.", {}});
}

TableReader::TableReader(ReadContext& context, const Value* table, std::string path, std::size_t section,
                         std::string prefix)
    : context_(context),
      table_(table),
      path_(std::move(path)),
      section_(section),
      prefix_(std::move(prefix)) {}

std::string TableReader::path_of(std::string_view key) const {
  return join_path(path_, key);
}

const Value* TableReader::find(std::string_view key) const {
  return table_ == nullptr ? nullptr : table_->find(key);
}

void TableReader::fail_at(const Value& value, const std::string& path, std::string found,
                          std::string expected, std::string hint) {
  context_.mistakes.add({value.where, path, std::move(found), std::move(expected), std::move(hint)});
}

void TableReader::fail(std::string_view key, std::string found, std::string expected, std::string hint) {
  if (documenting()) return;
  const Value* value = find(key);
  fail_at(value != nullptr ? *value : *table_, path_of(key), std::move(found), std::move(expected),
          std::move(hint));
}

void TableReader::judge(const Value& value, const std::string& path, double number, const Usual* usual) {
  if (usual == nullptr || !judges_) return;
  const std::string text = unusual_text(*usual, number);
  if (text.empty()) return;
  context_.unusual.push_back({path, fmt::format("{} = {}{}: {}", path, with_unit(number, usual->unit),
                                                place_text(value.where), text)});
}

void TableReader::missing(std::string_view key, std::string expected, std::string hint) {
  fail(key, "nothing", std::move(expected), std::move(hint));
}

void TableReader::finish() {
  if (table_ == nullptr) return;
  for (const Value& member : table_->items) {
    if (std::find(known_.begin(), known_.end(), member.key) != known_.end()) continue;
    // Hints are looked for in every word that the program knows.
    const std::string hint = context_.mistakes.full() ? std::string() : key_hint(member.key, known_);
    std::string keys;
    for (const std::string& key : known_) keys += (keys.empty() ? "" : ", ") + key;
    context_.mistakes.add(
        {member.key_where, path_of(member.key), "an unknown key",
         hint.empty() ? "one of " + keys : "a key of " + (path_.empty() ? "the scenario" : path_), hint});
  }
}

void TableReader::describe_key(std::string_view key, const Rule& rule, KeyType value_type,
                               const std::string& type, const std::string& fallback) {
  value_type.required = rule.required && rule.condition.empty();
  std::string meaning(rule.meaning);
  if (!rule.condition.empty()) meaning += fmt::format(" Only with {}.", rule.condition);
  std::string standard = rule.required ? "required" : std::string(rule.fallback);
  if (standard.empty()) standard = fallback.empty() ? no_default : fallback;
  (*context_.reference)[section_].keys.push_back(
      {prefix_ + std::string(key), type, standard, std::string(rule.unit), meaning, std::move(value_type)});
}

const Value* TableReader::take(std::string_view key, const Rule& rule, KeyType value_type,
                               const std::string& type, const std::string& fallback) {
  known_.emplace_back(key);
  if (documenting()) {
    describe_key(key, rule, std::move(value_type), type, fallback);
    return nullptr;
  }
  const Value* value = find(key);
  if (!rule.applies) {
    if (value != nullptr) {
      context_.mistakes.add({value->key_where, path_of(key), "a key that is not used here",
                             fmt::format("it only with {}", rule.condition), ""});
    }
    return nullptr;
  }
  if (value != nullptr) {
    context_.positions[path_of(key)] = value->where;
  } else if (rule.required) {
    missing(key, with_article(type) + (rule.unit.empty() ? "" : fmt::format(", in {}", rule.unit)));
  }
  return value;
}

const Value* TableReader::any(std::string_view key, std::string_view type, const Rule& rule) {
  KeyType value_type;
  value_type.kinds.assign(rule.kinds.begin(), rule.kinds.end());
  return take(key, rule, std::move(value_type), std::string(type), "");
}

std::optional<double> TableReader::take_number(std::string_view key, const Rule& rule, bool integer,
                                               const std::string& fallback) {
  const std::string type = (integer ? "integer" : "number") + range_text(rule);
  const Value* value = take(key, rule, numeric(rule, integer), type, fallback);
  if (value == nullptr) return std::nullopt;
  const bool right_type = integer ? value->is(Value::Type::integer) : value->is_number();
  if (right_type && in_range(value->number, rule)) {
    judge(*value, path_of(key), value->number, rule.usual);
    return value->number;
  }
  fail(key, describe(*value),
       with_article(type) + (rule.unit.empty() ? "" : fmt::format(", in {}", rule.unit)));
  return std::nullopt;
}

bool TableReader::number(std::string_view key, double& value, const Rule& rule) {
  const auto number = take_number(key, rule, false, fmt::format("{}", value));
  if (number) value = *number;
  return number.has_value();
}

bool TableReader::number(std::string_view key, std::optional<double>& value, const Rule& rule) {
  const auto number = take_number(key, rule, false, number_text(value));
  if (number) value = number;
  return number.has_value();
}

bool TableReader::integer(std::string_view key, std::optional<int>& value, const Rule& rule) {
  const auto text = value ? std::to_string(*value) : std::string();
  const auto number = take_number(key, rule, true, text);
  if (!number) return false;
  if (std::abs(*number) > std::numeric_limits<int>::max()) {
    fail(key, describe(*find(key)), fmt::format("an integer of at most {}", std::numeric_limits<int>::max()));
    return false;
  }
  value = static_cast<int>(*number);
  return true;
}

bool TableReader::integer(std::string_view key, int& value, const Rule& rule) {
  std::optional<int> read = value;
  const bool valid = integer(key, read, rule);
  value = *read;
  return valid;
}

bool TableReader::integer(std::string_view key, std::uint64_t& value, const Rule& rule) {
  Rule natural = rule;
  natural.at_least = 0.0;
  if (!take_number(key, natural, true, std::to_string(value))) return false;
  value = static_cast<std::uint64_t>(find(key)->integer);
  return true;
}

bool TableReader::boolean(std::string_view key, bool& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::boolean}, "boolean", value ? "true" : "false");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::boolean)) {
    fail(key, describe(*found), "true or false");
    return false;
  }
  value = found->boolean;
  return true;
}

bool TableReader::string(std::string_view key, std::string& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::string}, "string", value.empty() ? "empty" : value);
  if (found == nullptr) return false;
  if (!found->is(Value::Type::string)) {
    fail(key, describe(*found), "a string", "strings stand in double quotes");
    return false;
  }
  value = found->text;
  return true;
}

std::optional<std::size_t> TableReader::take_word(std::string_view key, const std::vector<std::string>& words,
                                                  std::optional<std::size_t> fallback, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::word, words}, list_words(words),
                            fallback ? '"' + words[*fallback] + '"' : std::string());
  if (found == nullptr) return std::nullopt;
  if (found->is(Value::Type::string)) {
    const auto word = std::find(words.begin(), words.end(), found->text);
    if (word != words.end()) return static_cast<std::size_t>(word - words.begin());
  }
  fail(key, describe(*found), list_words(words),
       found->is(Value::Type::string) ? value_hint(found->text, words) : "");
  return std::nullopt;
}

bool TableReader::file(std::string_view key, std::filesystem::path& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::string}, "string, a path", "");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::string) || found->text.empty()) {
    fail(key, describe(*found), "the path of a file");
    return false;
  }
  value = context_.directory / found->text;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(value, ignored)) return true;
  fail(key, describe(*found), "a file that exists",
       std::filesystem::path(found->text).is_absolute() ? "" : "paths are relative to the scenario file");
  return false;
}

}  // namespace keyblock::scenario
