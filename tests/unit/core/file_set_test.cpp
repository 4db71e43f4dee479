#include "core/file_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "../fresh_folder.h"
#include "core/error.h"

namespace keyblock {
namespace {

namespace fs = std::filesystem;

class FileSetTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::recursive_directory_iterator(path_), fs::recursive_directory_iterator());
  }

  const FreshFolder path_;
};

TEST_F(FileSetTest, FilesAppearTogether) {
  FileSet set(path_ / "a" / "b");
  EXPECT_EQ(set.write("first", "1"), path_ / "a" / "b" / "first");
  set.write("second", "2");
  EXPECT_FALSE(fs::exists(path_ / "a" / "b" / "first"));
  set.commit();
  EXPECT_EQ(read_file(path_ / "a" / "b" / "first"), "1");
  EXPECT_EQ(read_file(path_ / "a" / "b" / "second"), "2");
  EXPECT_EQ(entries(), 4);
}

TEST_F(FileSetTest, NothingStaysOfOneThatIsNotComplete) {
  for (const char* folder : {"a", "a/b/c", "a/b/"}) {
    { FileSet(path_ / folder).write("file", "x"); }
    EXPECT_EQ(entries(), 0) << folder;
  }
  EXPECT_THROW(FileSet(path_ / "a" / std::string(300, 'x')), InputError);
  EXPECT_EQ(entries(), 0);
}

TEST_F(FileSetTest, WhatWasThereStays) {
  write_file_atomically(path_ / "old", "old");
  fs::create_directory(path_ / "empty");
  fs::create_directory_symlink("gone", path_ / "link");
  { FileSet(path_).write("old", "new"); }
  { FileSet(path_ / "empty").write("file", "x"); }
  EXPECT_THROW(FileSet(path_ / "link"), InputError);
  EXPECT_EQ(read_file(path_ / "old"), "old");
  EXPECT_EQ(entries(), 3);
}

TEST_F(FileSetTest, AFolderInTheWayIsFoundBeforeAnythingAppears) {
  fs::create_directory(path_ / "second");
  {
    FileSet set(path_);
    set.write("first", "1");
    EXPECT_THROW(set.write("second", "2"), InputError);
  }
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace keyblock
