#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace keyblock {

/// Damages bytes in ways that are the same at every run of a test: what a bad disk does, and what somebody would write on purpose.
class Mutations {
 public:
  explicit Mutations(std::uint64_t seed) : state_(seed) {}

  /// One of a few changes, at a random place.
  std::string operator()(std::string bytes) {
    if (bytes.empty()) return bytes;
    constexpr std::size_t kinds = 8;
    switch (below(kinds)) {
      case 0:
        bytes[below(bytes.size())] = static_cast<char>(next());
        break;
      case 1:
        bytes[below(bytes.size())] ^= static_cast<char>(1U << below(8));
        break;
      case 2:
        bytes.resize(below(bytes.size()));
        break;
      case 3:
        bytes.insert(below(bytes.size()), bytes.substr(below(bytes.size()), 1 + below(64)));
        break;
      case 4:
        bytes.erase(below(bytes.size()), 1 + below(64));
        break;
      case 5:
        swap_words(bytes);
        break;
      default:
        put_number(bytes);
        break;
    }
    return bytes;
  }

  /// Of JSON: numbers become odd ones, or any change of bytes.
  std::string text(std::string json) {
    const std::size_t digit = json.find_first_of("0123456789", below(json.size()));
    if (digit == std::string::npos || below(4) == 0) return (*this)(std::move(json));
    const std::size_t end = std::min(json.find_first_not_of("0123456789", digit), json.size());
    constexpr std::array<const char*, 10> odd{
        "-1",         "99999999999999999999", "1e300", "null", "\"a\"", "[[]]", "{}", "0.5",
        "2147483648", "18446744073709551615"};
    return json.replace(digit, end - digit, odd[below(odd.size())]);
  }

  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(next() % std::max<std::uint64_t>(count, 1));
  }

  /// A number that programs stumble over.
  double odd_number() {
    constexpr std::array numbers{0.0,
                                 -1.0,
                                 1e300,
                                 -1e300,
                                 1e12,
                                 1e-300,
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
    return numbers[below(numbers.size())];
  }
  std::int64_t odd_count() {
    constexpr std::array<std::int64_t, 9> numbers{0,
                                                  -1,
                                                  1,
                                                  255,
                                                  65536,
                                                  2147483647,
                                                  -2147483648LL,
                                                  std::int64_t{1} << 40,
                                                  std::numeric_limits<std::int64_t>::max()};
    return numbers[below(numbers.size())];
  }

 private:
  // SplitMix64.
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }

  void swap_words(std::string& bytes) {
    constexpr std::size_t word = 8;
    if (bytes.size() < 2 * word) return;
    char* one = &bytes[below(bytes.size() - word)];
    char* other = &bytes[below(bytes.size() - word)];
    std::array<char, word> kept{};
    std::memcpy(kept.data(), one, word);
    std::memmove(one, other, word);
    std::memcpy(other, kept.data(), word);
  }

  void put_number(std::string& bytes) {
    const double number = odd_number();
    const std::int64_t count = odd_count();
    const bool is_count = below(2) == 0;
    const std::size_t size = below(2) == 0 ? sizeof(count) : sizeof(std::int32_t);
    if (bytes.size() < size) return;
    char* place = &bytes[below(bytes.size() - size + 1)];
    if (is_count) {
      std::memcpy(place, &count, size);
    } else if (bytes.size() >= sizeof(number)) {
      std::memcpy(&bytes[below(bytes.size() - sizeof(number) + 1)], &number, sizeof(number));
    }
  }

  std::uint64_t state_;
};

}  // namespace keyblock
