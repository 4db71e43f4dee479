#include "core/archive.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "../fresh_folder.h"

namespace keyblock {
namespace {

template <class T>
std::string archived(const T& value) {
  const FreshFolder folder;
  AtomicFile file(folder / "archive");
  ArchiveWriter archive(file);
  archive(value);
  archive.finish();
  file.commit();
  const std::string bytes = read_file(folder / "archive");
  return bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
}

template <class T>
T unarchived(const std::string& bytes) {
  T value{};
  ArchiveReader archive(bytes);
  archive(value);
  EXPECT_TRUE(archive.at_end());
  return value;
}

TEST(Archive, ValuesComeBack) {
  EXPECT_EQ(unarchived<std::string>(archived(std::string("text"))), "text");
  const std::vector<double> numbers{1.0, -2.5};
  EXPECT_EQ(unarchived<std::vector<double>>(archived(numbers)), numbers);
  EXPECT_TRUE(unarchived<bool>(archived(true)));
  EXPECT_EQ(unarchived<std::optional<double>>(archived(std::optional(2.5))), 2.5);
  EXPECT_EQ(unarchived<std::optional<int>>(archived(std::optional<int>())), std::nullopt);
}

TEST(Archive, WhatIsNoValueIsRefused) {
  EXPECT_THROW(unarchived<bool>(std::string(1, '\2')), ArchiveError);
  std::string optional = archived(std::optional(2.5));
  optional[sizeof(double)] = '\7';
  EXPECT_THROW(unarchived<std::optional<double>>(optional), ArchiveError);
}

TEST(Archive, CountsAreBoundedByTheData) {
  const std::string bytes = archived(std::vector<double>{1.0, 2.0});
  for (const std::uint64_t count :
       {std::uint64_t{3}, std::uint64_t{24}, std::uint64_t{1} << 61U, ~std::uint64_t{0}}) {
    std::string changed = bytes;
    std::memcpy(changed.data(), &count, sizeof(count));
    EXPECT_THROW(unarchived<std::vector<double>>(changed), ArchiveError) << count;
    if (count > 2 * sizeof(double)) {
      EXPECT_THROW(unarchived<std::string>(changed), ArchiveError) << count;
    }
  }
  EXPECT_THROW(unarchived<std::vector<double>>(bytes.substr(0, 7)), ArchiveError);
}

}  // namespace
}  // namespace keyblock
