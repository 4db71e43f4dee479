#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scenario/key_path.h"
#include "scenario/table_reader.h"

namespace keyblock::scenario {
namespace {

/// What a name of a list is the name of.
std::string element_of(std::string_view list) {
  if (list == names_of_supports) return "a [[spring]], [[bolt]] or [[liner]]";
  return list == names_of_joints ? "a joint set, trace map or interface, or \"joints\""
                                 : fmt::format("a [[{}]]", list);
}

std::string elements_of(std::string_view list) {
  if (list == names_of_supports) return "[[spring]], [[bolt]] and [[liner]]";
  return list == names_of_joints ? "joint sets, trace maps and interfaces, or \"joints\""
                                 : fmt::format("[[{}]]", list);
}

constexpr std::string_view point_text = "two numbers [x, y]";

std::string point_default(Vec2 p) {
  return fmt::format("[{}, {}]", p.x, p.y);
}

// Two finite numbers, or nothing.
std::optional<std::pair<double, double>> to_pair(const Value& value) {
  if (!value.is(Value::Type::array) || value.items.size() != 2) return std::nullopt;
  const Value &a = value.items[0], &b = value.items[1];
  if (!a.is_number() || !b.is_number() || !std::isfinite(a.number) || !std::isfinite(b.number))
    return std::nullopt;
  return std::pair(a.number, b.number);
}

/// Numbers that `--set gravity[1]=…` has put in the place of those of a default.
bool replace_components(const Value& value, Vec2& point) {
  if (!value.is(Value::Type::table) || value.items.empty()) return false;
  Vec2 changed = point;
  for (const Value& item : value.items) {
    if (!item.is_number() || !std::isfinite(item.number) || (item.key != "0" && item.key != "1"))
      return false;
    (item.key == "0" ? changed.x : changed.y) = item.number;
  }
  point = changed;
  return true;
}

bool is_one_point(const std::vector<Vec2>& line) {
  return std::all_of(line.begin(), line.end(), [&](Vec2 p) { return p == line.front(); });
}

std::string range_of_rows(const std::pair<double, double>& from, const std::pair<double, double>& to) {
  return fmt::format("time {} after time {}", to.first, from.first);
}

// How elements of a list are called in key paths: by their name where only they have it.
class ElementPaths {
 public:
  ElementPaths(const Value& list, std::string path) : list_(list), path_(std::move(path)) {
    for (const Value& item : list.items) {
      if (item.name() != nullptr) ++count_[*item.name()];
    }
  }

  [[nodiscard]] std::string of(std::size_t index) const {
    const std::string* name = list_.items[index].name();
    const bool named = name != nullptr && !name->empty() && count_.at(*name) == 1;
    return named ? join_path(path_, *name) : join_index(path_, index);
  }

 private:
  const Value& list_;
  std::string path_;
  std::map<std::string_view, int> count_;
};

}  // namespace

std::optional<Vec2> TableReader::to_point(const Value& value, const std::string& path) {
  const auto pair = to_pair(value);
  if (pair) return Vec2{pair->first, pair->second};
  fail_at(value, path, describe(value), std::string(point_text));
  return std::nullopt;
}

bool TableReader::point(std::string_view key, Vec2& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::point}, "point [x, y]", point_default(value));
  const bool replaced = found != nullptr && replace_components(*found, value);
  const auto point = found == nullptr || replaced ? std::nullopt : to_point(*found, path_of(key));
  if (point) value = *point;
  if (point || replaced) judge(*found, path_of(key), norm(value), rule.usual);
  return point.has_value() || replaced;
}

bool TableReader::point(std::string_view key, std::optional<Vec2>& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::point}, "point [x, y]", value ? point_default(*value) : "");
  const auto point = found == nullptr ? std::nullopt : to_point(*found, path_of(key));
  if (point) value = point;
  if (point) judge(*found, path_of(key), norm(*point), rule.usual);
  return point.has_value();
}

