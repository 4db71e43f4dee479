#include "core/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace keyblock {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view lock_begin = "process ";
constexpr int longest_lock = 512;  // bytes

[[noreturn]] void refuse(const fs::path& place, std::string found, std::string expected) {
  Diagnostic diagnostic;
  diagnostic.where.file = place.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  throw InputError(std::move(diagnostic));
}

void check_folder_takes_files(const fs::path& folder) {
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(folder, std::strerror(errno), "a folder that can be written to");
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

std::string own_text() {
  return fmt::format("{}{} on {}\n", lock_begin, ::getpid(), host_name());
}

// Whoever held the lock before may have taken the file away meanwhile: then others lock another file of this name.
bool is_file_of_name(int file, const fs::path& path) {
  struct stat opened = {};
  struct stat named = {};
  return ::fstat(file, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

bool file_exists(const fs::path& path) {
  std::error_code error;
  const bool exists = fs::exists(path, error);
  if (error) refuse(path, error.message(), "a file that can be looked for");
  return exists;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    refuse(folder, error ? error.message() : "a file", "a folder, or a place where one can be made");
  }
  check_folder_takes_files(folder);
}

void check_is_no_link(const fs::path& folder) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(folder, error)))
    refuse(folder, "a link", "a folder of its own, as keyblock makes it");
}

void make_plain_folder(const fs::path& folder) {
  check_is_no_link(folder);
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) fs::create_directory(folder, error);
  if (!fs::is_directory(fs::symlink_status(folder, error)))
    refuse(folder, error ? error.message() : "a file", "a folder, or a place where one can be made");
}

void check_can_write(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) refuse(file, "a folder", "the name of a file");
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) refuse(file, "no folder " + folder.string(), "a file in a folder");
  check_folder_takes_files(folder);
}

FileLock::FileLock(fs::path path, Afterwards afterwards) : path_(std::move(path)), afterwards_(afterwards) {
  try {
    lock();
  } catch (...) {
    if (file_ >= 0) ::close(file_);
    throw;
  }
}

void FileLock::lock() {
  do {
    if (file_ >= 0) ::close(file_);
    constexpr mode_t mode = 0644;
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, mode);
    if (file_ < 0 && (errno == ELOOP || errno == EISDIR))
      refuse_foreign(errno == ELOOP ? "a link" : "a folder");
    if (file_ < 0) throw RunError(fmt::format("{}: cannot create: {}", path_.string(), std::strerror(errno)));
    held_ = ::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  } while (held_ && !is_file_of_name(file_, path_));
  if (!held_) return;
  check_is_lock();
  const std::string text = own_text();
  // Only for people; a full disk does not matter.
  static_cast<void>(::ftruncate(file_, 0) == 0 && ::pwrite(file_, text.data(), text.size(), 0) > 0);
}

// A lock is empty where the disk was full, or its process was killed between two calls.
void FileLock::check_is_lock() const {
  struct stat status {};
  if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) refuse_foreign("no regular file");
  const std::string text = content();
  const bool is_lock = text.starts_with(lock_begin) && std::count(text.begin(), text.end(), '\n') <= 1;
  if (status.st_size > longest_lock || !(text.empty() || is_lock)) refuse_foreign("a file of somebody else");
}

void FileLock::refuse_foreign(const char* found) const {
  refuse(path_, found, "the lock of keyblock, or nothing of this name; rename it, or take another folder");
}

std::string FileLock::content() const {
  std::string text(longest_lock, '\0');
  const ssize_t n = ::pread(file_, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  return text;
}

FileLock::~FileLock() {
  std::error_code ignored;
  if (held_ && afterwards_ == Afterwards::remove_file && is_file_of_name(file_, path_))
    fs::remove(path_, ignored);
  if (file_ >= 0) ::close(file_);
}

bool FileLock::held_by_this_process() const {
  return held_ || content() == own_text();
}

std::string FileLock::holder() const {
  std::string text = content();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.starts_with(lock_begin) ? text : "another process";
}

}  // namespace keyblock
