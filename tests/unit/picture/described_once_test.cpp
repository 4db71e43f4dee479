#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/read_file.h"
#include "picture/colors.h"
#include "picture/marks.h"
#include "picture/quantities.h"

namespace keyblock::picture {
namespace {

std::string python(const char* file) {
  return read_file(std::string(KEYBLOCK_SOURCE_DIR) + "/python/keyblock/" + file);
}

// Python draws without the program, so it has these numbers and names again.
TEST(DescribedOnce, PythonHasTheSizesOfMarks) {
  const std::string section = python("section.py");
  EXPECT_THAT(section,
              testing::HasSubstr(fmt::format("CROSS_LENGTH, ARROW_LENGTH = {:.1f}, {:.1f}",
                                             mark_of("stress").drawn, mark_of("displacement").drawn)));
  EXPECT_THAT(section, testing::HasSubstr(fmt::format("LONGEST_ARROW = {:.1f}", longest_arrow)));
}

TEST(DescribedOnce, PythonHasTheColorsOfMarks) {
  const std::string colors = python("colors.py");
  EXPECT_THAT(colors, testing::HasSubstr(fmt::format("ARROW = \"{}\"", mark_of("velocity").color)));
  EXPECT_THAT(colors, testing::HasSubstr(fmt::format("FORCE = \"{}\"", mark_of("forces").color)));
  EXPECT_THAT(colors, testing::HasSubstr(fmt::format("COMPRESSION = \"{}\"", mark_of("stress").color)));
  EXPECT_THAT(colors, testing::HasSubstr(fmt::format("THRUST = \"{}\"", mark_of("thrust").color)));
  EXPECT_THAT(colors, testing::HasSubstr(fmt::format("BEFORE = \"{}\"", mark_of("outline").color)));
}

TEST(DescribedOnce, PythonColoursBlocksByTheSameNames) {
  const std::string fields = python("fields.py");
  for (const BlockQuantity& quantity : block_quantities())
    EXPECT_THAT(fields, testing::HasSubstr(fmt::format("\"{}\"", quantity.name)));
}

}  // namespace
}  // namespace keyblock::picture
