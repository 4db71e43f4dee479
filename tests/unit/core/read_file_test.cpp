#include "core/read_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace keyblock {
namespace {

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

class ReadFileTest : public testing::Test {
 protected:
  const FreshFolder folder_;
};

TEST_F(ReadFileTest, NeitherWaitsForPipesNorReadsDevices) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero");
  for (const char* name : {"pipe", "zero"}) {
    const auto read = [&] { static_cast<void>(read_file(folder_ / name)); };
    EXPECT_THAT(read, Throws<InputError>(Property(&InputError::what, HasSubstr("a device or pipe")))) << name;
  }
}

TEST_F(ReadFileTest, RefusesWhatIsTooLarge) {
  const auto path = folder_ / "data";
  write_file_atomically(path, std::string(2'000'000, 'x'));
  EXPECT_EQ(read_file(path, 2'000'000).size(), 2'000'000U);
  const auto read = [&] { static_cast<void>(read_file(path, 1'000'000)); };
  EXPECT_THAT(read, Throws<InputError>(Property(&InputError::what, HasSubstr("at most 1 MB"))));
  // Of no size that the system tells.
  EXPECT_FALSE(read_file("/proc/self/status").empty());
  const auto grows = [&] { static_cast<void>(read_file("/proc/self/status", 10)); };
  EXPECT_THAT(grows, Throws<InputError>(Property(&InputError::what, HasSubstr("a file of"))));
  // A terabyte that takes no room on the disk: it is refused before it is read.
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40U);
  const auto huge = [&] { static_cast<void>(read_file(path)); };
  EXPECT_THAT(huge, Throws<InputError>(Property(&InputError::what, HasSubstr("at most 200 MB"))));
}

}  // namespace
}  // namespace keyblock
