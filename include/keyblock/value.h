#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace keyblock {

/// A value of a scenario, as TOML knows them; a date is its text. Arrays go into a scenario this way without being written as text:
///
///     scenario.set("rock.young", 4e9);
///     scenario.set("motion.pulse.x", keyblock::Value::rows(samples, 2));  // time, acceleration, time, acceleration …
struct Value {
  using List = std::vector<Value>;
  using Table = std::vector<std::pair<std::string, Value>>;

  Value() : is(Table()) {}
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  // NOLINTNEXTLINE(google-explicit-constructor): a number is a value
  Value(Number number) {
    if constexpr (std::is_same_v<Number, bool>) {
      is = number;
    } else if constexpr (std::is_integral_v<Number>) {
      is = static_cast<std::int64_t>(number);
    } else {
      is = static_cast<double>(number);
    }
  }
  // NOLINTNEXTLINE(google-explicit-constructor): likewise
  Value(List list) : is(std::move(list)) {}
  // NOLINTNEXTLINE(google-explicit-constructor): likewise
  Value(Table table) : is(std::move(table)) {}
  /// A string. There is no constructor of it, as `set(key, "4e9")` reads TOML.
  static Value text(std::string text) {
    Value value;
    value.is = std::move(text);
    return value;
  }
  /// A list of numbers; of lists of `columns` numbers where there are several.
  static Value rows(std::span<const double> numbers, std::size_t columns = 1) {
    List list;
    list.reserve(numbers.size() / columns);
    for (std::size_t k = 0; k + columns <= numbers.size(); k += columns) {
      if (columns == 1)
        list.emplace_back(numbers[k]);
      else
        list.emplace_back(rows(numbers.subspan(k, columns)));
    }
    return list;
  }

  std::variant<bool, std::int64_t, double, std::string, List, Table> is;
};

}  // namespace keyblock
