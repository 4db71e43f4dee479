#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace keyblock::scenario {

/// A value of a TOML document, with the place where it stands. A tree of plain data, so that overrides can be
/// put into it and the rest of the module need not know the TOML library.
struct Value {
  enum class Type { string, integer, number, boolean, date, array, table };

  Type type = Type::table;
  std::string text;  ///< of a string; a date as written
  std::int64_t integer = 0;
  double number = 0.0;  ///< of an integer, too
  bool boolean = false;
  std::vector<Value> items;  ///< elements of an array; members of a table in the order of the file
  SourcePosition where;      ///< of the value; of the header of a [table]

  std::string key;  ///< members of a table only
  SourcePosition key_where;

  [[nodiscard]] bool is(Type t) const { return type == t; }
  /// Type::number or Type::integer.
  [[nodiscard]] bool is_number() const { return type == Type::number || type == Type::integer; }
  /// Member of a table, or null.
  [[nodiscard]] const Value* find(std::string_view member) const;
  [[nodiscard]] Value* find(std::string_view member);
  /// The string member `name` of a table, or null: the name of an element of a list.
  [[nodiscard]] const std::string* name() const;
};

/// What stands there, for a message: `the number -1`, `the string "stiff"`, `an array of 3`.
std::string describe(const Value& value);

/// The value as TOML, on one line.
std::string to_toml(const Value& value);

/// Whether they mean the same: 1 and 1.0 do, and tables with their keys in another order.
bool same_value(const Value& a, const Value& b);

/// The value as TOML in one way of writing, the same text for what same_value calls the same.
std::string canonical_toml(Value value);

/// Where two documents differ, by key path: `rock.young: 3.0e9 there, 5.0e9 here`. Elements of lists are compared by place.
std::vector<std::string> differences(const Value& there, const Value& here);

/// bytes. What is larger are lists of points, which files of their own hold in a fraction of the memory.
inline constexpr std::size_t largest_scenario = 20'000'000;

/// Reads TOML. Positions name `file`. Throws InputError for a syntax error.
Value parse_toml(std::string_view text, const std::string& file);

}  // namespace keyblock::scenario
