#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "core/error.h"
#include "results/hdf5_file.h"

/// What the tables of a result file share: rows that are complete, and what fits.
namespace keyblock::results {

template <class T>
std::span<const T> flat(const T* values, std::size_t count) {
  return {values, count};
}

// Rows whose time is written.
inline std::size_t complete_rows(const hdf5::Array<double>& time) {
  const auto unwritten =
      std::find_if(time.values.begin(), time.values.end(), [](double t) { return std::isnan(t); });
  return static_cast<std::size_t>(unwritten - time.values.begin());
}

inline std::size_t common_rows(const hdf5::Array<double>& time, std::initializer_list<std::size_t> others) {
  return std::min(complete_rows(time), std::min(others));
}

inline void require(bool holds, const char* what) {
  if (!holds) throw RunError(fmt::format("{} does not fit the rest of the file", what));
}

// The value as one of an enumeration that ends with `last`.
template <class Enum>
Enum enumerator(std::uint8_t value, Enum last, const char* what) {
  if (value > static_cast<std::uint8_t>(last))
    throw RunError(fmt::format("{} holds the unknown value {}", what, value));
  return static_cast<Enum>(value);
}

}  // namespace keyblock::results
