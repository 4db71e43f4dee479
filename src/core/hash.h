#pragma once
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace keyblock {

/// FNV-1a over bytes, 64 bit.
class Hash {
 public:
  void add(const void* bytes, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k) {
      value_ ^= static_cast<const unsigned char*>(bytes)[k];
      value_ *= 1099511628211ULL;
    }
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void add(const std::vector<T>& values) { add(values.data(), values.size() * sizeof(T)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

}  // namespace keyblock
