#pragma once
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace keyblock {

/// Bytes of a file that somebody gives the program to read; records, lines and scenarios are far smaller.
inline constexpr std::size_t largest_input_file = 200'000'000;
inline constexpr std::size_t any_size = std::numeric_limits<std::size_t>::max();

/// The whole file as bytes. Throws InputError, with the reason of the system, when it cannot be read, and when it is a folder, a device
/// or a pipe, or larger than `largest`.
std::string read_file(const std::filesystem::path& path, std::size_t largest = largest_input_file);

/// The same for a file that the program has written for itself: a link of that name is refused.
std::string read_own_file(const std::filesystem::path& path, std::size_t largest = any_size);

}  // namespace keyblock
