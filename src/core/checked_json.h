#pragma once
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

/// nlohmann/json, with whole numbers that are checked: files that others wrote may hold 1e20 where a count is asked for, and the library's
/// own conversion is undefined behaviour then. Included in place of <nlohmann/json.hpp> everywhere, as a program has one conversion.
namespace nlohmann {

template <typename Whole>
struct adl_serializer<Whole, std::enable_if_t<std::is_integral_v<Whole> && !std::is_same_v<Whole, bool>>> {
  template <typename Json>
  static void to_json(Json& json, Whole value) {
    ::nlohmann::to_json(json, value);
  }
  /// Throws json::type_error where the number is not one of the type.
  template <typename Json>
  static void from_json(const Json& json, Whole& value) {
    if (!fits(json)) static_cast<void>(json.template get_ref<const std::string&>());
    ::nlohmann::from_json(json, value);
  }

 private:
  template <typename Json>
  static bool fits(const Json& json) {
    if (json.is_number_float()) {
      const auto number = json.template get_ref<const double&>();
      // One beyond the largest is a power of two, which a double has exactly.
      const double beyond = std::ldexp(1.0, std::numeric_limits<Whole>::digits);
      return number >= static_cast<double>(std::numeric_limits<Whole>::min()) && number < beyond;
    }
    if (json.is_number_unsigned()) return std::in_range<Whole>(json.template get_ref<const std::uint64_t&>());
    if (json.is_number_integer()) return std::in_range<Whole>(json.template get_ref<const std::int64_t&>());
    return true;
  }
};

}  // namespace nlohmann
