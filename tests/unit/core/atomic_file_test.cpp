#include "core/atomic_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include "../fresh_folder.h"
#include "core/error.h"
#include "core/own_file.h"

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
  // A process that may write no byte, as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit none{0, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
  std::string reason;
  try {
    write_file_atomically(path, "new");
  } catch (const RunError& error) {
    reason = error.what();
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THAT(reason, HasSubstr("File too large"));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files(), 1) << "temporary files were left";
}

TEST_F(AtomicFileTest, WhatHasItsTemporaryNameStays) {
  const auto path = folder_ / "data";
  const std::string first = path.string() + fmt::format(".{}.tmp", ::getpid());
  const std::string second = path.string() + fmt::format(".{}.1.tmp", ::getpid());
  std::ofstream(folder_ / "precious") << "mine";
  std::filesystem::create_symlink("precious", first);
  std::ofstream(second) << "mine";
  write_file_atomically(path, "new");
  EXPECT_EQ(read_file(path), "new");
  for (const auto& name : {first, second}) EXPECT_EQ(read_file(name), "mine") << name;
}

TEST_F(AtomicFileTest, ALinkOfItsNameIsReplacedAndNotFollowed) {
  std::ofstream(folder_ / "precious") << "mine";
  std::filesystem::create_symlink("precious", folder_ / "data");
  write_file_atomically(folder_ / "data", "new");
  EXPECT_EQ(read_file(folder_ / "precious"), "mine");
  EXPECT_EQ(read_own_file(folder_ / "data"), "new");
}

TEST_F(AtomicFileTest, AFileMadeAnewTakesThePlaceOfALink) {
  std::ofstream(folder_ / "precious") << "mine";
  for (const char* name : {"link", "hard", "gone"}) {
    const auto path = folder_ / name;
    if (path.filename() == "link") std::filesystem::create_symlink("precious", path);
    if (path.filename() == "hard") std::filesystem::create_hard_link(folder_ / "precious", path);
    const int descriptor = create_anew(path);
    EXPECT_EQ(::write(descriptor, "log", 3), 3);
    ::close(descriptor);
    EXPECT_EQ(read_own_file(path), "log");
    EXPECT_EQ(read_file(folder_ / "precious"), "mine") << name;
  }
  std::filesystem::create_directory(folder_ / "folder");
  EXPECT_THROW(create_anew(folder_ / "folder"), RunError);
}

TEST_F(AtomicFileTest, TemporaryFilesOfProcessesThatAreGoneAreStale) {
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(gone, nullptr, 0), gone);
  const std::vector<std::string> stale{fmt::format("data.{}.tmp", gone), fmt::format("data.{}.12.tmp", gone)};
  const std::vector<std::string> others{fmt::format("data.{}.tmp", ::getppid()),
                                        "data",
                                        "data.tmp",
                                        "data.x.tmp",
                                        "data.0.tmp",
                                        fmt::format("other.{}.tmp", gone),
                                        fmt::format("data.0{}.tmp", gone),
                                        fmt::format("data.{}.01.tmp", gone),
                                        fmt::format("data.{}.1.2.tmp", gone)};
  for (const std::string& name : stale) std::ofstream(folder_ / name) << "half";
  for (const std::string& name : others) std::ofstream(folder_ / name) << "kept";
  remove_stale_temporaries(folder_ / "data");
  for (const std::string& name : stale) EXPECT_FALSE(std::filesystem::exists(folder_ / name)) << name;
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
  EXPECT_THAT(folder, Throws<InputError>(Property(&InputError::what, HasSubstr("a folder"))));
}

TEST_F(AtomicFileTest, ReadsNeitherDevicesNorPipesNorWhatIsTooLarge) {
  const auto refusal_of = [](const std::filesystem::path& path, bool own = false) {
    try {
      static_cast<void>(own ? read_own_file(path) : read_file(path));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const std::filesystem::path& path : {folder_ / "pipe", std::filesystem::path("/dev/zero")})
    EXPECT_THAT(refusal_of(path), HasSubstr("a device or pipe"));
  write_file_atomically(folder_ / "file", "text");
  std::filesystem::create_symlink("file", folder_ / "link");
  EXPECT_EQ(refusal_of(folder_ / "link"), "none");
  EXPECT_THAT(refusal_of(folder_ / "link", true), HasSubstr("a link"));
  std::filesystem::resize_file(folder_ / "file", std::uintmax_t{1} << 40U);
  EXPECT_THAT(refusal_of(folder_ / "file"), HasSubstr("found a file of 1099512 MB; expected at most 200 MB"));
}

}  // namespace
}  // namespace keyblock
