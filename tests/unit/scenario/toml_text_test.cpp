#include "scenario/toml_text.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/read_file.h"

namespace keyblock::scenario {
namespace {

TEST(TomlText, IsWhatAPersonWouldWrite) {
  const Value document = parse_toml(
      "title = 'x'\nrock = { young = 3e9, 'odd key' = true }\nseed = 4\nlist = [1, 2.5]\n"
      "[[joint_set]]\nname = 'J\"1'\nspacing = { mean = 0.3 }\n[[joint_set]]\nname = 'J2'\n[empty]\n",
      "s.toml");
  EXPECT_EQ(toml_text(document),
            "title = \"x\"\nseed = 4\nlist = [1, 2.5]\n"
            "\n[rock]\nyoung = 3000000000.0\n'odd key' = true\n"
            "\n[[joint_set]]\nname = \"J\\\"1\"\nspacing = { mean = 0.3 }\n"
            "\n[[joint_set]]\nname = \"J2\"\n"
            "\n[empty]\n");
}

TEST(TomlText, GivesTheSameValues) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KEYBLOCK_SOURCE_DIR "/examples")) {
    if (entry.path().extension() != ".toml") continue;
    const Value document = parse_toml(read_file(entry.path()), entry.path().string());
    EXPECT_TRUE(same_value(parse_toml(toml_text(document), ""), document)) << entry.path();
    ++read;
  }
  EXPECT_GT(read, 5);
}

}  // namespace
}  // namespace keyblock::scenario