bool TableReader::interval(std::string_view key, std::optional<std::pair<double, double>>& value,
                           const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::interval}, "interval [from, to]", "");
  if (found == nullptr) return false;
  const auto pair = to_pair(*found);
  if (!pair) {
    fail(key, describe(*found), "two numbers [from, to]");
    return false;
  }
  if (pair->first >= pair->second) {
    fail(key, fmt::format("[{}, {}]", pair->first, pair->second),
         "two numbers [from, to] with from below to");
    return false;
  }
  value = pair;
  judge(*found, path_of(key), pair->second - pair->first, rule.usual);
  return true;
}

bool TableReader::interval(std::string_view key, std::pair<double, double>& value, const Rule& rule) {
  std::optional<std::pair<double, double>> read;
  const bool valid = interval(key, read, rule);
  if (valid) value = *read;
  return valid;
}

std::optional<std::vector<Vec2>> TableReader::to_points(const Value& value, const std::string& path,
                                                        std::size_t at_least) {
  const std::string expected =
      at_least == 1 ? "points [[x, y], …]" : fmt::format("at least {} points [[x, y], …]", at_least);
  if (!value.is(Value::Type::array) || value.items.size() < at_least) {
    fail_at(value, path, describe(value), expected);
    return std::nullopt;
  }
  std::vector<Vec2> points;
  bool valid = true;
  for (std::size_t k = 0; k < value.items.size(); ++k) {
    const auto point = to_point(value.items[k], join_index(path, k));
    valid = valid && point;
    if (point) points.push_back(*point);
  }
  return valid ? std::optional(std::move(points)) : std::nullopt;
}

bool TableReader::points(std::string_view key, std::vector<Vec2>& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::points}, "array of points [[x, y], …]", "");
  auto points = found == nullptr ? std::nullopt : to_points(*found, path_of(key), 1);
  if (points) value = std::move(*points);
  return points.has_value();
}

std::optional<Ring> TableReader::to_ring(const Value& value, const std::string& path) {
  auto ring = to_points(value, path, 3);
  if (!ring) return std::nullopt;
  if (ring->size() > 3 && ring->front() == ring->back()) ring->pop_back();
  for (std::size_t k = 1; k < ring->size(); ++k) {
    if ((*ring)[k] != (*ring)[k - 1]) continue;
    fail_at(value.items[k], join_index(path, k),
            fmt::format("the same point twice, {}", point_default((*ring)[k])),
            "vertices that differ from their neighbours");
    return std::nullopt;
  }
  return ring;
}

bool TableReader::ring(std::string_view key, Ring& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::points}, "ring of points [[x, y], …]", "");
  auto ring = found == nullptr ? std::nullopt : to_ring(*found, path_of(key));
  if (ring) value = std::move(*ring);
  return ring.has_value();
}

bool TableReader::rings(std::string_view key, std::vector<Ring>& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::rings}, "array of rings [[[x, y], …], …]", "");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::array)) {
    fail(key, describe(*found), "rings [[[x, y], …], …]");
    return false;
  }
  bool valid = true;
  std::vector<Ring> rings;
  for (std::size_t k = 0; k < found->items.size(); ++k) {
    auto ring = to_ring(found->items[k], join_index(path_of(key), k));
    valid = valid && ring;
    if (ring) rings.push_back(std::move(*ring));
  }
  if (valid) value = std::move(rings);
  return valid;
}

bool TableReader::lines(std::string_view key, std::vector<std::vector<Vec2>>& value, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::lines}, "array of lines [[[x, y], …], …]", "");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::array) || found->items.empty()) {
    fail(key, describe(*found), "lines [[[x, y], …], …]");
    return false;
  }
  bool valid = true;
  std::vector<std::vector<Vec2>> lines;
  for (std::size_t k = 0; k < found->items.size(); ++k) {
    const std::string path = join_index(path_of(key), k);
    auto line = to_points(found->items[k], path, 2);
    if (line && is_one_point(*line)) {
      fail_at(found->items[k], path, fmt::format("{} points, all the same", line->size()),
              "two or more different points");
      line.reset();
    }
    valid = valid && line;
    if (line) lines.push_back(std::move(*line));
  }
  if (valid) value = std::move(lines);
  return valid;
}

