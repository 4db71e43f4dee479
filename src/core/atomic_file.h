#pragma once
#include <filesystem>
#include <string_view>

namespace keyblock {

/// Writes `content` to a temporary file beside `path` and renames it, so that no reader ever sees half a
/// file. Throws RunError when the disk is full or the folder cannot be written; `path` is then as it was
/// before.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// The whole file as bytes. Throws InputError when it cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace keyblock
