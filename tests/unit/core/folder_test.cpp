#include "core/folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <string>

#include "../fresh_folder.h"
#include "core/error.h"

namespace keyblock {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Folder : public ::testing::Test {
 protected:
  Folder() {
    std::ofstream(path_ / "file") << "x";
    fs::create_symlink("loop", path_ / "loop");
  }

  const FreshFolder path_;
};

using FileExists = Folder;
using MakeFolder = Folder;
using CheckCanWrite = Folder;
using FileLockTest = Folder;

TEST_F(FileExists, IsAnErrorWhereItCannotBeTold) {
  EXPECT_TRUE(file_exists(path_ / "file"));
  EXPECT_FALSE(file_exists(path_ / "gone"));
  EXPECT_FALSE(file_exists(path_ / "gone" / "gone"));
  EXPECT_THROW(file_exists(path_ / "loop" / "file"), InputError);
}

TEST_F(MakeFolder, WhereOneCanBeMade) {
  make_folder(path_ / "a" / "b");
  EXPECT_TRUE(fs::is_directory(path_ / "a" / "b"));
  EXPECT_NO_THROW(make_folder(path_));
  for (const char* name : {"file", "file/a", "loop", "loop/a"})
    EXPECT_THROW(make_folder(path_ / name), InputError) << name;
}

TEST_F(CheckCanWrite, AsksForAFolderThatTakesFiles) {
  EXPECT_NO_THROW(check_can_write(path_ / "file"));
  EXPECT_NO_THROW(check_can_write(path_ / "new"));
  for (const char* name : {"", "gone/a", "file/a", "loop/a"})
    EXPECT_THROW(check_can_write(path_ / name), InputError) << name;
  if (::geteuid() == 0) return;  // who may write everywhere
  fs::permissions(path_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(check_can_write(path_ / "new"), InputError);
  EXPECT_THROW(make_folder(path_), InputError);
  fs::permissions(path_, fs::perms::owner_all);
}

TEST_F(FileLockTest, OneHoldsIt) {
  std::optional<FileLock> first(path_ / "lock");
  EXPECT_TRUE(first->held());
  {
    const FileLock second(path_ / "lock", FileLock::Afterwards::remove_file);
    EXPECT_FALSE(second.held());
    EXPECT_THAT(second.holder(), HasSubstr(fmt::format("process {} on ", ::getpid())));
  }
  EXPECT_TRUE(fs::exists(path_ / "lock")) << "removed by one who did not hold it";
  first.reset();
  EXPECT_TRUE(fs::exists(path_ / "lock"));
  EXPECT_TRUE(FileLock(path_ / "lock", FileLock::Afterwards::remove_file).held());
  EXPECT_FALSE(fs::exists(path_ / "lock"));
}

TEST_F(FileLockTest, WhoeverComesAfterTheFileIsGoneLocksItsSuccessor) {
  std::optional<FileLock> first(path_ / "lock");
  fs::remove(path_ / "lock");
  const FileLock second(path_ / "lock");
  EXPECT_TRUE(second.held());
  first.reset();
  EXPECT_FALSE(FileLock(path_ / "lock").held());
}

TEST_F(FileLockTest, WhatIsNoLockStays) {
  std::ofstream(path_ / "notes") << "my notes\n";
  std::ofstream(path_ / "lines") << "process 1 on a\nprocess 2 on b\n";
  std::ofstream(path_ / "long") << "process 1 on " << std::string(2000, 'x');
  fs::create_symlink("notes", path_ / "link");
  fs::create_symlink("gone", path_ / "hanging");
  fs::create_directory(path_ / "folder");
  ASSERT_EQ(::mkfifo((path_ / "pipe").c_str(), 0600), 0);
  for (const char* name : {"notes", "lines", "long", "link", "hanging", "folder", "pipe"}) {
    EXPECT_THROW(FileLock(path_ / name, FileLock::Afterwards::remove_file), InputError) << name;
    EXPECT_TRUE(fs::exists(fs::symlink_status(path_ / name))) << name;
  }
  EXPECT_FALSE(fs::exists(path_ / "gone"));
  EXPECT_EQ(fs::file_size(path_ / "notes"), 9U);
  EXPECT_EQ(fs::file_size(path_ / "long"), 2013U);
}

TEST_F(FileLockTest, LocksOfProcessesThatAreGoneAreTaken) {
  std::ofstream(path_ / "lock") << "process 1 on a\n";
  std::ofstream(path_ / "empty") << "";
  EXPECT_TRUE(FileLock(path_ / "lock").held());
  EXPECT_TRUE(FileLock(path_ / "empty").held());
}

TEST_F(MakeFolder, APlainOneIsNoLink) {
  make_plain_folder(path_ / "a");
  EXPECT_TRUE(fs::is_directory(path_ / "a"));
  EXPECT_NO_THROW(make_plain_folder(path_ / "a"));
  fs::create_directory_symlink("a", path_ / "link");
  for (const char* name : {"link", "file", "loop", "gone/b"})
    EXPECT_THROW(make_plain_folder(path_ / name), InputError) << name;
}

TEST_F(FileLockTest, NeedsAPlaceForItsFile) {
  EXPECT_THROW(FileLock(path_ / "gone" / "lock"), RunError);
}

}  // namespace
}  // namespace keyblock
