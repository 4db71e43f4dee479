#pragma once
#include <filesystem>
#include <string>

#include "core/read_file.h"

namespace keyblock::scenario {

/// The block of TOML in docs/guide/joints.md that has these words.
inline std::string snippet(const std::string& words) {
  const std::string page = read_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs/guide/joints.md"),
                    fence = "```";
  const std::size_t at = page.find("\n" + words), begin = page.rfind(fence + "toml\n", at) + 8,
                    end = page.find(fence, at);
  return "\n" + page.substr(begin, end - begin);
}

}  // namespace keyblock::scenario
