#pragma once
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/polygon.h"
#include "scenario/key_reference.h"
#include "scenario/mistakes.h"
#include "scenario/usual.h"
#include "scenario/value.h"

namespace keyblock::scenario {

/// What a key may hold and what it means. Ranges are for numbers; `above` and `below` exclude their ends.
struct Rule {
  std::string_view meaning{};
  std::string_view unit{};
  bool required = false;
  double above = -HUGE_VAL, at_least = -HUGE_VAL, at_most = HUGE_VAL, below = HUGE_VAL;
  std::string_view fallback{};   ///< the default in words, where it is none of the values a key may hold
  bool applies = true;           ///< false: the key may not be given, as the condition does not hold
  std::string_view condition{};  ///< when the key is used: `shape = "circle"`
  std::string_view group{};      ///< title of a section of its own for the keys of a table that occurs often
  std::string_view group_meaning{};
  std::span<const KeyKind>
      kinds{};                   ///< of a key that may hold several, or of what may stand in place of a group
  bool may_be_alone = false;     ///< of a list of tables: one table may stand in its place
  const Usual* usual = nullptr;  ///< what its numbers usually are; of a point and of rows their size
};

/// Rows (time, value).
using TimeRows = std::vector<std::pair<double, double>>;

/// A word of the file and what it stands for.
template <class E>
struct Word {
  std::string_view word;
  E value;
};

/// Not the key of a list: names of joint sets, trace maps and interfaces, after `joints`, which stands for all joints that are of none.
inline constexpr std::string_view names_of_joints = "joints";
/// Likewise: names of all that a stage may install.
inline constexpr std::string_view names_of_supports = "supports";

/// What is gathered while a document is read.
struct ReadContext {
  Mistakes mistakes;
  std::map<std::string, SourcePosition> positions;                          ///< of every value, by key path
  std::map<std::string, std::vector<std::string>, std::less<>> list_names;  ///< names of elements, by list
  std::vector<UnusualValue> unusual;
  std::filesystem::path directory;  ///< to which paths are relative
  /// Not null: nothing is read; every key asked for is described here.
  std::vector<SectionReference>* reference = nullptr;

  [[nodiscard]] SourcePosition where(const std::string& key_path) const;
};

/// Position of a value, or of the nearest table around it; nowhere when there is none.
SourcePosition nearest_position(const std::map<std::string, SourcePosition>& positions, std::string key_path);

/// Reads the keys of one table. Each call names a key, the variable to fill, and a Rule; the variable keeps its
/// value, the default, when the key is not there or wrong. Whatever is wrong is added to the mistakes of the context and
/// reading goes on. Keys that nobody asked for are reported in the end.
///
/// The same calls describe the keys when the context has a reference: there is no document then, `read` functions
/// of tables are called once, and variables keep their values.
///
/// Functions return whether a valid value was read.
class TableReader {
 public:
  /// The document itself. `root` may be null when the context has a reference.
  TableReader(ReadContext& context, const Value* root);

  bool number(std::string_view key, double& value, const Rule& rule);
  bool number(std::string_view key, std::optional<double>& value, const Rule& rule);
  bool integer(std::string_view key, int& value, const Rule& rule);
  bool integer(std::string_view key, std::optional<int>& value, const Rule& rule);
  bool integer(std::string_view key, std::uint64_t& value, const Rule& rule);
  bool boolean(std::string_view key, bool& value, const Rule& rule);
  bool string(std::string_view key, std::string& value, const Rule& rule);
  template <class E, std::size_t n>
  bool word(std::string_view key, E& value, const Word<E> (&words)[n], const Rule& rule) {
    std::optional<E> read = value;
    const bool valid = word(key, read, words, rule);
    value = *read;
    return valid;
  }
  template <class E, std::size_t n>
  bool word(std::string_view key, std::optional<E>& value, const Word<E> (&words)[n], const Rule& rule);

  bool point(std::string_view key, Vec2& value, const Rule& rule);
  bool point(std::string_view key, std::optional<Vec2>& value, const Rule& rule);
  /// [from, to] with from < to.
  bool interval(std::string_view key, std::pair<double, double>& value, const Rule& rule);
  bool interval(std::string_view key, std::optional<std::pair<double, double>>& value, const Rule& rule);
  bool points(std::string_view key, std::vector<Vec2>& value, const Rule& rule);
  /// A ring of at least three vertices; a last vertex that repeats the first is dropped.
  bool ring(std::string_view key, Ring& value, const Rule& rule);
  bool rings(std::string_view key, std::vector<Ring>& value, const Rule& rule);
  /// Polylines, each of two different points or more.
  bool lines(std::string_view key, std::vector<std::vector<Vec2>>& value, const Rule& rule);
  /// [[t, value], …] with ascending times; equal times only when `jumps`.
  bool time_rows(std::string_view key, TimeRows& rows, bool jumps, const Rule& rule);