bool TableReader::time_rows(std::string_view key, TimeRows& rows, bool jumps, const Rule& rule) {
  const Value* found = take(key, rule, {KeyKind::rows}, "rows [[time, value], …]", "");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::array) || found->items.empty()) {
    fail(key, describe(*found), "rows [[time, value], …]");
    return false;
  }
  TimeRows read;
  for (std::size_t k = 0; k < found->items.size(); ++k) {
    const Value& item = found->items[k];
    const auto row = to_pair(item);
    const std::string path = join_index(path_of(key), k);
    if (!row) {
      fail_at(item, path, describe(item), "two numbers [time, value]");
      return false;
    }
    if (!read.empty() && (row->first < read.back().first || (!jumps && row->first == read.back().first))) {
      fail_at(item, path, range_of_rows(read.back(), *row),
              jumps ? "times that do not descend" : "times that ascend");
      return false;
    }
    read.push_back(*row);
  }
  rows = std::move(read);
  const auto largest =
      std::ranges::max_element(rows, {}, [](const auto& row) { return std::abs(row.second); });
  judge(*found, path_of(key), largest->second, rule.usual);
  return true;
}

bool TableReader::name(std::string_view key, std::string& value, std::string_view list, const Rule& rule) {
  if (!string(key, value, rule)) return false;
  if (value.empty()) {
    fail(key, "an empty string", "a name");
    return false;
  }
  std::vector<std::string>& names = context_.list_names[std::string(list)];
  if (std::find(names.begin(), names.end(), value) != names.end()) {
    fail(key, describe(*find(key)) + " again", fmt::format("a name that no other [[{}]] has", list));
    return false;
  }
  return true;
}

bool TableReader::find_name(const Value& value, const std::string& path, std::string_view list,
                            std::string_view word, std::string& name) {
  const auto entry = context_.list_names.find(list);
  static const std::vector<std::string> nobody;
  const std::vector<std::string>& names = entry == context_.list_names.end() ? nobody : entry->second;
  const std::string or_word = word.empty() ? "" : fmt::format("\"{}\" or ", word);
  if (!value.is(Value::Type::string)) {
    fail_at(value, path, describe(value), fmt::format("{}the name of {}", or_word, element_of(list)));
    return false;
  }
  const bool named = std::find(names.begin(), names.end(), value.text) != names.end();
  if (!word.empty() && value.text == word) {
    if (named)
      fail_at(
          value, path, describe(value) + fmt::format(", which is the name of a [[{}]] as well", list),
          fmt::format("another name for that [[{}]], as \"{}\" has a meaning of its own here", list, word));
    name = word;
    return !named;
  }
  if (value.text.empty() || !named) {
    std::vector<std::string> known;
    std::copy_if(names.begin(), names.end(), std::back_inserter(known),
                 [](const auto& n) { return !n.empty(); });
    fail_at(value, path, describe(value),
            known.empty() ? fmt::format("{}the name of {} (there is none)", or_word, element_of(list))
                          : fmt::format("{}the name of {}: {}", or_word, element_of(list), list_words(known)),
            context_.mistakes.full() ? "" : suggestion(value.text, known));
    return false;
  }
  name = value.text;
  return true;
}

bool TableReader::reference(std::string_view key, std::string& value, std::string_view list, const Rule& rule,
                            std::string_view word) {
  const std::string or_word = word.empty() ? "" : fmt::format(" or \"{}\"", word);
  const Value* found =
      take(key, rule, {KeyKind::string}, fmt::format("name of a [[{}]]{}", list, or_word), "");
  return found != nullptr && find_name(*found, path_of(key), list, word, value);
}

bool TableReader::references(std::string_view key, std::vector<int>& value, std::string_view list,
                             const Rule& rule) {
  const Value* found =
      take(key, rule, {KeyKind::references}, fmt::format("array of names of {}", elements_of(list)), "[]");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::array)) {
    fail(key, describe(*found), fmt::format("an array of names of {}", elements_of(list)),
         found->is(Value::Type::string) ? "write [" + to_toml(*found) + "]" : "");
    return false;
  }
  bool valid = true;
  std::vector<int> indices;
  for (std::size_t k = 0; k < found->items.size(); ++k) {
    const std::string path = join_index(path_of(key), k);
    std::string name;
    if (!find_name(found->items[k], path, list, "", name)) {
      valid = false;
      continue;
    }
    const auto& names = context_.list_names.find(list)->second;
    const int index = static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      fail_at(found->items[k], path, describe(found->items[k]) + " again", "every name once");
      valid = false;
    }
    indices.push_back(index);
  }
  if (valid) value = std::move(indices);
  return valid;
}

