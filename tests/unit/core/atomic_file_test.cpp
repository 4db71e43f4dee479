#include "core/atomic_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "../fresh_folder.h"
#include "core/error.h"

namespace keyblock {
namespace {

using ::testing::HasSubstr;
using ::testing::Property;
using ::testing::Throws;

class AtomicFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::ptrdiff_t files() const {
    using std::filesystem::directory_iterator;
    return std::distance(directory_iterator(folder_), directory_iterator());
  }

  const FreshFolder folder_;
};

TEST_F(AtomicFileTest, WritesAndReadsBackAllBytes) {
  std::string content(300000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * 7);
  write_file_atomically(folder_ / "data", content);
  EXPECT_EQ(read_file(folder_ / "data"), content);
  write_file_atomically(folder_ / "data", "");
  EXPECT_EQ(read_file(folder_ / "data"), "");
  EXPECT_EQ(files(), 1) << "temporary files were left";
}

TEST_F(AtomicFileTest, FullDiskLeavesTheOldFile) {
  const auto path = folder_ / "data";
  write_file_atomically(path, "old");
  // Every write to /dev/full fails as on a full disk; the temporary file is made to lead there.
  std::filesystem::create_symlink("/dev/full", path.string() + fmt::format(".{}.tmp", ::getpid()));
  const auto write = [&] { write_file_atomically(path, "new"); };
  EXPECT_THAT(write, Throws<RunError>(Property(&RunError::what, HasSubstr("No space left"))));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files(), 1) << "temporary files were left";
}

TEST_F(AtomicFileTest, TemporaryFilesOfProcessesThatAreGoneAreStale) {
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(gone, nullptr, 0), gone);
  const std::string stale = fmt::format("data.{}.tmp", gone);
  const std::vector<std::string> others{fmt::format("data.{}.tmp", ::getppid()),
                                        "data",
                                        "data.tmp",
                                        "data.x.tmp",
                                        "data.0.tmp",
                                        fmt::format("other.{}.tmp", gone),
                                        fmt::format("data.0{}.tmp", gone)};
  std::ofstream(folder_ / stale) << "half";
  for (const std::string& name : others) std::ofstream(folder_ / name) << "kept";
  remove_stale_temporaries(folder_ / "data");
  EXPECT_FALSE(std::filesystem::exists(folder_ / stale));
  for (const std::string& name : others) EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  remove_stale_temporaries(folder_ / "gone" / "data");
}

TEST_F(AtomicFileTest, FolderThatIsNotThere) {
  const auto path = folder_ / "gone" / "data";
  const auto write = [&] { write_file_atomically(path, "new"); };
  EXPECT_THAT(write,
              Throws<RunError>(Property(&RunError::what, HasSubstr(path.string() + ": cannot create"))));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "gone"));
}

TEST_F(AtomicFileTest, FolderThatCannotBeWritten) {
  const auto path = folder_ / "data";
  write_file_atomically(path, "old");
  std::filesystem::permissions(folder_,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const bool root_writes_anyway = ::access(folder_.string().c_str(), W_OK) == 0;
  const auto write = [&] { write_file_atomically(path, "new"); };
  if (root_writes_anyway) {
    EXPECT_NO_THROW(write());
  } else {
    EXPECT_THAT(write, Throws<RunError>(Property(&RunError::what, HasSubstr("Permission denied"))));
    EXPECT_EQ(read_file(path), "old");
  }
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
}

TEST_F(AtomicFileTest, TargetThatIsAFolder) {
  std::filesystem::create_directories(folder_ / "data" / "inside");
  const auto write = [&] { write_file_atomically(folder_ / "data", "new"); };
  EXPECT_THAT(write, Throws<RunError>(Property(&RunError::what, HasSubstr("cannot rename"))));
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "data" / "inside"));
  EXPECT_EQ(files(), 1) << "temporary files were left";
}

TEST_F(AtomicFileTest, ReadingWhatIsNoFileIsAnInputError) {
  const auto missing = [&] { static_cast<void>(read_file(folder_ / "gone")); };
  EXPECT_THAT(missing,
              Throws<InputError>(Property(&InputError::what, HasSubstr((folder_ / "gone").string()))));
  EXPECT_THAT(missing, Throws<InputError>(Property(&InputError::what, HasSubstr("No such file"))));
  const auto folder = [&] { static_cast<void>(read_file(folder_)); };
  EXPECT_THAT(folder, Throws<InputError>(Property(&InputError::what, HasSubstr("found a folder"))));
}

}  // namespace
}  // namespace keyblock
