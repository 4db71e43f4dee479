#pragma once
#include <filesystem>
#include <string>

#include "core/read_file.h"

namespace keyblock::scenario {

/// The block of TOML in a page of docs/guide that has these words at the beginning of a line.
inline std::string snippet(const std::string& words, const char* of_guide = "joints.md") {
  const std::string text = read_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs/guide" / of_guide),
                    mark = "```";
  const std::size_t at = text.find("\n" + words), begin = text.rfind(mark + "toml\n", at) + 8,
                    end = text.find(mark, at);
  return "\n" + text.substr(begin, end - begin);
}

}  // namespace keyblock::scenario