void TableReader::describe_table(std::string_view key, const Rule& rule, bool list,
                                 const std::function<void(TableReader&)>& read) {
  auto& sections = *context_.reference;
  const std::string name(key);
  const auto describe = [&](std::size_t section, const std::string& prefix) {
    TableReader reader(context_, nullptr, path_of(key), section, prefix);
    read(reader);
  };
  if (path_.empty()) {
    sections.push_back(
        {list ? "[[" + name + "]]" : "[" + name + "]", std::string(rule.meaning), {}, rule.may_be_alone});
    return describe(sections.size() - 1, "");
  }
  if (rule.group.empty()) {
    describe_key(key, rule, {list ? KeyKind::tables : KeyKind::table}, list ? "list of tables" : "table", "");
    return describe(section_, prefix_ + name + ".");
  }
  KeyType group{KeyKind::group};
  group.group = rule.group;
  group.kinds.assign(rule.kinds.begin(), rule.kinds.end());
  describe_key(key, rule, std::move(group), "see " + std::string(rule.group), "");
  const bool known = std::any_of(sections.begin(), sections.end(),
                                 [&](const SectionReference& s) { return s.title == rule.group; });
  if (known) return;
  sections.push_back({std::string(rule.group), std::string(rule.group_meaning), {}});
  describe(sections.size() - 1, "");
}

bool TableReader::table(std::string_view key, const Rule& rule,
                        const std::function<void(TableReader&)>& read) {
  if (documenting()) {
    describe_table(key, rule, false, read);
    return false;
  }
  const Value* found =
      take(key, rule, {KeyKind::table}, path_.empty() ? "[" + std::string(key) + "]" : "table", "");
  if (found == nullptr) return false;
  if (!found->is(Value::Type::table)) {
    const bool list =
        found->is(Value::Type::array) && !found->items.empty() && found->items.front().is(Value::Type::table);
    fail(key, describe(*found), "a table",
         list && path_.empty() ? fmt::format("write [{}] with single brackets, once", key) : "");
    return false;
  }
  TableReader reader(context_, found, path_of(key), 0, "");
  read(reader);
  reader.finish();
  return true;
}

bool TableReader::each_table(std::string_view key, const Rule& rule,
                             const std::function<void(TableReader&)>& read) {
  if (documenting()) {
    describe_table(key, rule, true, read);
    return false;
  }
  const Value* found = take(key, rule, {KeyKind::tables}, "list of tables", "");
  if (found == nullptr) return false;
  const auto read_one = [&](const Value& item, const std::string& item_path) {
    TableReader reader(context_, &item, item_path, 0, "");
    read(reader);
    reader.finish();
    // Places in the list of names are those of what was read: one for each table, whatever its name is worth, and none for other elements.
    const bool named = path_.empty();
    if (named) context_.list_names[std::string(key)].push_back(item.name() == nullptr ? "" : *item.name());
  };
  if (rule.may_be_alone && found->is(Value::Type::table)) {
    read_one(*found, path_of(key));
    return true;
  }
  if (!found->is(Value::Type::array)) {
    fail(key, describe(*found), "a list of tables",
         found->is(Value::Type::table) ? fmt::format("write [[{}]] with double brackets", path_of(key)) : "");
    return false;
  }
  const ElementPaths paths(*found, path_of(key));
  for (std::size_t k = 0; k < found->items.size(); ++k) {
    const Value& item = found->items[k];
    const std::string item_path = paths.of(k);
    if (!item.is(Value::Type::table)) {
      fail_at(item, item_path, describe(item), "a table");
      continue;
    }
    context_.positions[item_path] = item.where;
    read_one(item, item_path);
  }
  return true;
}

}  // namespace keyblock::scenario