  /// An existing file, relative to the folder of the scenario.
  bool file(std::string_view key, std::filesystem::path& value, const Rule& rule);
  /// The name of this element of `list`: not empty and not used before. References to it can then be read.
  bool name(std::string_view key, std::string& value, std::string_view list, const Rule& rule);
  /// Name of an element of `list`, which must have been read before; or `word`, if one is given, where no element may have it
  /// as its name.
  bool reference(std::string_view key, std::string& value, std::string_view list, const Rule& rule,
                 std::string_view word = {});
  /// Names of elements of `list`, as indices.
  bool references(std::string_view key, std::vector<int>& value, std::string_view list, const Rule& rule);

  /// A table; `read` is called when it is there.
  bool table(std::string_view key, const Rule& rule, const std::function<void(TableReader&)>& read);
  /// A list of tables; one element of `list` is made and read for each.
  template <class T, class Read>
  bool tables(std::string_view key, std::vector<T>& list, const Rule& rule, Read read) {
    return each_table(key, rule, [&](TableReader& element) {
      T value;
      read(element, value);
      if (!documenting()) list.push_back(std::move(value));
    });
  }
  bool each_table(std::string_view key, const Rule& rule, const std::function<void(TableReader&)>& read);
  /// Any value; null when it is not there.
  const Value* any(std::string_view key, std::string_view type, const Rule& rule);

  /// Whether the key is there at all. Does not count as asking for it.
  [[nodiscard]] const Value* find(std::string_view key) const;
  [[nodiscard]] bool documenting() const { return context_.reference != nullptr; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] ReadContext& context() { return context_; }

  /// Something is wrong with the value of a key (at its position), or with its absence (at that of the table).
  void fail(std::string_view key, std::string found, std::string expected, std::string hint = {});
  /// Nothing is where `expected` should be.
  void missing(std::string_view key, std::string expected, std::string hint = {});
  void fail_at(const Value& value, const std::string& path, std::string found, std::string expected,
               std::string hint = {});
  /// Compares a number with what it usually is.
  void judge(const Value& value, const std::string& path, double number, const Usual* usual);
  /// Of what neither weighs nor deforms, values mean nothing.
  void judge_nothing() { judges_ = false; }
  /// Reports the keys that nobody asked for. Called for all tables but the document itself.
  void finish();

 private:
  TableReader(ReadContext& context, const Value* table, std::string path, std::size_t section,
              std::string prefix);

  const Value* take(std::string_view key, const Rule& rule, KeyType value_type, const std::string& type,
                    const std::string& fallback);
  void describe_key(std::string_view key, const Rule& rule, KeyType value_type, const std::string& type,
                    const std::string& fallback);
  void describe_table(std::string_view key, const Rule& rule, bool list,
                      const std::function<void(TableReader&)>& read);
  std::optional<double> take_number(std::string_view key, const Rule& rule, bool integer,
                                    const std::string& fallback);
  std::optional<std::size_t> take_word(std::string_view key, const std::vector<std::string>& words,
                                       std::optional<std::size_t> fallback, const Rule& rule);
  std::optional<Vec2> to_point(const Value& value, const std::string& path);
  std::optional<std::vector<Vec2>> to_points(const Value& value, const std::string& path,
                                             std::size_t at_least);
  std::optional<Ring> to_ring(const Value& value, const std::string& path);
  bool find_name(const Value& value, const std::string& path, std::string_view list, std::string_view word,
                 std::string& name);
  [[nodiscard]] std::string path_of(std::string_view key) const;

  ReadContext& context_;
  const Value* table_;
  std::string path_;
  std::vector<std::string> known_;
  std::size_t section_ = 0;  // of the reference
  std::string prefix_;       // of keys within it
  bool judges_ = true;
};

template <class E, std::size_t n>
bool TableReader::word(std::string_view key, std::optional<E>& value, const Word<E> (&words)[n],
                       const Rule& rule) {
  std::vector<std::string> names;
  std::optional<std::size_t> fallback;
  for (std::size_t k = 0; k < n; ++k) {
    names.emplace_back(words[k].word);
    if (value == words[k].value) fallback = k;
  }
  const auto chosen = take_word(key, names, fallback, rule);
  if (chosen) value = words[*chosen].value;
  return chosen.has_value();
}

}  // namespace keyblock::scenario
